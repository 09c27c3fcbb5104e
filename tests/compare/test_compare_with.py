"""A study against further tests and predictions of others: known errors come out."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

import pyrofit as pf
from pyrofit.cli import main
from pyrofit_compare.compute import OURS, REPEATS

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
TRUTH = yaml.safe_load(SMOKE.read_text())["synthetic"]["truth"]


def _slab(flux: float, signals: dict[str, object], tests: list[object]) -> dict[str, object]:
    keys = yaml.safe_load(SMOKE.read_text())["experiments"]["slab_60"]
    front = {**keys["front"], "flux_W_m2": flux}
    kept = {"kind": "gasification", "duration_s": 300, "sample": keys["sample"], "front": front}
    return {**kept, "back": keys["back"], "signals": signals, "repeats": {"tests": tests}}


@pytest.fixture(scope="module")
def tests(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two repeats, 2 g/(m2 s) above and below the curve of the truth, and a file of others."""
    folder = tmp_path_factory.mktemp("tests")
    at = {"file": "synthetic", "every": 5}
    slab = {k: v for k, v in _slab(50e3, {"mlr": at}, []).items() if k != "repeats"}
    study = pf.read_study(SMOKE, experiments={"new": slab})
    curve = pf.simulate(study, TRUTH, experiments="new").series["new", "mlr"]
    time, rate = curve["time_s"].to_numpy(), 1e3 * curve["mlr_kg_m2_s"].to_numpy()
    for i, shift in enumerate((2.0, -2.0), start=1):
        _write(folder / f"own_{i}.csv", time, rate + shift)
    others = folder / "others"
    others.mkdir()
    _write(others / "A_Gasification_q50_MLR_R1.csv", time, rate + 1.0)
    _write(others / "A_Gasification_q50_MLR_R2.csv", time, rate + 5.0)
    _write(others / "B_Gasification_q25_MLR_R1.csv", time, rate)
    files = [{"signals": {"mlr": f"own_{i}.csv"}} for i in (1, 2)]
    keys = {"experiments": {"new": _slab(50e3, {"mlr": {}}, files)}}
    (folder / "tests.yaml").write_text(yaml.safe_dump(keys))
    return folder


def _write(path: Path, time: np.ndarray, rate: np.ndarray) -> None:
    rows = "".join(f"{t},{r}\n" for t, r in zip(time, rate, strict=True))
    path.write_text(f"Time,MLR\n[s],[g/m2/s]\n{rows}")


def test_errors_are_those_put_in(tests: Path) -> None:
    found = pf.compare_with(
        SMOKE,
        tests / "tests.yaml",
        predictions=[tests / "others"],
        parameter_set="truth",
    )
    scores = found.scores.set_index("who")
    wide = found.means["new", "mlr"].range
    assert set(scores.index) == {REPEATS, OURS, "A"}  # B has another flux
    assert scores.loc[OURS, "nrms"] < 1e-4
    assert scores.loc["A", "nrms"] == pytest.approx(3e-3 / wide, rel=1e-3)  # mean of R1, R2
    assert scores.loc[REPEATS, "nrms"] == pytest.approx(2e-3 * np.sqrt(2.0) / wide, rel=1e-6)
    assert scores.loc["A", "repeats"] == 2


