"""Heats, a baseline and a response time are recovered from data of the independent solver."""

import pandas as pd
import pytest
from calorimetry_study import STUDY

from pyrofit.config import Study, as_study
from pyrofit.results import kinetics
from pyrofit.results.files import Results
from pyrofit.stages.fit import fit_kinetics
from pyrofit.stages.identify import identify_kinetics
from pyrofit.stages.measurements import prepare


@pytest.fixture(scope="module")
def fitted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Study, Results]:
    study = as_study(STUDY, "calorimetry.yaml")
    results = Results(tmp_path_factory.mktemp("results"))
    prepare(study, results)
    fit_kinetics(study, results)
    identify_kinetics(study, results)
    return study, results


def test_every_parameter_lies_within_its_interval(fitted: tuple[Study, Results]) -> None:
    study, results = fitted
    found = pd.read_csv(results.identification("estimate.csv", "kinetics")).set_index("parameter")
    truth = study.true_values()
    off = {n: (found.at[n, "estimate"] - truth[n]) / found.at[n, "sd"] for n in found.index}
    assert len(off) == 8
    assert max(abs(x) for x in off.values()) < 3.5, off


@pytest.mark.parametrize(
    ("name", "share"), [("dh", 0.02), ("c", 0.05), ("h", 0.01), ("tau", 0.1), ("T_p", 1e-3)]
)
def test_heats_are_recovered(fitted: tuple[Study, Results], name: str, share: float) -> None:
    study, results = fitted
    found = kinetics.parameters(study, results)[name]
    assert found == pytest.approx(study.true_values()[name], rel=share)
