"""From a study and its measurements to the base model's fit, noise and all."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import qmc

from pyrofit.config import Study, calibration_channels, candidate_effects, held_out_channels
from pyrofit.diagnose.base.descent import Fit, descend_chi_square, refreshed
from pyrofit.diagnose.base.disturbed import disturbed
from pyrofit.diagnose.base.fitted import FittedModel, polished
from pyrofit.diagnose.base.long_run import significant_factor
from pyrofit.diagnose.base.model import Base, Model, model_of
from pyrofit.diagnose.base.plausible import plausible_ranges
from pyrofit.diagnose.base.work import within_work
from pyrofit.diagnose.settings import Settings
from pyrofit.errors import DataError
from pyrofit.estimate.between_ends import with_records
from pyrofit.estimate.channel_noise import noise_of
from pyrofit.estimate.likelihood import FAILED
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.pose import of_diagnosis
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.estimate.targets import Measurements
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Setup:
    """Start of a diagnosis: the fitted base and the names of the candidates."""

    base: FittedModel
    candidates: tuple[str, ...]
    other_starts: tuple[FloatArray, ...] = ()
    """Other ends of the base's fits, the lowest chi-square first, then points of its limits."""


def set_up(
    study: Study,
    measurements: Measurements,
    processes: int = 1,
    draw: int | None = None,
    narrowed: Callable[[Base], Base] = lambda base: base,
    settings: Settings = Settings(),
) -> Setup:
    """Fit the base model, with the noise of every channel estimated twice.

    The first estimate is from the series alone. There steep parts look like noise to a smooth
    curve, so the second is about the fitted curve. With a ``draw``, a number, the data are then
    disturbed by a draw of this noise. ``narrowed`` gives a base the limits that are searched.

    Raises
    ------
    DataError
        A channel is too short; no run within the limits finishes, or one that is held out does not.
    """
    channels = (*calibration_channels(study), *held_out_channels(study))
    asked = of_diagnosis(study, channels)
    fixed = study.fixed_values()
    likelihood = pose_likelihood(study, asked, measurements, fixed, tolerant=True)
    calibrated = tuple(range(len(calibration_channels(study))))
    plausible = plausible_ranges(study.diagnosis.plausible)
    base = narrowed(Base(likelihood, calibrated, plausible, settings=settings))
    first, starts = fitted_from_starts(base, study.seed, processes)
    first = within_work(first)
    _check_held_out(first)
    base = with_noise_about(first, processes=processes)
    if draw is not None:
        base = disturbed(base, seed_for(study.seed, "stability", draw))
    others = tuple(starts[: settings.other_starts])
    fitted = weighed(refitted(first, base))
    return Setup(fitted, candidate_effects(study), others)


def weighed(trial: FittedModel) -> FittedModel:
    """Return the fit with known values that a misfitting model cannot overrule.

    Points of a signal that is missed for long tell less than their noise says, see
    `pyrofit.diagnose.base.long_run`. Their information on a parameter, J^T J, is divided by the
    factor f of each signal s. To weigh known values against it, their variance is divided by

        f_k = sum_s |J_sk|^2 / sum_s (|J_sk|^2 / f_s).
    """
    base = trial.model.base
    prior = base.likelihood.prior
    weight = np.sqrt(_overstated(trial))
    if not prior.index or np.allclose(weight, prior.weight):
        return trial
    other = replace(base.likelihood, prior=prior.over(weight / prior.weight))
    return refitted(trial, replace(base, likelihood=other))


def _overstated(trial: FittedModel) -> FloatArray:
    """Return f_k of the parameters of known value, shape (known,); 1 where no point tells of it."""
    index = list(trial.model.base.likelihood.prior.index)
    model, fit = trial.model, trial.fit
    level = trial.settings.lasting_level
    factors = [significant_factor(part, level) for part in model.by_channel(fit.residuals)]
    parts = model.by_channel(fit.jacobian[:, index])
    told = np.array([(J**2).sum(axis=0) for J in parts])
    truly = np.array([own / f for own, f in zip(told, factors, strict=True)])
    said, meant = told.sum(axis=0), truly.sum(axis=0)
    return np.asarray(np.divide(said, meant, out=np.ones(len(index)), where=said > 0.0))


def _check_held_out(trial: FittedModel) -> None:
    """Refuse held-out runs that do not finish with the fitted parameters."""
    base = trial.model.base
    for i in base.held_out:
        if model_of(base, {}, (i,)).likelihood.curves(trial.fit.x) is None:
            raise DataError(
                f"diagnosis.hold_out: {base.channels[i][0]} does not finish with the parameters "
                "that are fitted to the calibrated signals; leave it out"
            )


