"""Known values of parameters: limits of searches, rows of the likelihood, the table."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnosis_keys import study_with
from line_model import LINE, by_name, likelihood, line
from shown_studies import described, fake

from pyrofit.config import digest
from pyrofit.estimate.identify import identify
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.prior import NO_PRIOR, NormalPrior, prior_of
from pyrofit.results import dependencies
from pyrofit.results.step import slice_of
from pyrofit.show.facts import facts_of
from pyrofit.show.subjects.identification.known_values import known_values_table as known_values
from pyrofit.show.subjects.identification.sentences import sentences

SPAN = np.array([2.0, 4.0])
START = [np.array([0.4, 0.6])]


def known(value: float, sd: float, at: int = 1) -> NormalPrior:
    return NormalPrior((at,), np.array([value]), np.array([sd]))


def with_prior(posed: Likelihood, prior: NormalPrior) -> Likelihood:
    return replace(posed, prior=prior)


def posterior(sd: float, prior: NormalPrior, best: Any = (1.0, 2.0)) -> tuple[Any, Any]:
    """Return mean and covariance of the line's parameters: regression, a known slope, limits.

    The limits are no part of the mean: they do not pull.
    """
    H = LINE.T @ LINE / sd**2
    K = np.zeros((2, 2))
    K[1, 1] = 1.0 / prior.sd[0] ** 2
    mean = np.linalg.solve(H + K, H @ np.array(best) + K[:, 1] * prior.mean[0])
    return mean, np.linalg.inv(H + K + np.diag(12.0 / SPAN**2))


@pytest.mark.parametrize("sd", [0.3, 0.03, 0.003])
def test_interval_with_a_known_value_is_that_of_the_normal_posterior(sd: float) -> None:
    prior = known(2.02, sd)
    found = identify(with_prior(line(), prior), START)
    mean, covariance = posterior(0.1 * np.sqrt(found.posterior.dispersion), prior)
    for i, estimate in enumerate(found.estimates):
        assert estimate.x * SPAN[i] == pytest.approx(mean[i], abs=2e-5)
        assert estimate.sd * SPAN[i] == pytest.approx(np.sqrt(covariance[i, i]), rel=1e-6)
        assert estimate.interval.width == pytest.approx(2 * 1.96 * estimate.sd)


def test_tight_known_value_moves_what_is_correlated_along_the_regression() -> None:
    free = by_name(identify(line(), START))
    bound = by_name(identify(with_prior(line(), known(2.05, 1e-6)), START))
    C = np.linalg.inv(LINE.T @ LINE)
    assert bound["b"].x * 4.0 == pytest.approx(2.05, abs=1e-6)
    moved = (bound["a"].x - free["a"].x) * 2.0
    assert moved == pytest.approx(C[0, 1] / C[1, 1] * 0.05, rel=1e-4)
    assert bound["a"].sd < 0.6 * free["a"].sd  # sqrt(1 - 3/4) of it


def test_misfit_widens_the_noise_but_not_what_is_known() -> None:
    value = line().problem.cost.terms[0][1].target.value
    half = likelihood(lambda x: LINE @ x, value, 0.05, ((0.0, 2.0), (0.0, 4.0)))
    prior = known(2.01, 0.01)
    found = identify(with_prior(half, prior), START)
    assert found.posterior.dispersion == pytest.approx(4.0, rel=0.02)
    mean, covariance = posterior(0.05 * np.sqrt(found.posterior.dispersion), prior)
    for i, estimate in enumerate(found.estimates):
        assert estimate.x * SPAN[i] == pytest.approx(mean[i], abs=1e-4)
        assert estimate.sd * SPAN[i] == pytest.approx(np.sqrt(covariance[i, i]), rel=1e-3)
    assert found.estimates[1].sd * 4.0 < 0.01


def test_chi_square_per_degree_of_freedom_counts_channels_alone() -> None:
    free = identify(line(), START)
    bound = identify(with_prior(line(), known(3.0, 0.05)), START)
    assert bound.posterior.chi2 > free.posterior.chi2
    assert bound.optimum.chi2 > bound.posterior.chi2 + 10.0
    posed = line()
    residuals = posed.residuals(bound.optimum.x)
    assert bound.posterior.chi2 == pytest.approx(float(residuals @ residuals))


def test_nothing_known_leaves_residuals_and_derivatives_to_the_bit() -> None:
    posed, x = line(), np.array([0.3, 0.7])
    assert posed.prior is NO_PRIOR
    assert posed.residuals(x).size == posed.points[0]
    assert posed.jacobian(x, posed.residuals(x)).shape == (posed.points[0], 2)
    slopes = posed.slopes(x)
    assert np.array_equal(posed.with_known(slopes), posed.whiten(slopes))


def test_rows_of_what_is_known_are_derivatives_of_its_residuals() -> None:
    posed, x = with_prior(line(), known(2.2, 0.1)), np.array([0.3, 0.7])
    assert posed.residuals(x)[-1] == pytest.approx((4.0 * 0.7 - 2.2) / 0.1)
    assert posed.with_known(posed.slopes(x))[-1].tolist() == [0.0, 4.0 / 0.1]
    by_differences = posed.jacobian(x, posed.residuals(x))
    assert by_differences == pytest.approx(posed.with_known(posed.slopes(x)), abs=1e-8)
    assert [part.size for part in posed.split(posed.residuals(x))] == posed.points


# --- studies --------------------------------------------------------------------------------

KNOWN = {"k": {"value": 0.15, "sd": 0.02}, "dh": {"value": 800, "sd": 1000}}


def test_searches_reach_three_standard_deviations_and_the_limits() -> None:
    study = study_with(known=KNOWN)
    limits = study.parameters["k"].lower, study.parameters["k"].upper
    low, high = study.search_limits("k")
    assert low == max(limits[0], 0.15 - 0.06)
    assert high == pytest.approx(0.21)
    dh = study.parameters["dh"]
    assert study.search_limits("dh") == (dh.lower, dh.upper)
    assert study.search_limits("rho") == (study.parameters["rho"].lower, 1500.0)


def test_problem_is_searched_and_known_in_si_units() -> None:
    study = study_with(known={"dh": {"value": 800, "sd": 10}, "k": {"value": 0.15, "sd": 0.02}})
    names = ("rho", "k", "dh")
    posed: Any = SimpleNamespace(names=names)
    prior = prior_of(study, posed)
    assert [names[i] for i in prior.index] == ["dh", "k"]
    assert prior.mean.tolist() == [800e3, 0.15]
    assert prior.sd.tolist() == [10e3, 0.02]
    of_imp = prior_of(study, SimpleNamespace(names=("T_p",)))  # type: ignore[arg-type]
    assert of_imp.index == ()


@pytest.mark.parametrize(
    "step",
    [
        lambda study: dependencies.imp(study, "RMSE", "sceua"),
        dependencies.identify_slice,
        dependencies.diagnose_slice,
        dependencies.compare_slice,
        lambda study: slice_of(study, "robustness", "RMSE"),
    ],
    ids=["imp", "identify", "diagnose", "compare", "robustness"],
)
def test_steps_depend_on_known_values_but_not_on_their_source(step: Any) -> None:
    entry = {"value": 0.15, "sd": 0.02}
    plain, sourced, other = (
        digest(step(study_with(known={"k": k})))
        for k in (entry, {**entry, "source": "hot disk"}, {**entry, "sd": 0.03})
    )
    assert plain == sourced
    assert len({digest(step(study_with())), plain, other}) == 3


def test_kinetics_do_not_depend_on_known_values_of_the_slab() -> None:
    slab = study_with(known={"k": {"value": 0.15, "sd": 0.02}})
    assert digest(dependencies.kinetics(slab)) == digest(dependencies.kinetics(study_with()))


def test_estimate_far_from_its_known_value_is_flagged_in_table_and_report(tmp_path: Path) -> None:
    near = {"value": 0.2, "sd": 0.5, "source": "hot disk"}
    study, results = fake(tmp_path, described(known={"k": near}))
    row = known_values(study, results).iloc[0]
    assert (row["known"], row["known_sd"], row["source"]) == (0.2, 0.5, "hot disk")
    assert row["away_sd"] == pytest.approx((row["estimate"] - 0.2) / 0.5)
    assert row["flag"] is None
    said = sentences(study, facts_of(study, results, {}))
    assert "All estimates are within 2 standard deviations of their known values." in said
    far = {"value": float(row["estimate"]) + 0.025, "sd": 0.01}
    study, results = fake(tmp_path, described(known={"k": far}))
    row = known_values(study, results).iloc[0]
    assert row["away_sd"] == pytest.approx(-2.5)
    assert row["flag"] == "more than 2 sd away"
    assert any(
        "k of the inverse modelling" in text
        for text in sentences(study, facts_of(study, results, {}))
    )
