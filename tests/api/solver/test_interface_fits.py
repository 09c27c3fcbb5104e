"""Simulations and fits of the Python interface against the truth and the steps of the workflow."""

from html.parser import HTMLParser
from pathlib import Path

import matplotlib
import numpy as np
import pandas as pd
import pytest
from made_records import searched
from matplotlib.figure import Figure

import pyrofit as pf
from pyrofit.config import diagnosed_material
from pyrofit.errors import StudyError
from pyrofit.results.files import Results, write_csv
from pyrofit.results.record import write_record
from pyrofit.simulate import simulate_gasification
from pyrofit.solver.curves import Request
from pyrofit.stages.identify import identify_kinetics
from pyrofit.stages.measurements import computed

matplotlib.use("agg")
ROOT = Path(__file__).parents[3]
SMOKE = ROOT / "config" / "smoke.yaml"
MLR = ("slab_25", "mlr")


@pytest.fixture(scope="module")
def study() -> pf.Study:
    return pf.read_study(SMOKE)


@pytest.fixture(scope="module")
def data(study: pf.Study) -> dict[tuple[str, str], pd.DataFrame]:
    return computed(study, fast=True)


@pytest.fixture(scope="module")
def fit(study: pf.Study, data: dict[tuple[str, str], pd.DataFrame]) -> pf.Fit:
    return pf.fit(study, data)


def test_simulation_is_that_of_the_solver(study: pf.Study) -> None:
    truth = study.synthetic.truth
    curves = pf.simulate(study, truth, experiments="slab_25")
    times = curves[MLR]["time_s"].to_numpy()
    material = diagnosed_material(study)
    run = simulate_gasification(
        study.experiments["slab_25"],
        material,
        study.true_values(),
        {"mlr": Request(times, average_s=5.0)},
        study.accuracy,
    )
    assert np.array_equal(curves[MLR]["mlr_kg_m2_s"], run.signals["mlr"])


def test_fit_finds_the_truth(study: pf.Study, fit: pf.Fit) -> None:
    truth = pd.Series(study.synthetic.truth)
    off = (fit.table["value"] - truth) / fit.table["sd"]
    assert off.abs().max() < 3.5
    assert set(fit.table.index) == set(truth.index)
    assert 0.8 < fit.reduced_chi2 < 1.2
    assert fit.table.loc["dh", "unit"] == "kJ/kg"
    inside = (fit.table["low"] < fit.table["value"]) & (fit.table["value"] < fit.table["high"])
    assert inside.all()
    assert np.allclose(np.diag(fit.correlation), 1.0)


def test_stage_has_the_intervals_of_the_workflow(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame], tmp_path: Path
) -> None:
    found = pf.fit(study, data, stage="kinetics")
    results = Results(tmp_path)
    for (name, signal), frame in data.items():
        write_csv(results.measurement(name, signal), frame)
    values = {n: v * study.parameters[n].factor for n, v in found.values.items()}
    write_record(results.kinetics("fit.json"), searched(values, 0.0))
    identify_kinetics(study, results)
    theirs = pd.read_csv(results.identification("estimate.csv", "kinetics"), index_col="parameter")
    factors = pd.Series({n: study.parameters[n].factor for n in theirs.index})
    for mine, column in (("value", "estimate"), ("sd", "sd"), ("low", "low"), ("high", "high")):
        expected = theirs[column] / factors
        assert np.allclose(found.table[mine], expected, rtol=1e-5), column


def test_linear_intervals_are_those_of_the_parabola(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame], fit: pf.Fit
) -> None:
    found = pf.fit(study, data, profiles=False)
    assert set(found.table["method"]) == {"linear"}
    assert np.allclose(found.table["sd"], fit.table["sd"], rtol=0.02)
    reach = 1.96 * found.table["sd"]
    assert np.allclose(found.table["high"], found.table["value"] + reach)


def test_second_stage_keeps_the_kinetics_of_the_first(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame]
) -> None:
    found = pf.fit(study, data, stage="imp", profiles=False)
    first = pf.fit(study, data, stage="kinetics", profiles=False)
    assert list(found.table.index) == list(study.imp.estimate)
    assert {n: found.values[n] for n in first.values} == pytest.approx(first.values, rel=1e-12)


