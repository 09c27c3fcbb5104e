"""The problem that every optimiser solves: parameter values in, cost out."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pyrofit.config import Study, TermSpec
from pyrofit.config.uses import parameters_in
from pyrofit.cost import WeightedSum
from pyrofit.estimate.derivatives import PARABOLA, SECANT, Difference
from pyrofit.estimate.distinct_sets import Indices, distinct_sets, taken
from pyrofit.estimate.run import Run, alike, asked_together, own_curves
from pyrofit.estimate.targets import Measurements, term_for
from pyrofit.experiments import kind_of
from pyrofit.experiments.base import Simulate
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.solver.arrays import FloatArray, Status, Values
from pyrofit.solver.curves import Curves, Request

FAILED_COST = 1e12
"""Cost of a run that did not finish: finite, and worse than any run that did."""

Outcome = tuple[Status, list[FloatArray]]
"""How a simulation ended, and the model at each term's target, if it finished."""


@dataclass(frozen=True)
class Evaluation:
    """Cost of one parameter set, its terms, and how the simulation ended."""

    cost: float
    parts: tuple[float, ...]
    status: Status


@dataclass(frozen=True)
class Problem:
    """Estimation of ``names`` within ``lower`` and ``upper`` (SI units) by a cost, Eq. 5."""

    names: tuple[str, ...]
    lower: FloatArray
    upper: FloatArray
    material: Material
    fixed: Mapping[str, float]
    runs: Mapping[str, Run]
    picks: tuple[tuple[str, str, NDArray[np.int64]], ...]
    cost: WeightedSum
    accuracy: Accuracy

    @cached_property
    def difference(self) -> Difference:
        """How derivatives are taken: programs of others may round their curves."""
        led = all(kind_of(run.experiment).can_lead for run in self.runs.values())
        return SECANT if led else PARABOLA

    @property
    def span(self) -> FloatArray:
        """Search range (upper less lower limit), SI units, shape (parameters,)."""
        return self.upper - self.lower

    @cached_property
    def moving(self) -> tuple[int, ...]:
        """Positions of the parameters that some run uses."""
        used = set().union(*self._used.values())
        return tuple(i for i, name in enumerate(self.names) if name in used)

    @cached_property
    def idle(self) -> tuple[int, ...]:
        """Positions of the parameters that no run uses."""
        return tuple(i for i in range(len(self.names)) if i not in self.moving)

    def values(self, x: FloatArray) -> dict[str, float]:
        """Return all parameters by name, fixed ones too, SI units; x has shape (parameters,)."""
        return {**self.fixed, **dict(zip(self.names, x.tolist(), strict=True))}

    def simulate(self, x: FloatArray) -> Outcome:
        """Return how it ended, and the model at each term's target.

        ``x`` has the shape (parameters,), SI units.
        """
        return self.simulate_all(x[None])[0]

    def simulate_all(self, X: FloatArray, led: bool = False) -> list[Outcome]:
        """Return for several sets how each ended, and the model at each term's target.

        ``X`` has the shape (sets, parameters), SI units. Where the sets are ``led``, the others
        take the cells and time steps of the first one, see `pyrofit.simulate.simulate_slabs`.
        """
        if len(X) == 0:
            return []
        columns = X[0].tolist() if len(X) == 1 else X.T
        values = {**self.fixed, **dict(zip(self.names, columns, strict=True))}
        return self.outcomes(values, len(X), led)

    def outcomes(self, values: Values, sets: int, led: bool = False) -> list[Outcome]:
        """Return for several sets how each ended, and the model at each term's target.

        ``values`` holds each parameter by name, SI units: a number or shape (sets,).
        """
        simulated = self.simulated(values, sets, led=led)
        return [
            self._picked({name: curves[s] for name, curves in simulated.items()})
            for s in range(sets)
        ]

    def simulated(
        self,
        values: Values,
        sets: int,
        names: Iterable[str] | None = None,
        led: bool = False,
    ) -> dict[str, list[Curves]]:
        """Return the curves by experiment and set; kinds with one solver in one call.

        Repeats that are described alike are simulated once, up to the end of the longest record.
        The same holds for sets that differ only in numbers of other experiments. ``names`` are the
        experiments, by default all.
        """
        together: dict[tuple[Simulate, bytes], list[str]] = {}
        distinct: dict[bytes, tuple[Indices, Indices]] = {}
        shown = {name: self.alike[name] for name in (self.runs if names is None else names)}
        for name in dict.fromkeys(shown.values()):
            used = self._used[name] if sets > 1 else ()
            first, of_set = distinct_sets([values[p] for p in used if p in values], sets)
            key = of_set.tobytes()
            distinct[key] = first, of_set
            simulate = kind_of(self.runs[name].experiment).simulate
            together.setdefault((simulate, key), []).append(name)
        curves: dict[str, list[Curves]] = {}
        for (simulate, key), names in together.items():
            first, of_set = distinct[key]
            experiments = [self.runs[name].experiment for name in names]
            asked = [self._asked[name] for name in names]
            at = taken(values, first, sets)
            found = simulate(experiments, self.material, at, asked, self.accuracy, first.size, led)
            for name, own in zip(names, found, strict=True):
                curves[name] = [own[i] for i in of_set]
        return {
            name: [
                own_curves(curve, self._asked[first], self.runs[name].requests)
                for curve in curves[first]
            ]
            for name, first in shown.items()
        }

    @cached_property
    def _used(self) -> dict[str, tuple[str, ...]]:
        """The parameters that the material and the description of an experiment name."""
        return {
            name: tuple(sorted(parameters_in(self.material, run.experiment)))
            for name, run in self.runs.items()
        }

    @cached_property
    def alike(self) -> dict[str, str]:
        """The first experiment that is simulated as each one is."""
        return alike(self.runs)

    @cached_property
    def _asked(self) -> dict[str, dict[str, Request]]:
        """The requests of all runs that are simulated together, by the first one's name."""
        together: dict[str, list[Run]] = {}
        for name, first in self.alike.items():
            together.setdefault(first, []).append(self.runs[name])
        return {first: asked_together(runs) for first, runs in together.items()}

    def _picked(self, curves: Mapping[str, Curves]) -> Outcome:
        for name in self.runs:
            if not curves[name].status.finished:
                return curves[name].status, []
        models = [curves[name].signals[signal][place] for name, signal, place in self._places]
        return Status.OK, models

    @cached_property
    def _places(self) -> list[tuple[str, str, NDArray[np.int64] | slice]]:
        """As ``picks``, with a slice where all points are picked, which copies nothing."""

        def place(name: str, signal: str, index: NDArray[np.int64]) -> NDArray[np.int64] | slice:
            every = self.runs[name].requests[signal].time_s.size
            return slice(None) if index.size == every else index

        return [(name, signal, place(name, signal, index)) for name, signal, index in self.picks]

    def temperature_K(self, channel: int) -> FloatArray | None:
        """Return the measured temperatures at the points of a channel, None if it has none."""
        name, signal, index = self.picks[channel]
        measured = self.runs[name].requests[signal].temperature_K
        return None if measured is None else measured[index]

    def evaluate(self, x: FloatArray) -> Evaluation:
        """Return the cost of a parameter set; a failed run costs `FAILED_COST`."""
        return self._evaluation(*self.simulate(x))

    def evaluate_all(self, X: FloatArray) -> list[Evaluation]:
        """Return the cost of several sets, X of shape (sets, parameters), SI units."""
        return [self._evaluation(*outcome) for outcome in self.simulate_all(X)]

    def _evaluation(self, status: Status, models: list[FloatArray]) -> Evaluation:
        if status.finished:
            parts = self.cost.parts(models)
            total = float(sum(parts))
            if np.isfinite(total):
                return Evaluation(total, tuple(parts), status)
            status = Status.NON_FINITE
        return Evaluation(FAILED_COST, (FAILED_COST,) * len(self.picks), status)

    def refined(self) -> "Problem":
        """Return this problem with a quarter of the solver's error."""
        return replace(self, accuracy=self.accuracy.refined())

    def residuals(self, x: FloatArray) -> FloatArray:
        """Return the residuals of the same cost for a least-squares optimiser."""
        return self._residuals(*self.simulate(x))

    def residuals_all(self, X: FloatArray, led: bool = False) -> list[FloatArray]:
        """Return the residuals of the cost for several sets, X of shape (sets, parameters).

        They may be ``led`` by the first one, as in `simulate_all`.
        """
        return [self._residuals(*outcome) for outcome in self.simulate_all(X, led)]

    def _residuals(self, status: Status, models: list[FloatArray]) -> FloatArray:
        if status.finished:
            residuals = self.cost.residuals(models)
            if np.all(np.isfinite(residuals)):
                return residuals
        met = [term.target.value for _, term in self.cost.terms]
        return np.full(self.cost.residuals(met).size, np.sqrt(FAILED_COST))


