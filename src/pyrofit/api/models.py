"""Comparison of fitted models of the same measurements."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from pyrofit.analysis.model_comparison import (
    CommonNoise,
    LeftOut,
    aicc,
    akaike_weights,
    bic,
    common_noise,
    descended,
    f_test,
    f_test_of_lasting,
    predicted_score,
)
from pyrofit.api.arguments import teller_of
from pyrofit.api.choices import Key, si_values
from pyrofit.api.fitted import Fit
from pyrofit.api.weighing import weighted
from pyrofit.config import Study, TermSpec
from pyrofit.errors import StudyError
from pyrofit.estimate.bounded_least_squares import Fit as End
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise_of_curves import with_noise_of_curves
from pyrofit.estimate.pose import Estimation, of_diagnosis, pose
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.estimate.prior import prior_of
from pyrofit.logs import Tell
from pyrofit.model.heated import HeatedExperiment
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class _Model:
    """A fit with its likelihood, and its minimum under the common noise."""

    fit: Fit
    likelihood: Likelihood
    x: FloatArray
    end: End | None = None

    @property
    def names(self) -> tuple[str, ...]:
        return self.likelihood.problem.names

    @property
    def minimum(self) -> End:
        assert self.end is not None
        return self.end


def compare_models(
    fits: Mapping[str, Fit] | Sequence[Fit], *, left_out: bool = True, tell: Tell | None = None
) -> pd.DataFrame:
    """Compare fits of several models to the same measurements, the best one first.

    All are judged under one noise, that of the fit of the least chi-square; each is fitted anew
    under it. Points of lasting misfit are not independent. Where that fit misses a signal, its
    variance counts as f times as large. The factor f is the spectral density of the whitened
    residuals w at their lowest frequencies, over that of white noise less its fit. The n points
    count as ``n_eff = n mean(w^2) / f`` (Bayley and Hammersley 1946, doi 10.2307/2983560).

    Parameters
    ----------
    fits
        Fits by name, or in a list. Their studies may differ in all but the measured signals.
    left_out
        Whether each heating rate, and each test of a slab, is left out of the fit and predicted.
        This takes a fit for each.
    tell
        Function that receives messages on the progress, such as ``print``.

    Returns
    -------
    DataFrame
        A row for each model, the least BIC first. With k parameters, N = the sum of n_eff and the
        number of known values:

        - ``parameters``: k.
        - ``points``, ``effective``: the number of points, and N.
        - ``describes``: whether the model describes the measurements, see `Fit.goodness`.
        - ``chi2``: chi-square under that noise, known values included.
        - ``aicc``, ``d_aicc``: chi2 + 2 k + 2 k (k + 1) / (N - k - 1), and its rise above the
          least one (Akaike 1974, doi 10.1109/TAC.1974.1100705; Hurvich and Tsai 1989, doi
          10.1093/biomet/76.2.297).
        - ``weight``: exp(-d_aicc / 2) over its sum (Burnham and Anderson 2002, doi 10.1007/b97636).
        - ``bic``, ``d_bic``: chi2 + k ln N, and its rise above the least one (Schwarz 1978, doi
          10.1214/aos/1176344136).
        - ``against``: the best model whose parameters are some of its own, for the F-test.
        - ``F``, ``p``: ((chi2_a - chi2) / (k - k_a)) / (chi2 / (N - k)), and the probability of
          such an F if ``against`` is right (Bates and Watts 1988, doi 10.1002/9780470316757). This
          needs nested models: some values of the further parameters make one the other.
          Where errors last, F is (chi2_a - chi2) / (k - k_a), with the degrees of freedom of f.
        - ``log_score``: the log density of each test left out, given the others, summed. It is
          -(d chi2 + d log det(J^T J + Pi)) / 2 (Gneiting and Raftery 2007, doi
          10.1198/016214506000001437); differences count.
        - ``left_out_rms``: root mean square of predicted minus measured values over the range of
          each signal left out.

    Raises
    ------
    StudyError
        There are fewer than two fits, one is of a cost, or they have other measurements or weights.
    DataError
        A series is too short to show its noise.
    """
    tell = teller_of(tell)
    models = {name: _model(fit) for name, fit in _named(fits).items()}
    _check_alike({name: model.fit for name, model in models.items()})
    best = min(models.values(), key=lambda m: m.likelihood.chi2(m.x))
    own = descended(best.likelihood, best.likelihood.noise, best.x)
    common = common_noise(best.likelihood, own)
    models = {
        name: replace(m, end=descended(m.likelihood, common.noise, m.x))
        for name, m in models.items()
    }
    rows = {name: _criteria(model, common) for name, model in models.items()}
    for name, row in rows.items():
        row |= _tested(name, models, common)
        row |= _left_out(models[name], common, tell, name) if left_out else {}
    table = pd.DataFrame.from_dict(rows, orient="index").rename_axis("model")
    for criterion in ("aicc", "bic"):
        rise = table[criterion] - table[criterion].min()
        table.insert(list(table).index(criterion) + 1, f"d_{criterion}", rise)
    weight = akaike_weights(table["aicc"].to_numpy(float))
    table.insert(list(table).index("d_aicc") + 1, "weight", weight)
    return table.sort_values("bic", kind="stable")


def _named(fits: Mapping[str, Fit] | Sequence[Fit]) -> dict[str, Fit]:
    if isinstance(fits, Mapping):
        named = {str(name): fit for name, fit in fits.items()}
    elif isinstance(fits, list | tuple):
        named = {f"model {i + 1}": fit for i, fit in enumerate(fits)}
    else:
        raise StudyError(
            "compare_models: fits by name are needed, such as {'one': fit, 'two': other}; this is "
            f"a {type(fits).__name__}"
        )
    if len(named) < 2:
        raise StudyError(f"compare_models: {len(named)} fit is given; give two or more")
    for name, fit in named.items():
        if not isinstance(fit, Fit):
            raise StudyError(
                f"compare_models: '{name}' is a {type(fit).__name__}; give a fit of `pf.fit`"
            )
        if fit.correlation is None:
            raise StudyError(
                f"compare_models: '{name}' is a fit of a cost, which has no likelihood; leave out "
                "`cost`"
            )
    return named


def _check_alike(fits: Mapping[str, Fit]) -> None:
    """Refuse fits to other measurements, or with other weights, than the first one."""
    (first, of), *others = fits.items()
    for name, fit in others:
        same = list(fit.comparison.measured) == list(of.comparison.measured) and all(
            np.array_equal(frame, of.comparison.measured[key], equal_nan=True)
            for key, frame in fit.comparison.measured.items()
        )
        if not same:
            raise StudyError(
                f"compare_models: '{name}' and '{first}' are fits of other measurements; fit both "
                "to the same signals, in the same order"
            )
        weights = [{key: w.tolist() for key, w in f.weights.items()} for f in (of, fit)]
        if weights[0] != weights[1]:
            raise StudyError(
                f"compare_models: '{name}' and '{first}' have other weights; fit both with the same"
            )


def _model(fit: Fit) -> _Model:
    study, asked, series, fixed = _asked(fit, list(fit.comparison.measured))
    likelihood = pose_likelihood(study, asked, series, fixed)
    values = si_values(study, {n: fit.values[n] for n in asked.names})
    x = likelihood.scaled(np.array([values[n] for n in asked.names]))
    return _Model(fit, weighted(with_noise_of_curves(likelihood, [x]), fit.weights), x)


def _asked(
    fit: Fit, keys: Sequence[Key]
) -> tuple[Study, Estimation, dict[Key, pd.DataFrame], dict[str, float]]:
    """Return what a fit estimates from some of its signals, as `pose` takes it."""
    terms = [TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in keys]
    estimated = tuple(str(name) for name in fit.table.index)
    series = {key: fit.comparison.measured[key] for key in keys}
    given = {n: v for n, v in fit.values.items() if n not in estimated}
    fixed = {**fit.study.fixed_values(), **si_values(fit.study, given)}
    return fit.study, of_diagnosis(fit.study, terms, estimated), series, fixed


def _criteria(model: _Model, common: CommonNoise) -> dict[str, object]:
    points, k, chi2 = _points(model, common), len(model.names), model.minimum.chi2
    return {
        "parameters": k,
        "points": sum(model.likelihood.points),
        "effective": points,
        "describes": model.fit.goodness is not None and model.fit.goodness.describes,
        "chi2": chi2,
        "aicc": aicc(chi2, k, points),
        "bic": bic(chi2, k, points),
    }


def _points(model: _Model, common: CommonNoise) -> float:
    """Return the effective number of points, known values included."""
    known = model.minimum.residuals.size - sum(model.likelihood.points)
    return sum(common.effective) + known


def _tested(name: str, models: Mapping[str, _Model], common: CommonNoise) -> dict[str, object]:
    """Return the F-test against the best model whose parameters are some of this one's."""
    own = set(models[name].names)
    smaller = {other: m for other, m in models.items() if set(m.names) < own}
    if not smaller:
        return {"against": "", "F": np.nan, "p": np.nan}
    against = min(smaller, key=lambda other: smaller[other].minimum.chi2)
    here, there = models[name], models[against]
    added = len(own) - len(there.names)
    if min(common.freedom) < np.inf:
        smaller_one, larger = (m.likelihood.split(m.minimum.residuals) for m in (there, here))
        F, p = f_test_of_lasting(smaller_one, larger, added, common)
    else:
        freedom = _points(here, common) - len(own)
        F, p = f_test(there.minimum.chi2, here.minimum.chi2, added, freedom)
    return {"against": against, "F": F, "p": p}