def test_one_curve_is_fitted_by_the_parameters_that_are_named(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame]
) -> None:
    truth = study.synthetic.truth
    fixed = {n: v for n, v in truth.items() if n not in ("k", "cp")}
    found = pf.fit(
        study, {MLR: data[MLR]}, signals={"slab_25": "mlr"}, estimate=["k", "cp"], fixed=fixed
    )
    assert list(found.table.index) == ["k", "cp"]
    for name in ("k", "cp"):
        assert abs(found.table.loc[name, "value"] - truth[name]) < 3.5 * found.table.loc[name, "sd"]
    assert found.values["rho"] == truth["rho"]


def test_isothermal_record_is_drawn_over_time() -> None:
    held = {"experiments.tga_5K.set_point_K": 620, "experiments.tga_5K.hold_s": 3000}
    study = pf.read_study(SMOKE, **held)
    curves = pf.simulate(study, {"T_p": 605, "E_p": 190}, experiments=["tga_5K", "tga_20K"])
    assert curves.plot("tga_5K", ax=Figure().subplots()).get_xlabel() == "time [s]"
    assert curves.plot("tga_20K", ax=Figure().subplots()).get_xlabel() == "temperature [°C]"
    assert "tga_5K" in curves
    assert ("tga_5K", "mass_fraction") in curves
    assert "slab_25" not in curves
    assert curves.get("slab_25") is None
    assert [len(t) for t in curves.values()] == [len(t) for _, t in curves.items()]
    with pytest.raises(StudyError, match="give Axes as `ax=`"):
        curves.plot(Figure().subplots())


def test_measured_curve_is_fitted_without_computed_ones(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame]
) -> None:
    key = ("tga_20K", "mass_fraction")
    found = pf.fit(study, {key: data[key]})
    assert found.signals[["experiment", "signal"]].to_numpy().tolist() == [list(key)]
    assert list(found.table.index) == ["T_p", "E_p"]
    named = pf.fit(study, data, signals=[key])
    assert np.array_equal(named.table["value"], found.table["value"])


def test_fit_has_covariance_criteria_and_intervals_at_other_levels(fit: pf.Fit) -> None:
    assert np.allclose(np.sqrt(np.diag(fit.covariance)), fit.table["sd"])
    points = fit.signals["points"].sum()
    assert fit.aic == fit.chi2 + 2 * len(fit.table)
    assert fit.bic == pytest.approx(fit.chi2 + len(fit.table) * np.log(points))
    assert np.allclose(fit.intervals(0.95), fit.table[["low", "high"]])
    narrow = fit.intervals(0.6827)
    linear = fit.table["method"] == "linear"
    width = (narrow["high"] - narrow["low"])[linear]
    assert np.allclose(width, 2.0 * fit.table["sd"][linear], rtol=1e-3)
    with pytest.raises(StudyError, match="not between 0 and 1"):
        fit.intervals(1.5)
    assert fit.history["chi2"].is_monotonic_increasing
    assert fit.history["cp"].between(1.0, 3.0).all()


def test_expression_has_a_value_and_the_sd_of_its_parameters(
    data: dict[tuple[str, str], pd.DataFrame],
) -> None:
    keys = {"parameters.E_h": {"unit": "kJ/mol", "expression": "0.5 * E_p"}}
    study = pf.read_study(SMOKE, **keys)
    found = pf.fit(study, data, signals="tga_5K")
    row, of = found.derived.loc["E_h"], found.table.loc["E_p"]
    assert row["value"] == pytest.approx(0.5 * of["value"])
    assert row["sd"] == pytest.approx(0.5 * of["sd"], rel=1e-6)
    assert "Expressions\n" in str(found)


def test_report_writes_values_to_their_sd_and_lists_fixed_parameters(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame]
) -> None:
    found = pf.fit(study, data, signals="tga_5K", fixed={"E_p": 190.0})
    text = str(found)
    value, sd = found.table.loc["T_p", ["value", "sd"]]
    assert f"{value:.3f}  {sd:.3f}" in text
    assert "Fixed\n  name  value  unit\n  E_p   190    kJ/mol" in text


