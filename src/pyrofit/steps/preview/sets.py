"""Parameter sets that fill the limits evenly: a Sobol sequence, shifted by the study's seed."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.config import Study
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray, Values


@dataclass(frozen=True, eq=False)
class Sets:
    """Parameters within their limits, SI units, and where each set lies between them.

    Parameters
    ----------
    names
        Names of the parameters that have limits.
    low, high
        Limits, shape (parameters,).
    unit
        Positions between the limits, 0 to 1, shape (sets, parameters).
    fixed
        Values of all other parameters by name.
    """

    names: tuple[str, ...]
    low: FloatArray
    high: FloatArray
    unit: FloatArray
    fixed: Values

    @property
    def count(self) -> int:
        """Number of sets."""
        return len(self.unit)

    @property
    def values(self) -> Values:
        """Value of each parameter by name: a number or an array of shape (sets,)."""
        drawn = self.low + self.unit * (self.high - self.low)
        return {**self.fixed, **dict(zip(self.names, drawn.T, strict=True))}

    def first(self, count: int) -> "Sets":
        """Return the first sets alone."""
        return replace(self, unit=self.unit[:count])

    def widened(self, name: str, low: float, high: float) -> "Sets":
        """Return the sets with other limits of one parameter, SI units."""
        i = self.names.index(name)
        at = np.arange(len(self.names)) == i
        return replace(self, low=np.where(at, low, self.low), high=np.where(at, high, self.high))

    def at_ends(self, name: str) -> "Sets":
        """Return each set twice: with a parameter at its lower limit, then at its upper one."""
        i = self.names.index(name)
        both = np.concatenate([self.unit, self.unit])
        both[:, i] = np.repeat([0.0, 1.0], self.count)
        return replace(self, unit=both)


def draw_sets(study: Study, names: Iterable[str], count: int) -> Sets:
    """Return sets within the limits of parameters; those of known value stay near it.

    Parameters
    ----------
    study
        The study; its seed shifts the sequence.
    names
        Parameters that may vary; those without limits keep their value.
    count
        Number of sets.
    """
    from scipy.stats import qmc  # half a second that other commands do without

    free = tuple(n for n in names if _is_free(study, n))
    limits = np.array([study.search_limits(n) for n in free]).reshape(-1, 2)
    factors = np.array([study.parameters[n].factor for n in free])
    shift = np.random.default_rng(seed_for(study.seed, "preview")).random(len(free))
    points = np.zeros((count, 0))
    if free:
        power = max(count - 1, 1).bit_length()
        sequence = qmc.Sobol(len(free), scramble=False).random_base2(power)
        points = (sequence[:count] + shift) % 1.0
    return Sets(free, limits[:, 0] * factors, limits[:, 1] * factors, points, study.fixed_values())


def _is_free(study: Study, name: str) -> bool:
    p = study.parameters[name]
    return p.value is None and p.lower is not None
