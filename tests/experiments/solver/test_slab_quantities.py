"""Mass and temperatures of a slab: read, described, asked for, and refused where it is wrong."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from bad_input import STUDY

from pyrofit.config import Study, as_study
from pyrofit.data.series import Measurement, read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.effects import known_effects
from pyrofit.errors import DataError, StudyError
from pyrofit.experiments import KINDS, Gasification, kind_of
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.quantities.mass import mass_released
from pyrofit.results.files import Results
from pyrofit.solver.curves import Place
from pyrofit.stages import measurements

SLAB = "experiments.slab_25"
TC = {"quantity": "in_depth_temperature", "file": "data/back.csv"}
IN_DEPTH: dict[str, Any] = {**TC, "depth_m": 0.001}
BETWEEN = {"quantity": "interface_temperature", "file": "data/back.csv", "layer": 1}


def study_with(signals: Mapping[str, Any], **more: Any) -> Study:
    """The study of bad input with more signals at 25 kW/m2, and other parts."""
    given = yaml.safe_load(STUDY)
    slab = given["experiments"]["slab_25"]
    given["experiments"]["slab_25"] = {**slab, "signals": {**slab["signals"], **signals}}
    for key, value in more.items():
        given["experiments"]["slab_25"][key] = value
    return as_study(given, "study.yaml")


BROKEN: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "missing depth": (
        {"tc": TC},
        (f"{SLAB}: signal 'tc': depth_m is missing; give the depth", "`depth_m: 0.003`"),
    ),
    "missing layer": (
        {"tc": {**BETWEEN, "layer": None}},
        (f"{SLAB}: signal 'tc': layer is missing", "`layer: 1`"),
    ),
    "depth of a rate": (
        {"mlr": {"file": "data/mlr.csv", "depth_m": 0.001}},
        ("signal 'mlr': depth_m has no meaning for the mass loss rate", "in_depth_temperature"),
    ),
    "depth of an interface": (
        {"tc": {**BETWEEN, "depth_m": 0.001}},
        ("depth_m has no meaning for the interface temperature; leave it out",),
    ),
    "layer of a depth": ({"tc": {**IN_DEPTH, "layer": 1}}, ("layer has no meaning",)),
    "fixture of a front": (
        {"front_temperature": {"file": "data/back.csv", "follows": "fixture"}},
        ("signal 'front_temperature': follows has no meaning for the front temperature",),
    ),
    "unknown thing to follow": (
        {"tc": {**IN_DEPTH, "follows": "wire"}},
        (f"{SLAB}.signals.tc.follows", "'material' or 'fixture'"),
    ),
    "depth outside": (
        {"tc": {**IN_DEPTH, "depth_m": 0.005}},
        (
            f"{SLAB}.signals.tc.depth_m: 0.005 m lies outside the sample",
            "0.004 m thick",
            "Give one within the sample",
        ),
    ),
    "depth in millimetres": ({"tc": {**IN_DEPTH, "depth_m": 3}}, ("3 m lies outside",)),
    "depth in front": (
        {"tc": {**IN_DEPTH, "depth_m": -0.001}},
        (f"{SLAB}.signals.tc.depth_m: -0.001 must not be negative",),
    ),
    "parameter of another unit": (
        {"tc": {**IN_DEPTH, "depth_m": "rho"}},
        (f"'kg/m3' is no unit of {SLAB}.signals.tc.depth_m", "give m or mm"),
    ),
    "layer that is not there": (
        {"tc": {**BETWEEN, "layer": 2}},
        (f"{SLAB}.signals.tc.layer: there is no layer 2; the sample has 1",),
    ),
    "layer before the first": ({"tc": {**BETWEEN, "layer": 0}}, (f"{SLAB}.signals.tc.layer",)),
}


@pytest.mark.parametrize("name", BROKEN)
def test_wrong_place_is_refused_with_the_way_out(name: str) -> None:
    signals, words = BROKEN[name]
    with pytest.raises(StudyError) as error:
        study_with(signals)
    for word in words:
        assert word in str(error.value)


def test_depth_within_every_thickness_is_taken() -> None:
    sample = {"layers": [{"thickness_m": 0.001}, {"thickness_m": 0.003}]}
    study = study_with(
        {"a": {**IN_DEPTH, "depth_m": 0.004}, "b": {**BETWEEN, "layer": 2}}, sample=sample
    )
    assert list(study.experiments["slab_25"].signals) == ["mlr", "back_temperature", "a", "b"]


def test_words_tell_signals_of_one_quantity_apart() -> None:
    experiment = study_with({"tc_1mm": IN_DEPTH}).experiments["slab_25"]
    assert experiment.words("tc_1mm") == "in-depth temperature (tc_1mm)"
    assert experiment.metric("tc_1mm") == "RMSE of the in-depth temperature (tc_1mm)"


# Simulated


def test_signals_are_asked_for_at_their_places() -> None:
    signals = {"a": IN_DEPTH, "b": {**IN_DEPTH, "follows": "fixture"}, "c": BETWEEN}
    slab = study_with(signals).experiments["slab_25"]
    kind = kind_of(slab)
    names = ("mlr", "a", "b", "c")
    requests = {n: kind.request(slab, n, None, np.array([1.0])) for n in names}  # type: ignore[arg-type]
    places = [r.place for r in requests.values()]
    assert places == [None, Place(1e-3), Place(1e-3, follows="fixture"), Place(0.0, 1)]
    assert [r.output for r in requests.values()] == ["mlr", *["inside_temperature"] * 3]


def test_both_solvers_simulate_every_quantity_of_a_slab() -> None:
    signals = {
        "mlr": {"file": "synthetic", "average_s": 10.0},
        "mass": {"file": "synthetic", "offset": 0.5},
        "front_temperature": {"file": "synthetic"},
        "back_temperature": {"file": "synthetic"},
        "interface_temperature": {"file": "synthetic", "layer": 1},
        "tc": {**IN_DEPTH, "file": "synthetic"},
        "rod": {**IN_DEPTH, "file": "synthetic", "follows": "fixture", "delay_s": 4.0},
    }
    described = {k: {"every": 10.0, **v} for k, v in signals.items()}
    study = study_with({})
    slab = study.experiments["slab_25"]
    given = {**slab.model_dump(), "signals": described, "duration_s": 200.0}
    experiment = Gasification.model_validate(given)
    kind = kind_of(experiment)
    requests = kind.synthetic(experiment, list(signals))
    values = {**study.fixed_values(), "T_p": 605.0, "E_p": 190e3, "rho": 1190.0, "k": 0.2}
    material = study.material
    fine = Accuracy(cells=200, tolerance=1e-4)
    found = kind.simulate([experiment], material, values, [requests], fine)[0][0].signals
    exact = kind.reference(experiment, material, values, requests, Resolution()).signals
    assert found.keys() == exact.keys() == signals.keys()
    for name, curve in exact.items():
        assert np.ptp(curve) > 0.0
        assert found[name] == pytest.approx(curve, abs=2e-3 * np.ptp(curve)), name
    assert found["mass"][0] == pytest.approx(0.004 * 1190.0 + 0.5, rel=1e-3)


def test_parameter_may_stand_for_a_depth() -> None:
    experiment = Gasification.model_validate(
        {
            **study_with({}).experiments["slab_25"].model_dump(),
            "signals": {"tc": {**IN_DEPTH, "depth_m": "depth"}},
        }
    )
    study, kind = study_with({}), kind_of(experiment)
    asked = kind.request(experiment, "tc", None, np.array([50.0, 100.0]))  # type: ignore[arg-type]
    values: dict[str, Any] = {**study.fixed_values(), "T_p": 605.0, "E_p": 190e3, "rho": 1190.0}
    values |= {"k": 0.2, "depth": np.array([0.0, 1e-3, 4e-3])}
    asked_of = [{"tc": asked}]
    found = kind.simulate([experiment], study.material, values, asked_of, Accuracy(), 3)[0]
    T = np.array([curves.signals["tc"] for curves in found])
    assert (np.diff(T, axis=0) < -5.0).all()


# Read

LOAD_CELL = "Time,Mass\n[s],[g]\n0,60\n1,71\n2,70\n3,70\n4,65\n5,40\n6,10\n7,5\n8,5\n"


def read(folder: Path, text: str, quantity: str = "mass", **options: Any) -> Measurement:
    path = folder / "run.csv"
    path.write_text(text, encoding="utf-8")
    return read_series(SeriesSpec(quantity, path, **options))


def test_mass_is_divided_by_the_area(tmp_path: Path) -> None:
    series = read(tmp_path, LOAD_CELL, sample_area_m2=0.01)
    assert series.frame["mass_kg_m2"].to_numpy()[:3] == pytest.approx([6.0, 7.1, 7.0])
    assert "mass divided by 0.01 m2" in series.notes


@pytest.mark.parametrize(
    ("unit", "first"), [("kg/m2", 60.0), ("g m-2", 0.06), ("g/cm2", 600.0), ("mg cm^-2", 0.6)]
)
def test_mass_per_area_needs_no_area(tmp_path: Path, unit: str, first: float) -> None:
    text = LOAD_CELL.replace("[g]", f"[{unit}]")
    if first > 500.0:
        with pytest.raises(DataError, match=r"not between 0\.05 and 500"):
            read(tmp_path, text)
        return
    assert read(tmp_path, text).frame["mass_kg_m2"].iloc[0] == pytest.approx(first)


def test_mass_without_area_says_what_to_give(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"that of a mass; give `sample_area_m2`, .* such as kg/m2"):
        read(tmp_path, LOAD_CELL)


def test_mass_fraction_is_still_divided_by_a_mass(tmp_path: Path) -> None:
    text = "Time,Temperature,Mass\n[s],[K],[mg]\n0,310,8\n10,320,6\n20,330,4\n"
    series = read(tmp_path, text, "mass_fraction", sample_area_m2=0.01)
    assert series.frame["mass_fraction"].tolist() == [1.0, 0.75, 0.5]


def test_released_mass_ignores_shaking_and_a_wrong_zero() -> None:
    mass = np.array([6.0, 7.1, 7.0, 7.0, 6.9, 5.0, 3.0, 1.0, 0.5, 0.4, 0.5, 0.5, 0.5])
    time = np.arange(13.0)
    assert mass_released(time, mass) == 6.5
    assert mass_released(time, mass + 40.0) == pytest.approx(mass_released(time, mass), abs=1e-12)


def _prepared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, **signal: Any) -> list[str]:
    monkeypatch.chdir(tmp_path)
    rows = (f"{t},{4.8 - 4.2 * min(max(t - 50, 0), 200) / 200:.4f}" for t in range(0, 300, 5))
    Path("data").mkdir()
    Path("data/cell.csv").write_text("\n".join(["Time,Mass", "[s],[kg/m2]", *rows, ""]))
    given = yaml.safe_load(STUDY)
    given["parameters"]["rho"]["value"] = 1200
    given["imp"]["estimate"].remove("rho")
    given["published"] = None
    given["experiments"]["slab_25"]["signals"] = {"mass": {"file": "data/cell.csv", **signal}}
    del given["experiments"]["slab_50"], given["experiments"]["tga_10"], given["kinetics"]
    given["imp"]["kinetics"] = "described"
    for name, value in (("T_p", 605), ("E_p", 190)):
        given["parameters"][name]["value"] = value
    term = {"experiment": "slab_25", "signal": "mass", "kind": "RMSE"}
    given["imp"]["costs"] = {"RMSE": [term]}
    given["validation"]["experiments"] = ["slab_25"]
    study, results = as_study(given, "study.yaml"), Results(Path("results"))
    lines = measurements.prepare(study, results)
    return [*lines, results.measurements_summary.read_text(encoding="utf-8")]


def test_mass_record_is_enough_for_the_closure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line, summary = _prepared(tmp_path, monkeypatch)
    assert line == "slab_25: released 4.200 of 4.800 kg/m² (87.5 %)"
    assert "starts at" not in summary


def test_start_of_a_mass_far_from_the_description_is_noted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line, summary = _prepared(tmp_path, monkeypatch, offset=-1.0)
    assert line == "slab_25: released 4.200 of 4.800 kg/m² (87.5 %)"
    assert "starts at 5.800 kg/m2, the sample as described has 4.800" in summary
    assert "give `offset`" in summary


# Looked up by quantity, not by name


def test_balance_drift_is_that_of_every_rate_whatever_its_name() -> None:
    signals = {"mlr": None, "scale": {"quantity": "mlr", "file": "data/mlr.csv"}, "tc": IN_DEPTH}
    given = study_with({"tc": IN_DEPTH}).experiments["slab_25"].model_dump()
    given["signals"] = {n: s for n, s in signals.items() if s}
    experiment = Gasification.model_validate(given)
    effect = known_effects()["balance_drift"]
    assert effect.needs(experiment)
    changed = effect.experiment(experiment, {"offset_kg_m2s": 1e-4})
    assert [s.offset for s in changed.signals.values()] == [1e-4, 0.0]
    del given["signals"]["scale"]
    assert not effect.needs(Gasification.model_validate(given))


@pytest.mark.parametrize(("quantity", "loss"), [("mlr", "mlr"), ("mass", "mass")])
def test_new_tests_record_the_loss_as_the_laboratory_does(quantity: str, loss: str) -> None:
    slab = study_with({}).experiments["slab_25"]
    ideas = KINDS["gasification"].designs({"a": slab}, {"a": slab}, {"a": {quantity}})
    quantities = {q for idea in ideas for _, _, recorded in idea.choices for q in recorded}
    assert quantities == {loss, "back_temperature"}


# Of real laboratories

PMMA, WOOD = "PMMA/Calibration_Data", "Wood/Calibration_Data"
MEASURED = {
    # Files, what is to be said of them, and the first value as the file has it.
    "DBI Lund, mass": (
        f"{PMMA}/DBI_Lund/DBI_Lund_Gasification_25kW_1.csv",
        ("mass", {"sample_area_m2": 0.01}),
        6.91,
    ),
    "Aalto, mass": (
        f"{PMMA}/Aalto/Aalto_Gasification_65kW_2.csv",
        ("mass", {"sample_area_m2": 0.01}),
        7.389,
    ),
    "Aalto, between sample and wool": (
        f"{PMMA}/Aalto/Aalto_Gasification_65kW_2.csv",
        ("interface_temperature", {"columns": {"value": "Back Surface Temperature 2"}}),
        327.0,
    ),
    "GIDAZE+, mass": (
        f"{PMMA}/GIDAZE+/GIDAZE+_FPA_25kW_Mass_1.csv",
        ("mass", {"sample_area_m2": 0.01}),
        7.2212,
    ),
    "GIDAZE+, back": (
        f"{PMMA}/GIDAZE+/GIDAZE+_FPA_25kW_Temp_1.csv",
        ("back_temperature", {}),
        296.865,
    ),
    "FM, front": (
        f"{PMMA}/FM/FM_FPA_25kW_1.csv",
        ("front_temperature", {"columns": {"value": "Temperature"}}),
        299.7626574,
    ),
    "FSRI, front, where it is": (
        f"{WOOD}/FSRI/FSRI_Wood_CAPA_N2_40kW_R1.csv",
        ("front_temperature", {}),
        416.5,
    ),
    "FSRI, mass": (
        f"{WOOD}/FSRI/FSRI_Wood_CAPA_N2_40kW_R1.csv",
        ("mass", {"sample_area_m2": 0.00385}),
        3.2148,
    ),
    "FSRI, back": (
        f"{WOOD}/FSRI/FSRI_Wood_CAPA_N2_40kW_R1.csv",
        ("back_temperature", {}),
        293.1,
    ),
    "FPL, in depth": (
        f"{WOOD}/FPL/FPL_Wood_Cone_50kW_hor_R5.csv",
        ("in_depth_temperature", {"columns": {"value": "TC 8.6mm (K)"}}),
        293.294,
    ),
    "Aalto wood, mass": (
        f"{WOOD}/Aalto/Aalto_Wood_Gasification_60kW_hor_parallel_R1.csv",
        ("mass", {"sample_area_m2": 0.010383}),
        10.951,
    ),
}


def test_gap_in_a_column_that_is_not_read_does_no_harm(tmp_path: Path) -> None:
    text = "Time (s),Mass (kg/m2),TC Top (K)\n0,7,300\n1,6.9,\n2,6.8,\n3,6.7,\n"
    assert len(read(tmp_path, text).frame) == 4
    with pytest.raises(DataError, match="1 point"):
        read(tmp_path, text, "front_temperature")


@pytest.mark.measured
@pytest.mark.parametrize("name", MEASURED)
def test_records_of_laboratories_are_read(name: str) -> None:
    file, (quantity, options), first = MEASURED[name]
    path = Path(os.environ["PYROFIT_DATA_DIR"]) / file
    if not path.is_file():
        pytest.skip(f"no {path}")
    series = read_series(SeriesSpec(quantity, path, **options))
    values = series.frame[series.quantity.column].to_numpy()
    assert values[0] == pytest.approx(first, rel=1e-3)
