"""Heats, a baseline and a response time are recovered from data of the independent solver."""

import copy
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from calorimetry_study import STUDY

from pyrofit.config import Study, as_study
from pyrofit.results import kinetics
from pyrofit.results.files import Results
from pyrofit.results.recorded import load
from pyrofit.show.figure import draw_figure
from pyrofit.show.subjects.kinetics import PAGE
from pyrofit.stages.fit import fit_kinetics
from pyrofit.stages.identify import identify_kinetics
from pyrofit.stages.kinetic_curves import write_curves
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


def test_heats_are_drawn_and_scored_beside_the_data(fitted: tuple[Study, Results]) -> None:
    study, results = fitted
    for name in ("fig2", "kinetics_all_rates", "heats"):
        assert PAGE.figures[name].applies(study)
        draw_figure(PAGE.figures[name], name, study, results)
        assert (results.root / "figures" / f"{name}.svg").stat().st_size > 5000
    scores = PAGE.tables["heat_scores"].make(study, results)
    assert scores["quantity"].tolist() == [
        "RMSE of heat flow",
        "RMSE of specific heat release rate",
    ]
    # The noise, in W/g.
    np.testing.assert_allclose(scores["fitted"], [0.015, 2.0], rtol=0.15)
    assert set(scores["used_in_fit"]) == {"yes"}


def test_study_without_mass_has_scores_of_its_heats_alone(tmp_path: Path) -> None:
    given = copy.deepcopy(STUDY)
    del given["experiments"]["sta_10"]["signals"]["mass_fraction"]
    del given["kinetics"]["cost"][0]
    study, results = as_study(given, "calorimetry.yaml"), Results(tmp_path)
    prepare(study, results)
    write_curves(study, results, load(study, results), study.true_values())
    assert pd.read_csv(results.kinetics("curves.csv")).empty
    assert pd.read_csv(results.kinetics("scores.csv")).empty
    assert len(pd.read_csv(results.kinetics("heat_scores.csv"))) == 4
    applies = {name for name, figure in PAGE.figures.items() if figure.applies(study)}
    assert applies == {"heats"}