def test_command_writes_table_page_and_figures(
    tests: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["compare-with", str(SMOKE), str(tests / "tests.yaml"), "--set", "truth"]
    assert main([*given, "--predictions", str(tests / "others"), "--out", str(tmp_path)]) == 0
    assert "this study" in capsys.readouterr().out
    page = (tmp_path / "comparison.md").read_text()
    assert "| A | 1 |" in page
    assert "default values" not in page
    assert (tmp_path / "new_mlr.png").stat().st_size > 5000
    table = pd.read_csv(tmp_path / "summary.csv").set_index("who")
    assert table.loc["A", "this_study"] < 1e-4 < table.loc["A", "mean_nrms"]


def test_a_name_of_the_study_is_refused(
    tests: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keys = yaml.safe_load((tests / "tests.yaml").read_text())
    path = tmp_path / "tests.yaml"
    path.write_text(yaml.safe_dump({"experiments": {"slab_25": keys["experiments"]["new"]}}))
    assert main(["compare-with", str(SMOKE), str(path), "--set", "truth"]) == 2
    said = capsys.readouterr().err
    assert f"{path}: experiments.slab_25: an experiment of this name is there already" in said
    path.write_text(yaml.safe_dump({**keys, "aera_m2": 1.0}))
    assert main(["compare-with", str(SMOKE), str(path), "--set", "truth"]) == 2
    assert "key 'aera_m2' is not known. Did you mean 'area_m2'?" in capsys.readouterr().err


def test_a_file_that_the_study_has_is_told(tests: Path) -> None:
    keys = yaml.safe_load((tests / "tests.yaml").read_text())["experiments"]["new"]
    keys = {k: v for k, v in keys.items() if k != "repeats"}
    own = {**keys, "signals": {"mlr": {"file": str(tests / "own_1.csv")}}}
    study = pf.read_study(SMOKE, experiments={"used": own})
    found = pf.compare_with(study, tests / "tests.yaml", parameter_set="truth")
    told = [line for line in found.assumed if "the study has this file" in line]
    assert len(told) == 1
    assert told[0].startswith("new_1, mlr: the study has this file as used, mlr.")


COPPER = {
    "density_kg_m3": 8960,
    "conductivity_W_mK": 390,
    "specific_heat_J_kgK": 385,
    "emissivity": 0.9,
}


def _with_h(flux: float, h: object, signals: dict[str, object], inert: bool) -> dict[str, object]:
    keys = {k: v for k, v in _slab(flux, signals, []).items() if k != "repeats"}
    front = yaml.safe_load(SMOKE.read_text())["experiments"]["slab_60"]["front"]
    keys["front"] = {**front, "flux_W_m2": flux, "h_W_m2K": h}
    plate = {"layers": [{"thickness_m": 0.004, "composition": {"copper": 1}}]}
    return {**keys, "sample": plate} if inert else keys


@pytest.fixture(scope="module")
def apparatus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A test and a run on a copper plate in an apparatus with h = 14 W/(m2 K)."""
    folder, at = tmp_path_factory.mktemp("apparatus"), {"file": "synthetic", "every": 5}
    material = yaml.safe_load(SMOKE.read_text())["material"]
    material["components"]["copper"] = COPPER
    runs = {
        "new": _with_h(50e3, 14, {"mlr": at}, inert=False),
        "plate": _with_h(50e3, 14, {"front_temperature": at}, inert=True),
    }
    study = pf.read_study(SMOKE, material=material, experiments=runs)
    series = pf.simulate(study, TRUTH, experiments=list(runs)).series
    rate, warm = series["new", "mlr"], series["plate", "front_temperature"]
    _write(folder / "new.csv", rate["time_s"].to_numpy(), 1e3 * rate["mlr_kg_m2_s"].to_numpy())
    noise = np.random.default_rng(1).normal(0.0, 0.5, len(warm))
    pairs = zip(warm["time_s"], warm["front_temperature_K"] + noise, strict=True)
    rows = "".join(f"{t},{T}\n" for t, T in pairs)
    (folder / "plate.csv").write_text(f"Time,Front Temperature\n[s],[K]\n{rows}")
    return folder


def _compared(folder: Path, h: object, **more: object) -> "pf.ComparedWith":
    keys = {
        "experiments": {"new": _with_h(50e3, h, {"mlr": {"file": "new.csv"}}, inert=False)},
        "components": {"copper": COPPER},
        **more,
    }
    (folder / "tests.yaml").write_text(yaml.safe_dump(keys))
    return pf.compare_with(SMOKE, folder / "tests.yaml", parameter_set="truth")


def test_a_run_on_an_inert_plate_calibrates_the_apparatus(apparatus: Path) -> None:
    file = {"front_temperature": {"file": "plate.csv"}}
    found = _compared(
        apparatus,
        "h_cone",
        parameters={"h_cone": {"unit": "W/(m2 K)", "lower": 2, "upper": 40}},
        inert={"plate": _with_h(50e3, "h_cone", file, inert=True)},
    )
    assert found.apparatus.fit is not None
    row = found.apparatus.fit.table.loc["h_cone"]
    assert row["low"] < 14.0 < row["high"]
    assert row["high"] - row["low"] < 4.0
    ours = found.scores.set_index("who").loc[OURS, "nrms"]
    assumed = _compared(apparatus, 8).scores.set_index("who").loc[OURS, "nrms"]
    assert ours < 0.01 < 0.1 < assumed
    assert set(found.scores["test"]) == {"new"}


def test_numbers_of_an_apparatus_need_runs_and_runs_need_numbers(apparatus: Path) -> None:
    one = {"h_cone": {"unit": "W/(m2 K)", "lower": 2, "upper": 40}}
    with pytest.raises(pf.PyrofitError, match="`inert` lists none; add these runs"):
        _compared(apparatus, "h_cone", parameters=one)
    file = {"front_temperature": {"file": "plate.csv"}}
    plate = {"plate": _with_h(50e3, 8, file, inert=True)}
    with pytest.raises(pf.PyrofitError, match="`parameters` names no number to fit to them"):
        _compared(apparatus, 8, inert=plate)
    with pytest.raises(pf.PyrofitError, match=r"inert\.new: an experiment of this name"):
        _compared(apparatus, "h_cone", parameters=one, inert={"new": plate["plate"]})
