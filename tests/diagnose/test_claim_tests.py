"""The gates of a claim, against densities of linear Gaussian models worked out by hand."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import linear
import numpy as np
import pytest
from linear import POINTS, TOTAL, column_of
from scipy.stats import kstest, multivariate_normal

from pyrofit.diagnose.base.fitted import at_limit
from pyrofit.diagnose.base.inflation import by_misfit, none_for
from pyrofit.diagnose.base.model import model_of, strength_of
from pyrofit.diagnose.base.prediction import HELD_OUT, model_predictions, slab_experiments
from pyrofit.diagnose.judge.claim_tests import Trust, disagreement, explains, trust
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.posterior import UNIFORM
from pyrofit.estimate.prior import NormalPrior
from pyrofit.model.repeats import RepeatOf
from pyrofit.solver.arrays import FloatArray

COLUMNS = linear.random_columns(4, "k_T", size=400.0)
SLAB_25, SLAB_60 = np.arange(TOTAL) < 2 * POINTS, np.arange(TOTAL) >= 2 * POINTS


def truth(k_T: float = 0.0, seed: int = 1) -> FloatArray:
    noise = np.random.default_rng(seed).standard_normal(TOTAL)
    return noise + 2.0 * COLUMNS["rho"] - 3.0 * COLUMNS["k"] + k_T * column_of(COLUMNS, "k_T")


def scores(trial: linear.FittedModel) -> dict[str, float]:
    return model_predictions([trial])[0].scores


def trusted(trial: linear.FittedModel, without: linear.FittedModel) -> Trust:
    own, before = model_predictions([trial, without])
    explained = explains(own, np.random.default_rng(1))
    return trust(trial, "k_T", own, before, explained, none_for(trial))


def p_of(trial: linear.FittedModel) -> float | None:
    return disagreement(trial, "k_T", none_for(trial))


def log_density(J: FloatArray, y: FloatArray, seen: Any, out: Any) -> float:
    """Return ln p(y_out | y_seen), but for the constant, prior N(0.5, 1/12) of each fraction."""
    mean, precision = np.full(J.shape[1], 0.5), UNIFORM * np.eye(J.shape[1])
    after = np.linalg.inv(precision + J[seen].T @ J[seen])
    centre = after @ (precision @ mean + J[seen].T @ y[seen])
    covariance = np.eye(int(np.sum(out))) + J[out] @ after @ J[out].T
    found = multivariate_normal(J[out] @ centre, covariance).logpdf(y[out])
    return float(found + 0.5 * np.sum(out) * np.log(2.0 * np.pi))


def at_zero(J: FloatArray, y: FloatArray, trial: linear.FittedModel) -> FloatArray:
    """Return y as J x describes it, x in fractions: less the curves at the lower limits."""
    lower = trial.model.likelihood.problem.lower
    span = trial.model.likelihood.problem.upper - lower
    return np.asarray(y - J @ (lower / span))


@pytest.mark.parametrize("effects", [(), ("k_T",)], ids=["base", "with an effect"])
@pytest.mark.parametrize(
    ("experiment", "out"), [("slab_25", SLAB_25), ("slab_60", SLAB_60)], ids=["slab_25", "slab_60"]
)
def test_log_score_of_an_experiment_left_out_is_the_exact_log_density(
    effects: tuple[str, ...], experiment: str, out: FloatArray
) -> None:
    y = truth(k_T=0.0)
    trial = linear.fit_with(linear.fit(COLUMNS, y), *effects)
    J = linear.fraction_columns(COLUMNS, trial.model)
    exact = log_density(J, at_zero(J, y, trial), ~out, out)
    # The fit is that without the prior; descents end within 0.05 of the least chi-square.
    assert scores(trial)[experiment] == pytest.approx(exact, abs=0.05)


def test_known_value_of_a_parameter_of_the_experiment_left_out_is_met_without_it() -> None:
    """A pull of that experiment against the known value counts in its prediction."""
    columns = {"rho": COLUMNS["rho"], "k": COLUMNS["k"] * SLAB_60}
    y = np.random.default_rng(1).standard_normal(TOTAL) + 2.0 * columns["rho"] - columns["k"]
    known = NormalPrior((1,), np.array([-0.5]), np.array([0.1]))
    trial = linear.fit(columns, y, known=known)
    J = linear.fraction_columns(columns, trial.model)
    z = at_zero(J, y, trial)
    # The known value is one more point that is seen.
    J = np.vstack([J, [0.0, linear.SPAN / 0.1]])
    z = np.append(z, (-0.5 + 0.5 * linear.SPAN) / 0.1)
    exact = log_density(J, z, np.append(~SLAB_60, True), np.append(SLAB_60, False))
    assert scores(trial)["slab_60"] == pytest.approx(exact, abs=0.05)


def test_log_score_of_what_is_held_out_is_the_exact_log_density() -> None:
    y = truth()
    trial = linear.fit(COLUMNS, y, calibrated=(0, 1, 2))
    whole = linear.fit(COLUMNS, y)
    J = linear.fraction_columns(COLUMNS, whole.model)
    out = np.arange(TOTAL) >= 3 * POINTS
    exact = log_density(J, at_zero(J, y, whole), ~out, out)
    assert scores(trial)[HELD_OUT] == pytest.approx(exact, abs=0.05)


def test_prediction_by_a_model_that_knows_little_is_uncertain_not_wrong() -> None:
    """What is left of a wide prior pays by its determinant, not by a misfit of the mean."""
    only_60 = dict(COLUMNS)
    only_60["k"] = COLUMNS["k"] * SLAB_60  # the other experiment says nothing of k
    y = truth() - 2.0 * COLUMNS["rho"] + 3.0 * COLUMNS["k"] + 4.0 * only_60["k"]
    trial = linear.fit(only_60, y)
    J = linear.fraction_columns(only_60, trial.model)
    room = 0.5 * np.log1p(np.sum(J[SLAB_60, 1] ** 2) / UNIFORM)
    assert scores(trial)["slab_60"] == pytest.approx(-0.5 * 2 * POINTS - room, abs=20.0)
    # As a prediction of its lower limit without any room it would be hopeless.
    assert -0.5 * float(np.sum((0.5 * J[SLAB_60, 1]) ** 2)) < -1000.0


def test_right_effect_gains_and_useless_one_does_not() -> None:
    typical = strength_of("k_T")[1].typical
    for hidden, gains in ((0.5 * typical, True), (0.0, False)):
        base = linear.fit(COLUMNS, truth(hidden))
        more = linear.fit_with(base, "k_T")
        found = trusted(more, base)
        assert found.predicts == gains
        assert set(found.gains) == {"slab_25", "slab_60"}
        assert found.gains["slab_25"] == pytest.approx(
            scores(more)["slab_25"] - scores(base)["slab_25"]
        )


def test_strengths_that_differ_between_experiments_disagree() -> None:
    typical = strength_of("k_T")[1].typical
    column = column_of(COLUMNS, "k_T")
    twice = truth(0.2 * typical) + 0.2 * typical * column * SLAB_60
    differing = linear.fit_with(linear.fit(COLUMNS, twice), "k_T")
    assert p_of(differing) < Settings().agreement_level
    assert p_of(linear.fit_with(linear.fit(COLUMNS, truth(0.2 * typical)), "k_T")) > 0.01


def test_disagreement_of_equal_strengths_is_a_probability() -> None:
    typical = strength_of("k_T")[1].typical
    values = []
    for seed in range(100):
        trial = linear.fit_with(linear.fit(COLUMNS, truth(0.2 * typical, seed)), "k_T")
        values.append(p_of(trial))
    assert kstest(values, "uniform").pvalue > 0.01, sorted(values)


def test_effect_that_shows_in_one_experiment_only_has_no_agreement() -> None:
    columns = {**COLUMNS, linear.strength_name("k_T"): column_of(COLUMNS, "k_T") * SLAB_25}
    trial = linear.fit_with(linear.fit(columns, truth()), "k_T")
    assert p_of(trial) is None


def test_lasting_misfit_counts_as_lasting_noise_in_the_agreement_of_strengths() -> None:
    """Misfit of 1.5 standard deviations that lasts over 5 points: its points tell little each."""
    typical = strength_of("k_T")[1].typical
    alone, inflated = [], []
    for seed in range(100):
        rng = np.random.default_rng([seed, 2])
        misfit = np.repeat(1.5 * rng.standard_normal(TOTAL // 5), 5)
        y = truth(0.2 * typical, seed) + misfit
        trial = linear.fit_with(linear.fit(COLUMNS, y), "k_T")
        alone.append(p_of(trial))
        inflated.append(disagreement(trial, "k_T", by_misfit(trial)))
    assert np.mean(np.array(alone) < 0.01) > 0.25
    assert np.mean(np.array(inflated) < 0.01) < 0.05


def test_inflation_counts_misfit_of_its_own_signal_only() -> None:
    misfit = np.where(np.arange(TOTAL) < POINTS, 3.0 * np.sin(np.arange(TOTAL) / 4.0), 0.0)
    trial = linear.fit(COLUMNS, truth() + misfit)
    first, *others = by_misfit(trial).factors
    assert first > 10.0
    assert max(others) < 2.0
    assert min(others) >= 1.0
    inflation = by_misfit(trial)
    assert inflation.chi2(trial) < 0.7 * trial.fit.chi2
    assert none_for(trial).penalised(trial) == trial.penalised


@pytest.mark.parametrize(
    ("x", "found"),
    [(0.0, True), (0.004, True), (0.006, False), (0.5, False), (0.994, False), (0.996, True)],
)
def test_effect_within_half_a_percent_of_a_limit_rests_there(x: float, found: bool) -> None:
    trial = linear.fit_with(linear.fit(COLUMNS, truth()), "k_T")
    resting = linear.moved(trial, x=np.array([0.0, 1.0, x]))  # those of the base do not count
    assert at_limit(resting, "k_T") == ("k_T_slope_1_K" if found else "")


@pytest.mark.parametrize(("x", "found"), [(0.0, False), (0.004, False), (0.5, False), (1.0, True)])
def test_nothing_left_of_what_is_usually_there_is_a_state_and_no_limit(
    x: float, found: bool
) -> None:
    """A factor of 0 on the loss of the back is an insulated back."""
    trial = linear.fit_with(linear.fit(COLUMNS, truth()), "back_loss")
    resting = linear.moved(trial, x=np.array([0.5, 0.5, x]))
    assert at_limit(resting, "back_loss") == ("back_loss_factor" if found else "")


@pytest.mark.parametrize(
    ("gains", "informative", "predicts"),
    [
        ({}, False, False),
        ({"a": 1.9, "b": -1.9}, False, False),
        ({"a": 1.5, "b": 1.0}, False, True),
        ({"a": 30.0, "b": -2.5}, True, False),
        ({"a": 30.0, "b": -1.5}, True, True),
        ({"a": -3.0}, True, False),
    ],
)
def test_prediction_improves_on_the_whole_and_gets_clearly_worse_nowhere(
    gains: dict[str, float], informative: bool, predicts: bool
) -> None:
    found = Trust("", 1.0, gains, True)
    assert found.informative == informative
    assert found.predicts == predicts


@pytest.mark.parametrize(
    ("gains", "expected", "predicts"),
    [
        ({"a": 30.0, "b": -2.5}, {"b": 5.3}, True),
        ({"a": 30.0, "b": -2.5}, {"b": 5.5}, False),
        ({"a": 30.0, "b": -2.5}, {"b": 1.9}, True),
        ({"a": 4.0, "b": -2.5}, {"b": 5.3}, False),  # it counts in the sum
        ({"a": 4.0, "b": -2.5}, {"b": 1.9}, True),
    ],
)
def test_prediction_of_little_power_does_not_reject_an_effect_alone(
    gains: dict[str, float], expected: dict[str, float], predicts: bool
) -> None:
    assert Trust("", 1.0, gains, True, powers=expected).predicts == predicts


def test_sign_of_a_deciding_gain_is_wrong_in_a_twentieth_of_all_cases() -> None:
    """ln p(y | d) - ln p(y | 0) of y = d + noise has the mean |d|^2/2."""
    d = np.full(8, np.sqrt(2.0 * Settings().deciding_gain / 8))
    y = d + np.random.default_rng(4).standard_normal((40_000, 8))
    gain = 0.5 * (np.sum(y**2, axis=1) - np.sum((y - d) ** 2, axis=1))
    assert np.mean(gain < 0.0) == pytest.approx(0.05, abs=0.004)


@pytest.mark.parametrize(
    ("gains", "confirmed"),
    [
        ({"a": 30.0}, True),
        ({"a": 30.0, HELD_OUT: 2.0}, True),
        ({"a": 30.0, HELD_OUT: 1.9}, False),
        ({"a": 1.0, HELD_OUT: 30.0}, True),
        ({"a": -2.5, HELD_OUT: 30.0}, False),
        ({"a": 30.0, "b": 30.0, HELD_OUT: -2.5}, False),
        ({"a": 30.0, "b": 30.0, f"{HELD_OUT}: A": -30.0, f"{HELD_OUT}: B": 2.0}, True),
        ({"a": 30.0, "b": 30.0, f"{HELD_OUT}: A": -30.0, f"{HELD_OUT}: B": 1.9}, False),
        ({}, False),
    ],
)
def test_what_is_held_out_must_be_predicted_better_for_an_effect_to_be_sure(
    gains: dict[str, float], confirmed: bool
) -> None:
    assert Trust("", 1.0, gains, True).confirmed == confirmed


def test_gain_counts_in_units_of_the_misfit_of_the_predicted_signals() -> None:
    """A laboratory that no model follows tells less than one that is simulated well."""
    typical = strength_of("k_T")[1].typical
    misfit = 4.0 * np.sin(np.arange(TOTAL) / 4.0) * SLAB_60
    base = linear.fit(COLUMNS, truth(0.5 * typical) + misfit)
    trial = linear.fit_with(base, "k_T")
    own, before = model_predictions([trial, base])
    found = trust(trial, "k_T", own, before, None, by_misfit(trial))
    raw = {name: own.scores[name] - before.scores[name] for name in own.scores}
    by_signal = by_misfit(trial).factors
    for name, factors in (("slab_25", by_signal[:2]), ("slab_60", by_signal[2:])):
        assert found.gains[name] == pytest.approx(raw[name] / max(factors))
    assert max(by_signal[:2]) < 3.0
    assert min(by_signal[2:]) > 10.0


def test_one_slab_alone_is_not_left_out() -> None:
    trial = linear.fit(COLUMNS, truth(), calibrated=(0, 1))
    assert slab_experiments(trial) == []
    assert list(scores(trial)) == [HELD_OUT]
    channels = [("slab", "mlr"), ("tga", "mass_fraction")]
    kinds = {"slab": "gasification", "tga": "tga"}
    runs = {n: SimpleNamespace(experiment=SimpleNamespace(kind=k)) for n, k in kinds.items()}
    likelihood = SimpleNamespace(problem=SimpleNamespace(runs=runs))
    base = SimpleNamespace(channels=channels, likelihood=likelihood)
    model = SimpleNamespace(base=base, channels=(0, 1))
    fake: Any = SimpleNamespace(model=model)
    assert slab_experiments(fake) == []


@pytest.mark.parametrize(
    ("laboratories", "places"),
    [
        (("", ""), ["held out: slab_25", "held out: slab_60"]),
        (("A", "B"), ["held out: A", "held out: B"]),
        (("A", "A"), [HELD_OUT]),
    ],
)
def test_held_out_tests_of_one_laboratory_are_one_prediction(
    laboratories: tuple[str, str], places: list[str]
) -> None:
    """An error of its apparatus shows in all its tests, and counts once."""
    trial = linear.fit(COLUMNS, truth(), calibrated=(0,))
    base = trial.model.base
    problem = base.likelihood.problem
    runs = {
        name: replace(run, experiment=run.experiment.model_copy(update={"laboratory": laboratory}))
        for (name, run), laboratory in zip(problem.runs.items(), laboratories, strict=True)
    }
    likelihood = replace(base.likelihood, problem=replace(problem, runs=runs))
    model = model_of(replace(base, likelihood=likelihood), {}, trial.model.channels)
    assert list(scores(replace(trial, model=model))) == places


def test_repeats_of_one_test_are_one_prediction() -> None:
    trial = linear.fit(COLUMNS, truth(), calibrated=(0,))
    base = trial.model.base
    problem = base.likelihood.problem
    runs = {
        name: replace(
            run, experiment=run.experiment.model_copy(update={"repeat": RepeatOf(test="slab")})
        )
        for name, run in problem.runs.items()
    }
    likelihood = replace(base.likelihood, problem=replace(problem, runs=runs))
    model = model_of(replace(base, likelihood=likelihood), {}, trial.model.channels)
    assert list(scores(replace(trial, model=model))) == [HELD_OUT]


def test_misfit_of_what_is_held_out_is_noticed() -> None:
    wrong = truth()
    wrong[3 * POINTS + 10 : 3 * POINTS + 30] += 6.0
    for y, explained in ((truth(), True), (wrong, False)):
        trial = linear.fit_with(linear.fit(COLUMNS, y, calibrated=(0, 1, 2)), "k_T")
        found = trusted(trial, trial)
        assert found.explains == explained