def test_cost_is_minimised_by_an_optimiser_of_the_study(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame]
) -> None:
    truth = study.synthetic.truth
    kinetics = {n: truth[n] for n in ("T_p", "E_p")}
    found = pf.fit(study, data, cost="RMSE", fixed=kinetics)
    assert found.cost == found.history["cost"].min()
    assert len(found.history) == study.imp.least_squares.starts
    assert found.history["cp"].iloc[0] == pytest.approx(found.values["cp"])  # in its unit
    # The cost RMSE of the study is normalised by the mean.
    (score,) = found.signals["cv_rmse"]
    assert found.cost == pytest.approx(score, rel=1e-9)
    assert "cost RMSE, Multistart least squares" in str(found)
    with pytest.raises(StudyError, match="no correlations"):
        found.plot_correlation()


def test_published_kinetics_are_kept_where_the_study_says_so(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame]
) -> None:
    # As in the study of the paper: the diagnosis fits kinetics, the costs take published ones.
    reaction = {"A_1_s": 1.0e13, "E_J_mol": 190e3, "order": 1.0}
    published = {"composition": {"polymer": 1.0}, "reactions": {"pyrolysis": reaction}}
    changes = {"kinetics.sets": {"Book": published}, "imp.kinetics": "Book"}
    other = pf.read_study(study, **changes, **{"diagnosis.kinetics": "fitted"})
    found = pf.fit(other, data, cost="RMSE")
    assert not {"T_p", "E_p"} & set(found.values)
    rest = {n: v for n, v in found.values.items() if n != "k"}
    again = pf.compare(other, found.values, signals={"slab_25": "mlr"}, data=data, kinetics="Book")
    assert found.cost == pytest.approx(again.scores["cv_rmse"][0], rel=1e-9)
    held = pf.fit(other, data, cost="RMSE", fixed={"k": found.values["k"]})
    assert list(held.table.index) == list(rest)
    assert held.cost == pytest.approx(found.cost, rel=1e-3)
    kinetics = pf.fit(other, data, stage="kinetics", profiles=False)
    assert set(kinetics.table.index) == {"T_p", "E_p"}
    with pytest.raises(StudyError, match=r"unknown kinetics 'Bok'\. Did you mean 'Book'"):
        pf.simulate(other, found.values, kinetics="Bok")


def test_scores_of_a_prediction_are_those_of_its_values(
    study: pf.Study, data: dict[tuple[str, str], pd.DataFrame], fit: pf.Fit
) -> None:
    held_out = fit.predict({"slab_60": "mlr"}, data)
    y, f = held_out.values(("slab_60", "mlr"))
    (score,) = held_out.scores.to_dict("records")
    assert score["rmse"] == pytest.approx(np.sqrt(np.mean((y - f) ** 2)))
    assert score["r2"] == pytest.approx(1.0 - np.var(y - f) / np.var(y), abs=1e-3)
    assert score["r2"] > 0.99
    assert held_out.frame["measured"].size == len(data["slab_60", "mlr"])


class Balanced(HTMLParser):
    """Keeps the open tags."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_report_and_page_show_values_intervals_and_correlations(fit: pf.Fit) -> None:
    text = str(fit)
    for name, row in fit.table.iterrows():
        assert f"  {name} " in text
        assert row["unit"] in text
    assert "95 % interval" in text
    assert "eps" in text.split("Correlations of 0.3 or more")[1]
    page = Balanced()
    page.feed(fit._repr_html_())
    page.close()
    assert page.open == []


def test_plots_draw_what_was_fitted(fit: pf.Fit, data: object) -> None:
    ax = Figure().subplots()
    fit.plot("slab_25", "mlr", ax=ax)
    measured, simulated = ax.lines
    y, f = fit.comparison.values(MLR)
    assert np.allclose(measured.get_ydata(), 1e3 * y)
    assert np.allclose(simulated.get_ydata(), 1e3 * f)
    residuals = fit.plot_residuals("slab_25", "mlr", Figure().subplots())
    assert np.allclose(residuals.lines[0].get_ydata(), 1e3 * (f - y))
    assert len(fit.plot_all()) == len(fit.signals) == 3
    intervals = fit.plot_intervals(Figure().subplots())
    assert [t.get_text() for t in intervals.get_yticklabels()] == list(fit.table.index)
    matrix = fit.plot_correlation(Figure().subplots())
    assert np.allclose(matrix.images[0].get_array(), fit.correlation)
    with pytest.raises(StudyError, match="several series are there"):
        fit.plot()
