"""Draws from the posterior by independent ensembles of walkers, all walkers simulated side by side.

emcee (Foreman-Mackey et al. 2013, doi 10.1086/670067) moves one half of an ensemble by differences
of the other half (ter Braak 2006, doi 10.1007/s11222-006-8769-1): no derivatives are needed, and
the runs of a half are independent. A fifth of the moves is snooker (ter Braak and Vrugt 2008,
doi 10.1007/s11222-008-9104-9), which goes through the ensemble's far ends.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from pyrofit.estimate.convergence import ENOUGH_TIMES, ESS, RHAT, autocorrelation_times, rhat
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.logs import Tell
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray

ENSEMBLES = 4
LEAST_WALKERS = 24
PER_PARAMETER = 4
"""Walkers per parameter."""
CHUNK = 100
"""Steps between two looks at convergence."""
LEFT_OUT = 1.0 / 3.0
"""Share of the steps, the first ones, that depends on where walkers start."""
WIDER = 1.5
"""Walkers start wider than the parabola by this factor, so that R-hat can tell."""
SNOOKER = 0.2
State = tuple[FloatArray, FloatArray | None, Any]
"""Walkers, their log density if it is known, and the state of the random numbers."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """The draws that count, and how far to trust them.

    Parameters
    ----------
    samples
        x of each draw, shape (ensembles, steps, walkers, parameters).
    steps
        Steps of each ensemble, with those left out.
    calls
        Parameter sets proposed.
    accepted
        Share of the proposals that was taken.
    """

    samples: FloatArray
    steps: int
    calls: int
    accepted: float

    @property
    def flat(self) -> FloatArray:
        """All draws, shape (draws, parameters)."""
        return self.samples.reshape(-1, self.samples.shape[-1])

    @property
    def rhat(self) -> FloatArray:
        """R-hat of each parameter."""
        return np.array([rhat(self.samples[..., i]) for i in range(self.samples.shape[-1])])

    @property
    def times(self) -> FloatArray:
        """Autocorrelation time of each parameter in steps."""
        return autocorrelation_times(self.samples)

    @property
    def ess(self) -> FloatArray:
        """Effective sample size of each parameter."""
        return self.samples[..., 0].size / self.times

    @property
    def converged(self) -> bool:
        """Whether ensembles agree, are large enough, and long enough to tell so."""
        times = self.times
        long = self.samples.shape[1] >= ENOUGH_TIMES * float(np.max(times))
        return long and bool(np.all(self.rhat < RHAT) and np.all(self.ess > ESS))


def log_density(likelihood: Likelihood, X: FloatArray) -> FloatArray:
    """Return -chi2/2 of several sets, shape (sets,); -inf outside the limits and of failed runs."""
    found = np.full(len(X), -np.inf)
    inside = np.flatnonzero(np.all((X >= 0.0) & (X <= 1.0), axis=1))
    if inside.size:
        for i, rows in zip(inside, likelihood.residuals_all(X[inside]), strict=True):
            if likelihood.finished(rows):
                found[i] = -0.5 * linear.dot(rows, rows)
    return found


def draw(
    likelihood: Likelihood,
    x: FloatArray,
    covariance: FloatArray,
    seed: int,
    cores: int,
    most_steps: int,
    tell: Tell = lambda text: None,
) -> Drawn:
    """Draw from exp(-chi2/2) within the limits until the ensembles agree, or to the most steps.

    Parameters
    ----------
    likelihood
        chi-square, known values included.
    x, covariance
        Optimum and covariance about it, from which walkers start, in units of the search range.
    seed
        The draws are a function of it alone, not of the number of processes.
    cores
        Processes, each of which takes whole ensembles.
    most_steps
        Where an ensemble ends that does not converge.
    tell
        Is told the progress.
    """
    states = [_start(x, covariance, seed_for(seed, "posterior", i)) for i in range(ENSEMBLES)]
    parts: list[FloatArray] = []
    accepted, steps = 0.0, 0
    while True:
        chunk = min(CHUNK, most_steps - steps)
        moved = parallel_map(partial(_advance, likelihood, states, chunk), ENSEMBLES, cores)
        states = [state for state, _, _ in moved]
        parts.append(np.stack([chain for _, chain, _ in moved]))
        accepted += float(np.mean([share for _, _, share in moved])) * chunk
        steps += chunk
        samples = np.concatenate(parts, axis=1)[:, int(LEFT_OUT * steps) :]
        calls = ENSEMBLES * samples.shape[2] * (steps + 1)
        found = Drawn(samples, steps, calls, accepted / steps)
        tell(_reached(found))
        if steps >= most_steps or found.converged:
            return found


def _reached(found: Drawn) -> str:
    return (
        f"{found.steps} steps, {found.calls} calls: R-hat at most {np.max(found.rhat):.3f}, "
        f"effective sample size at least {np.min(found.ess):.0f}"
    )


def walkers_of(parameters: int) -> int:
    """Return the number of walkers of an ensemble, an even one."""
    return max(LEAST_WALKERS, 2 * (PER_PARAMETER * parameters // 2))


def _start(x: FloatArray, covariance: FloatArray, seed: int) -> State:
    """Return walkers about the optimum; those beyond a limit are mirrored at it."""
    random = np.random.RandomState(seed)
    factor = linear.cholesky(covariance)
    z = random.standard_normal((walkers_of(x.size), x.size))
    beyond = np.mod(x + linear.product(WIDER * z, factor.T), 2.0)
    inside = np.asarray(np.where(beyond > 1.0, 2.0 - beyond, beyond))
    return inside, None, random.get_state(legacy=True)


def _snooker() -> Any:
    """Return emcee's snooker move, with products and logarithms in a fixed order."""
    import emcee

    class Snooker(emcee.moves.DESnookerMove):  # type: ignore[misc]
        def get_proposal(self, s: Any, c: Any, random: Any) -> tuple[FloatArray, FloatArray]:
            q, longer = np.empty_like(s), np.empty(len(s))
            for i, here in enumerate(s):
                others = np.array([part[random.randint(len(part))] for part in c[:3]])
                random.shuffle(others)
                z, z1, z2 = others
                length = linear.norm(here - z)
                u = (here - z) / math.sqrt(length)
                q[i] = here + u * self.gammas * (linear.dot(u, z1) - linear.dot(u, z2))
                longer[i] = math.log(linear.norm(q[i] - z)) - math.log(length)
            return q, 0.5 * (s.shape[1] - 1.0) * longer

    return Snooker()


def _advance(
    likelihood: Likelihood, states: Sequence[State], steps: int, i: int
) -> tuple[State, FloatArray, float]:
    """Return ensemble i after some steps, its chain (steps, walkers, parameters), acceptance."""
    import emcee  # a tenth of a second that other steps save

    walkers, density, random = states[i]
    sampler = emcee.EnsembleSampler(
        *walkers.shape,
        lambda X: log_density(likelihood, X),
        vectorize=True,
        moves=[
            (emcee.moves.DEMove(), 1.0 - SNOOKER),
            (_snooker(), SNOOKER),
        ],
    )
    begin = emcee.State(walkers, log_prob=density, random_state=random)
    end = sampler.run_mcmc(begin, steps, skip_initial_state_check=True)
    after = (np.array(end.coords), np.array(end.log_prob), end.random_state)
    return after, np.array(sampler.get_chain()), float(np.mean(sampler.acceptance_fraction))
