"""Exports of cone calorimeters, in files made for these tests."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.data.csvfile import read_table
from pyrofit.data.oxygen import heat_release_rate
from pyrofit.data.series import read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError
from pyrofit.new_study.draft import read_experiment
from pyrofit.new_study.pieces import Pieces
from pyrofit.new_study.words import lines_on_files, signal_lines

TIME = np.arange(0.0, 120.0)
C, AREA, AMBIENT, DELAY = 0.042, 0.00884, 0.2095, 8.0
PRESSURE, STACK = 130.0 + 0.1 * TIME, 310.0 + TIME
TRUE = 4e3 * np.exp(-(((TIME - 60.0) / 15.0) ** 2))  # W


def oxygen() -> np.ndarray:
    """Return what an analyser with a delay shows: the equation solved for the oxygen."""
    flow = 1.10 * 13.1e6 * C * np.sqrt(PRESSURE / STACK)
    ratio = TRUE / flow
    x = (AMBIENT - 1.105 * ratio) / (1.0 - 1.5 * ratio)
    return np.interp(TIME - DELAY, TIME, x)


def ftt(
    path: Path,
    with_hrr: bool = False,
    sep: str = ",",
    digits: str = ".9g",
    area: str = "Surface area (cm²)",
    without: str = "",
) -> Path:
    """Write an export of FTT; one with semicolons has decimal commas."""
    keys = {
        "Test": "7",
        "Laboratory name": "Own",
        "Date of test": "01/02/2024",
        area: f"{AREA * 1e4}",
        "C-factor (SI units)": f"{C}",
        "O2 delay time (s)": f"{DELAY}",
        "Test start time (s)": "6",
    }
    if without:
        keys[without] = ""
    names = ["Time (s)", "Mass (g)", "O2 (%)", "DPT (Pa)", "Stack TC (K)"]
    columns = [TIME, 70.0 - 0.5 * TIME, 100 * oxygen(), PRESSURE, STACK]
    if with_hrr:
        names, columns = [*names, "HRR (kW/m²)"], [*columns, TRUE]
    rows = [sep.join(f"{x:{digits}}" for x in row) for row in zip(*columns, strict=True)]
    left = [sep.join(pair) for pair in keys.items()] + [sep] * (len(rows) + 2 - len(keys))
    text = [sep.join(names), sep * (len(names) - 1), *rows]
    lines = [f"{a}{sep}{b}" for a, b in zip(left, text, strict=True)]
    if sep == ";":
        lines = [line.replace(".", ",") for line in lines]
    path.write_bytes("\n".join(lines).encode("cp1252"))
    return path


def deatak(folder: Path) -> Path:
    names = "Names,Time,Stack TC,Exh Press,O2 Meter,Sample Mass,Flame Verif"
    head = [names, "Chan Gain,,500,1,1,1,1", "Units,sec,C,Pa,%,g,", "Baseline,,36.8,130,20.95,0,"]
    columns = [TIME, STACK - 273.15, PRESSURE, 100 * oxygen(), 70.0 - 0.5 * TIME, 0 * TIME]
    rows = [
        f"{i}," + ",".join(f"{x:.9g}" for x in row)
        for i, row in enumerate(zip(*columns, strict=True), start=1)
    ]
    path = folder / "Own_Cone_HF50Scan_240102_R1.csv"
    path.write_text("\n".join([*head, *rows]), encoding="utf-8")
    return path


def scalars(folder: Path) -> None:
    text = f"LABORATORY,Own\nSURF AREA,{AREA}\nC FACTOR,{C}\nO2 DELAY TIME,{DELAY:g}\n"
    (folder / "Own_Cone_HF50Scalar_240102_R1.csv").write_text(text, encoding="utf-8")


def test_heat_release_follows_from_the_oxygen() -> None:
    q = heat_release_rate(TIME, oxygen(), PRESSURE, STACK, C, AMBIENT, DELAY)
    assert np.abs(q - TRUE)[:-10].max() < 1e-6 * TRUE.max()


def test_ftt_export_is_a_cone_test_with_mass_and_heat_release(tmp_path: Path) -> None:
    table = read_table(ftt(tmp_path / "A_Cone_50kW_1.csv"))
    assert list(table.columns)[:2] == ["Time", "Mass"]
    assert np.allclose(table.columns["HRR"][:-10] * AREA * 1e3, TRUE[:-10], atol=0.5)
    assert "HRR computed from oxygen" in table.mended[-1]
    assert "the test starts at 6 s of the record: give `delay_s: 6`" in table.mended
    run = read_experiment("cone", table.path)
    heat = run.signals[0]
    series = read_series(SeriesSpec(heat.quantity, table.path, heat.columns, heat.units))
    assert any("HRR computed from oxygen" in note for note in series.notes)
    assert {f.quantity for f in run.signals} == {"heat_release_rate", "mass"}
    assert run.number == 50.0


@pytest.mark.parametrize("digits", [".9g", ".6f"])
def test_ftt_export_with_decimal_commas_has_the_same_numbers(tmp_path: Path, digits: str) -> None:
    path = ftt(tmp_path / "A_Cone_50kW_1.csv", sep=";", digits=digits)
    table = read_table(path)
    assert table.columns["Time"].tolist() == TIME.tolist()
    assert np.allclose(table.columns["Mass"], 70.0 - 0.5 * TIME)
    assert np.allclose(table.columns["HRR"][:-10] * AREA * 1e3, TRUE[:-10], atol=3.0)
    assert "exposed area 0.00884 m2: give it as `sample_area_m2` where needed" in table.mended
    assert "read with decimal commas" in table.mended


def test_area_of_an_ftt_export_may_be_in_cm2(tmp_path: Path) -> None:
    table = read_table(ftt(tmp_path / "A_Cone_50kW_1.csv", area="Surface area (cm2)"))
    assert table.area_m2 == pytest.approx(AREA)
    assert "HRR" in table.columns


@pytest.mark.parametrize("key", ["Surface area (cm²)", "C-factor (SI units)"])
def test_key_without_which_no_heat_release_is_computed_is_told(tmp_path: Path, key: str) -> None:
    table = read_table(ftt(tmp_path / "A_Cone_50kW_1.csv", without=key))
    assert "HRR" not in table.columns
    assert f"no HRR is computed from the oxygen: {key} not given" in table.mended


def test_area_of_an_export_divides_the_mass_in_a_new_study(tmp_path: Path) -> None:
    run = read_experiment("cone", ftt(tmp_path / "A_Cone_50kW_1.csv"))
    assert run.frames["mass"]["mass_kg_m2"].iloc[0] == pytest.approx(0.07 / AREA)
    assert "        sample_area_m2: 0.00884 # of the file" in signal_lines(
        run, Pieces([], dense=False)
    )
    assert any(
        "divided by sample_area_m2 0.00884, of the file" in line for line in lines_on_files([run])
    )


def test_ftt_export_without_rows_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "A_Cone_50kW_1.csv"
    path.write_text("Laboratory name,X,Time (s),Mass (g)\nDate of test,1/2/2024,,\n", "utf-8")
    with pytest.raises(DataError, match=r"A_Cone_50kW_1.csv: this export .* holds a header and no"):
        read_table(path)


def test_heat_release_of_an_ftt_export_is_kept(tmp_path: Path) -> None:
    table = read_table(ftt(tmp_path / "A_Cone_50kW_1.csv", with_hrr=True))
    assert list(table.columns).count("HRR") == 1
    assert table.columns["HRR"].max() == pytest.approx(4e3)


def test_deatak_scan_takes_its_keys_from_the_file_beside_it(tmp_path: Path) -> None:
    path = deatak(tmp_path)
    assert "HRR" not in read_table(path).columns
    scalars(tmp_path)
    table = read_table(path)
    assert table.units["Stack TC"] == "degC"
    assert np.allclose(table.columns["HRR"][:-10] * AREA * 1e3, TRUE[:-10], atol=0.5)
    assert read_experiment("cone", path).number == 50.0


def test_standard_columns_of_the_nist_data_base(tmp_path: Path) -> None:
    path = tmp_path / "A_Cone_50kW_1.csv"
    header = "Time (s),Mass (g),HRR (kW),MFR (kg/s),T Duct (K),O2 (Vol fr),K Smoke (1/m)"
    header += ",MLRPUA (g/s-m2),HRRPUA (kW/m2)"
    columns = [TIME, 70.0 - 0.5 * TIME, TRUE / 1e3, 0 * TIME + 0.02, STACK, oxygen(), 0 * TIME]
    columns += [0 * TIME + 50.0, TRUE / AREA / 1e3]
    rows = [",".join(f"{x:.9g}" for x in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([header, *rows]), encoding="utf-8")
    found = {f.quantity: f for f in read_experiment("cone", path).signals}
    assert found["heat_release_rate"].columns["value"] == "HRRPUA"
    assert found["mlr"].columns["value"] == "MLRPUA"
    series = read_series(SeriesSpec("mlr", path, found["mlr"].columns, found["mlr"].units))
    assert series.frame["mlr_kg_m2_s"].iloc[0] == pytest.approx(0.05)