def fitted_from_starts(
    base: Base, seed: int, processes: int = 1
) -> tuple[FittedModel, list[FloatArray]]:
    """Return the fit of the base from the best of several points spread over the limits.

    Other starts are returned, too: the ends in other valleys, the lowest chi-square first, then the
    points.
    """
    model = model_of(base, {})
    starts = start_points(base, seed)
    ahead = [linear.dot(r, r) for r in model.residuals_all(np.array(starts))]
    starts = [starts[k] for k in np.argsort(ahead, kind="stable")]
    first = starts[: base.settings.base_descents]
    ends = parallel_map(lambda k: descend_chi_square(model, first[k]), len(first), processes)
    ends = sorted(ends, key=lambda end: end.chi2)
    best = ends[0]
    if np.any(best.residuals[: model.points] == FAILED):
        raise DataError(
            "diagnosis: no run within the limits of the parameters finishes; check the limits and "
            "the description of the experiments"
        )
    valleys = apart([end.chi2 for end in ends], base.settings.same_valley)
    others = [ends[k].x for k in valleys[1:]] + starts
    return polished([FittedModel(model, best)], processes)[0], others


def apart(chi2: Sequence[float], least: float) -> list[int]:
    """Return the positions of ends in other valleys, which rise by more than ``least``."""
    found = [0]
    found += [k for k in range(1, len(chi2)) if chi2[k] - chi2[k - 1] > least]
    return found


def start_points(base: Base, seed: int) -> list[FloatArray]:
    """Return the centre and points spread over the limits, known parameters at their means."""
    size = len(base.likelihood.problem.names)
    spread = 0.05 + 0.9 * qmc.LatinHypercube(size, seed=np.random.default_rng(seed)).random(
        base.settings.base_starts
    )
    points = [np.full(size, 0.5), *spread]
    problem, known = base.likelihood.problem, base.likelihood.prior
    index = list(known.index)
    for x in points:
        span = (problem.upper - problem.lower)[index]
        x[index] = (known.mean - problem.lower[index]) / span
    return points


def with_noise_about(
    trial: FittedModel, channels: Sequence[int] | None = None, processes: int = 1
) -> Base:
    """Return the base with channels' noise about a fitted curve, where that explains more.

    By default of all channels.
    """
    base = trial.model.base
    problem = base.likelihood.problem
    every = range(len(problem.picks))
    curves = model_of(base, trial.model.effects, every).likelihood.curves(trial.fit.x)
    if curves is None:
        return base
    noise = list(base.likelihood.noise)
    parts = base.likelihood.split(curves)
    wanted = list(every if channels is None else channels)

    def better(k: int) -> NoiseModel | None:
        i = wanted[k]
        found = noise_of(problem, i, parts[i], tolerant=True)
        return found if found.criterion < noise[i].criterion else None

    for i, found in zip(wanted, parallel_map(better, len(wanted), processes), strict=True):
        noise[i] = found or noise[i]
    likelihood = replace(base.likelihood, noise=with_records(problem, noise, parts))
    return replace(base, likelihood=likelihood.cautious)


def sharpened(trial: FittedModel, processes: int = 1) -> Base:
    """Return the base with noise and known values weighed as a model with effects has them.

    That is, the noise about its curves, where that explains more, and known values over its misfit,
    which is smaller than that of the base.
    """
    base = with_noise_about(trial, processes=processes)
    heaviest = base.likelihood.prior.heaviest
    if heaviest <= 1.0:
        return base
    found = refitted(trial, base)
    for _ in range(base.settings.weighings):
        found = weighed(found)
    other = found.model.base
    return other if other.likelihood.prior.heaviest < heaviest else base


def refitted(trial: FittedModel, base: Base) -> FittedModel:
    """Return a fitted model with its effects fitted with another noise."""
    model = model_of(base, trial.model.effects, trial.model.channels)
    return FittedModel(model, _refit(model, trial.fit.x))


def refitted_all(
    trials: Sequence[FittedModel], base: Base, processes: int = 1
) -> list[FittedModel]:
    """Return several fitted models, each with its own effects, fitted with another noise."""
    models = [model_of(base, trial.model.effects, trial.model.channels) for trial in trials]
    fits = parallel_map(lambda k: _refit(models[k], trials[k].fit.x), len(models), processes)
    return list(map(FittedModel, models, fits))


def _refit(model: Model, x: FloatArray) -> Fit:
    return refreshed(model, descend_chi_square(model, x))


def has_better_noise(other: Base, base: Base) -> bool:
    """Tell whether the noise of the calibrated channels has a clearly lower BIC than a base's.

    Or whether known values count for less, as the misfit is smaller.
    """
    pairs = ((base.likelihood.noise[i], other.likelihood.noise[i]) for i in base.calibrated)
    gain = sum(b.criterion - o.criterion for b, o in pairs if b is not o)
    lighter = other.likelihood.prior.heaviest / base.likelihood.prior.heaviest
    return gain >= base.settings.clearer_bic or lighter < base.settings.lighter_known


def blurred(base: Base) -> bool:
    """Tell whether a calibrated channel scatters more than is stated: that may be misfit.

    Or whether known values are weighed by a misfit of the base.
    """
    if base.likelihood.prior.heaviest > 1.0:
        return True
    return any(base.likelihood.noise[i].excess > 1.0 for i in base.calibrated)