def _left_out(model: _Model, common: CommonNoise, tell: Tell, name: str) -> dict[str, object]:
    """Return how a model predicts each test from a fit to the others."""
    keys = list(model.fit.comparison.measured)
    groups: dict[str, list[int]] = {}
    for i, (experiment, _) in enumerate(keys):
        groups.setdefault(_test_of(model.fit.study, experiment), []).append(i)
    if len(groups) < 2:
        return {"log_score": np.nan, "left_out_rms": np.nan}
    under = replace(model.likelihood, noise=common.noise)
    found: list[LeftOut] = []
    for group, left in groups.items():
        rest = [i for i in range(len(keys)) if i not in left]
        problem = pose(*_asked(model.fit, [keys[i] for i in rest]))
        noise = tuple(common.noise[i] for i in rest)
        others = Likelihood(problem, noise, prior_of(model.fit.study, problem))
        part = descended(others, noise, model.minimum.x)
        found.append(predicted_score(model.minimum, under, part, left))
        tell(f"{name}: {group} predicted, log score {found[-1].log_score:.1f}")
    squares = [square for one in found for square in one.squares]
    score = sum(one.log_score for one in found)
    return {"log_score": score, "left_out_rms": float(np.sqrt(np.mean(squares)))}


def _test_of(study: Study, name: str) -> str:
    """Return what is left out at once: a heating rate, or a test with its repeats."""
    experiment = study.experiments[name]
    if isinstance(experiment, HeatedExperiment) and experiment.set_point_K is None:
        return f"{experiment.heating_rate_K_min:g} K/min"
    return experiment.repeat.test if experiment.repeat else name
