"""All steps and the Python interface give a cone calorimeter test one and the same chi-square.

Its noise is found about a simulated curve, as no smooth curve follows the ignition.
"""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from cone_twin import study as described

import pyrofit as pf
from pyrofit.api.fitted import Fit
from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.estimate.measures import LIKELIHOOD, measures_of
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import identification, recorded
from pyrofit.results.files import Results, write_csv
from pyrofit.results.record import write_record
from pyrofit.results.searches import End, Starts
from pyrofit.stages import measurements
from pyrofit.stages.identify import identify_imp
from pyrofit.stages.scorer import Scorer, scorer_of
from pyrofit.steps.posterior.compute import likelihood_and_optimum
from pyrofit.steps.worth.best_fit import best_fit

SAME = 1e-6


@pytest.fixture(scope="module")
def study() -> Study:
    return described()


@pytest.fixture(scope="module")
def fitted(study: Study) -> Fit:
    return pf.fit(study, starts=6)


@pytest.fixture(scope="module")
def searched(study: Study, fitted: Fit, tmp_path_factory: pytest.TempPathFactory) -> Results:
    """Results of searches by hand: all end where the descents of `pf.fit` do."""
    results = Results(tmp_path_factory.mktemp("cone") / study.name)
    measurements.prepare(study, results)
    assert fitted.history is not None
    best = fitted.history.iloc[0]
    end = {n: float(best[n]) * study.parameters[n].factor for n in study.imp.estimate}
    about = {"cost": 1.0, "calls": 1}
    only = End(cost=1.0, calls=1, at_bound=[], parameters=end)
    for cost in study.imp.costs:
        starts = Starts(cost_function=cost, seed=study.seed, starts=[only])
        for optimiser in OPTIMISERS:
            write_record(results.starts(cost, optimiser), starts)
    more = {"cost_refined": 1.0, "failed_calls": 0.0}
    rows = [{"cost_function": cost, **about, **more, **end} for cost in study.imp.costs]
    write_csv(results.imp("summary.csv"), pd.DataFrame(rows))
    return results


@pytest.fixture(scope="module")
def results(study: Study, searched: Results) -> Results:
    """The same, with what the step `identify` finds."""
    identify_imp(study, searched)
    return searched


@pytest.fixture(scope="module")
def chi2(results: Results) -> float:
    return float(identification.read_noise(results).chi2)


def estimates(study: Study, results: Results) -> np.ndarray:
    return identification.estimates(study, results)["estimate"].to_numpy(float)


def scorer(study: Study, results: Results, *costs: str) -> tuple[Scorer, list[str]]:
    series = recorded.load(study, results)
    return scorer_of(study, results, series, measures_of(study, series, costs)[0])


def test_chi_square_of_fits_in_python_is_that_of_identify(fitted: Fit, chi2: float) -> None:
    assert fitted.chi2 == pytest.approx(chi2, rel=SAME)


def test_chi_square_of_posterior_is_that_of_identify(
    study: Study, results: Results, chi2: float
) -> None:
    likelihood, optimum = likelihood_and_optimum(study, results)
    assert likelihood.chi2(optimum) == pytest.approx(chi2, rel=SAME)


def test_chi_square_of_worth_is_that_of_identify(
    study: Study, results: Results, chi2: float
) -> None:
    likelihood = best_fit(study, results).model.likelihood
    here = likelihood.scaled(estimates(study, results))
    assert likelihood.chi2(here) == pytest.approx(chi2, rel=SAME)


def test_chi_square_of_rescore_and_sensitivity_is_that_of_identify(
    study: Study, results: Results, chi2: float
) -> None:
    made, left_out = scorer(study, results, LIKELIHOOD)
    assert left_out == []
    assert made.scores(estimates(study, results)[None])[0] == pytest.approx(chi2, rel=SAME)


def test_without_searches_chi_square_of_a_cone_is_left_out_and_why(
    study: Study, tmp_path: Path
) -> None:
    results = Results(tmp_path / study.name)
    measurements.prepare(study, results)
    made, left_out = scorer(study, results)
    assert LIKELIHOOD not in {measure.name for measure in made.measures}
    assert len(left_out) == 1
    assert left_out[0].startswith("chi2: ")
    assert "least_squares.json: this result is missing" in left_out[0]
    with pytest.raises(DataError, match="this result is missing"):
        scorer(study, results, LIKELIHOOD)