def failed(residuals: FloatArray) -> bool:
    """Tell whether these are the residuals of a run that did not finish."""
    return bool(np.all(residuals == np.sqrt(FAILED_COST)))


def make_problem(
    study: Study,
    estimate: Sequence[str],
    specs: Sequence[TermSpec],
    measurements: Measurements,
    material: Material,
    fixed: Mapping[str, float],
) -> Problem:
    """Prepare a problem: targets, requests, limits.

    Parameters
    ----------
    study
        The study.
    estimate
        Names of the parameters to estimate.
    specs
        Terms of the cost.
    measurements
        Measured series by (experiment, signal), SI units.
    material
        The material whose kinetics are used.
    fixed
        Values of all other parameters, SI units.

    Raises
    ------
    CostError
        A cost does not fit its target.
    """
    terms = [term_for(study, spec, measurements) for spec in specs]
    targets = [term.target for term in terms]
    times: dict[tuple[str, str], FloatArray] = {}
    for spec, target in zip(specs, targets, strict=True):
        key = spec.experiment, spec.signal
        times[key] = np.union1d(times.get(key, np.empty(0)), target.time_s)
    runs: dict[str, Run] = {}
    for (name, signal), at in times.items():
        experiment = study.experiments[name]
        run = runs.setdefault(name, Run(experiment, {}))
        frame = measurements[name, signal]
        run.requests[signal] = kind_of(experiment).request(experiment, signal, frame, at)
    picks = tuple(
        (
            s.experiment,
            s.signal,
            np.searchsorted(times[s.experiment, s.signal], t.time_s).astype(np.int64),
        )
        for s, t in zip(specs, targets, strict=True)
    )
    bounds = np.array([study.parameters[name].bounds_si for name in estimate])
    return Problem(
        names=tuple(estimate),
        lower=bounds[:, 0],
        upper=bounds[:, 1],
        material=material,
        fixed={n: v for n, v in fixed.items() if n not in estimate},
        runs=runs,
        picks=picks,
        cost=WeightedSum([(s.weight, term) for s, term in zip(specs, terms, strict=True)]),
        accuracy=study.accuracy,
    )
