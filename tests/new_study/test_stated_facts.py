"""Facts that files state above their tables."""

import re
from pathlib import Path

import numpy as np
import pytest

from pyrofit.data.gas_steps import holds_oxygen
from pyrofit.data.series import read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.data.stated import stated_in
from pyrofit.errors import DataError
from pyrofit.new_study import draft
from pyrofit.new_study.plan import part_of
from pyrofit.new_study.words import lines_on_files, oxygen_words
from pyrofit.new_study.write import drafted

KELVIN = np.linspace(300.0, 900.0, 201)
TIME = 6.0 * (KELVIN - 300.0)
MASS = 1.0 - 0.85 / (1.0 + np.exp((640.0 - KELVIN) / 12.0))


def record(path: Path, above: str, header: str, *columns: np.ndarray) -> Path:
    rows = "\n".join(";".join(f"{cell:.6f}" for cell in row) for row in zip(*columns, strict=True))
    path.write_text(f"{above}{header}\n{rows}\n", encoding="utf-8")
    return path


MASSES = {
    "TG :;\n Initial Mass : 10.00 mg\n Molar Mass : N/A\n\n": 1e-5,
    "#SAMPLE MASS /mg:;8.2\n#EXO:;-1\n\n": 8.2e-6,
    "Sample Weight:\t8.200\t[mg]\nSample Name:\tboard\n": 8.2e-6,
    "Instrument;Q500\nSize;5,5;mg\n": 5.5e-6,
    "Probenmasse: 0,012 g\nLabor: a\n": 1.2e-5,
    "Sample Wt.(mg);6.000\nUser;a\n": 6e-6,
    "[Sample Weight]\t6.000[mg]\n[Data]\n": 6e-6,
    "Masse : 10,00 mg\nLabor: a\n": 1e-5,
    "Mass of sample (mg);10.00\nUser;a\n": 1e-5,
    "Poids initial (mg) : 10.00\nNom : a\n": 1e-5,
    "board N2 10.00 mg\nCreation Date : 01/02/2025\n": 1e-5,
    "board, crucible of 85 mg\n10 mg/min\n": None,
    "board 10 mg\nanother 12 mg\n": None,
    "Sample mass (mg);Rate (K/min)\n;10\nData\n": None,  # that of the rate
    "Sample mass (mg);Rate (K/min)\n5;10\nData\n": 5e-6,
    "Sample Mass: 5 mg\nInitial Mass: 6 mg\n": None,  # two values
    "Sample mass: see notes\nRun: 3\n": None,
}


@pytest.mark.parametrize(("above", "mass"), MASSES.items())
def test_initial_mass_of_the_file_is_read(above: str, mass: float | None, tmp_path: Path) -> None:
    path = record(tmp_path / "a.txt", above, "Time (s);Temperature (K);TG (mg)", TIME, KELVIN, MASS)
    run = draft.read_experiment("tga", path)
    stated = run.signals[0].stated.mass_kg
    assert stated == (mass if mass is None else pytest.approx(mass))


@pytest.mark.parametrize("zero", [44.19, -9.0, -3.0])
def test_balance_with_an_arbitrary_zero_starts_at_the_stated_mass(
    zero: float, tmp_path: Path
) -> None:
    above = "Initial Mass : 10.00 mg\nUser : lab\n\n"
    header = "Time (s);Temperature (K);TG (mg)"
    path = record(tmp_path / "a.txt", above, header, TIME, KELVIN, 10.0 * MASS + zero)
    text, (run,), _ = drafted("x", {"tga": [path]})
    np.testing.assert_allclose(run.frames["mass_fraction"]["mass_fraction"], MASS, atol=1e-6)
    assert "sample_mass_kg: 1e-05 # of the file" in text
    with pytest.raises(DataError, match="give `sample_mass_kg: 1e-05`"):
        read_series(SeriesSpec("mass_fraction", path, {"value": "TG"}))


@pytest.mark.parametrize(("zero", "told"), [(44.19, True), (-4.7, False)])
def test_mass_in_a_title_counts_where_the_zero_is_another_one(
    zero: float, told: bool, tmp_path: Path
) -> None:
    above = "board N2 10 mg\nUser : lab\n\n"
    values = 10.0 * MASS + zero if told else 5.3 * MASS  # 10 mg are the nominal mass
    path = record(
        tmp_path / "a.txt", above, "Time (s);Temperature (K);TG (mg)", TIME, KELVIN, values
    )
    text, (run,), _ = drafted("x", {"tga": [path]})
    np.testing.assert_allclose(run.frames["mass_fraction"]["mass_fraction"], MASS, atol=1e-6)
    assert ("sample_mass_kg: 1e-05" in text) is told


def test_mass_near_the_stated_one_stays_as_it_is(tmp_path: Path) -> None:
    header = "Time (s);Temperature (K);TG (mg)"
    path = record(tmp_path / "a.txt", "Mass: 10 mg\nB: c\n", header, TIME, KELVIN, 10.4 * MASS)
    text, (run,), _ = drafted("x", {"tga": [path]})
    assert "sample_mass_kg" not in text
    np.testing.assert_allclose(run.frames["mass_fraction"]["mass_fraction"], MASS, atol=1e-6)


@pytest.mark.parametrize(
    ("above", "line"),
    [
        ("#EXO:;+1\n#A:;b\n", "endothermic: negative # as the file states"),
        ("#EXO:;-1\n#A:;b\n", "endothermic: positive # as the file states"),
        ("Exotherm Up\nA;b\n", "endothermic: negative # as the file states"),
        ("A;b\nC;d\nE;f\n", "endothermic: positive # CHANGE"),
    ],
)
def test_sign_of_the_heat_flow_is_that_of_the_file(above: str, line: str, tmp_path: Path) -> None:
    flow = 0.3 + 2.0 * np.exp(-(((KELVIN - 640.0) / 20.0) ** 2))
    sign = -1.0 if "negative" in line else 1.0
    header = "Time (s);Temperature (K);DSC (mW/mg)"
    path = record(tmp_path / "a.txt", above, header, TIME, KELVIN, sign * flow)
    text, (run,), _ = drafted("x", {"dsc": [path]})
    assert line in text
    if "CHANGE" not in line:
        assert run.frames["heat_flow"]["heat_flow_W_kg"].max() == pytest.approx(2300.0, rel=0.01)


def slab(path: Path, above: str) -> draft.MeasuredFile:
    t = np.arange(0.0, 300.0, 5.0)
    return draft.read_experiment(
        "gasification", record(path, above, "Time (s);MLR (g/s/m2)", t, 5.0 + t)
    )


def test_flux_of_the_file_comes_before_a_number_in_its_name(tmp_path: Path) -> None:
    run = slab(tmp_path / "Test-127.txt", "Scalars\nFlux (kW/m2);tig (s)\n25;85\nVectors\n")
    assert (run.number, run.told) == (25.0, "file")
    run = slab(tmp_path / "plate_50.txt", "Heat flux: 35 kW/m2\nOperator: a\n")
    assert (run.number, run.told) == (35.0, "file")
    assert slab(tmp_path / "plate_60.txt", "A;b\nC;d\nE;f\n").told == "number"


@pytest.mark.parametrize("in_name", [True, False])
def test_test_in_air_is_told_and_held_out_beside_others(in_name: bool, tmp_path: Path) -> None:
    def test(name: str, gas: str, K_min: float) -> draft.MeasuredFile:
        above = "A;b\nC;d\nE;f\n" if in_name else f"Purge Gas:;{gas}\nOperator:;a\n"
        columns = 600.0 / K_min * TIME / 60.0, KELVIN, MASS if gas != "air" else MASS - 0.1
        path = tmp_path / (f"{name}_{gas}.txt" if in_name else f"{name}.txt")
        header = "Time (s);Temperature (K);Mass (-)"
        return draft.read_experiment("tga", record(path, above, header, *columns))

    runs = [test("a", "nitrogen", 10.0), test("b", "air", 10.0)]
    assert [oxygen_words(run) != "" for run in runs] == [False, True]
    assert part_of("kinetics", runs).held_out == (runs[1].name,)
    assert part_of("kinetics", runs[1:]).held_out == ()


@pytest.mark.parametrize(
    ("column", "values", "gas"),
    [
        ("O2 (%)", 20.9 + 0.0 * TIME, "O2 20.9 %"),
        ("O2 (%)", 0.01 + 0.0 * TIME, ""),
        ("Flow (%)", 20.9 + 0.0 * TIME, ""),
    ],
)
def test_oxygen_of_a_column_is_that_of_the_gas(
    column: str, values: np.ndarray, gas: str, tmp_path: Path
) -> None:
    header = f"Time (s);Temperature (K);Mass (-);{column}"
    path = record(tmp_path / "a.txt", "", header, TIME, KELVIN, MASS, values)
    run = draft.read_experiment("tga", path)
    assert run.gas == gas
    assert (oxygen_words(run) != "") == bool(gas)


@pytest.mark.parametrize(
    ("gases", "gas", "then"),
    [
        (("N2", "N2"), "", ""),
        (("N2", "air"), "", "air"),
        (("air", "N2"), "air", ""),
        (("Ar", "20 % O2"), "", "20 % O2"),
    ],
)
def test_change_of_gas_in_a_column_is_told(
    gases: tuple[str, str], gas: str, then: str, tmp_path: Path
) -> None:
    rows = zip(TIME, KELVIN, MASS, strict=True)
    lines = [f"{t};{T};{m};{gases[int(T > 800.0)]}" for t, T, m in rows]
    path = tmp_path / "a.txt"
    path.write_text("\n".join(["Time (s);Temperature (K);Mass (-);Gas", *lines, ""]))
    run = draft.read_experiment("tga", path)
    assert (run.gas, run.then_gas) == (gas, then)


@pytest.mark.parametrize("first", [6.0, 5.76])
def test_record_that_starts_below_the_stated_mass_is_told(first: float, tmp_path: Path) -> None:
    header = "Time (s);Temperature (K);Mass (mg)"
    path = record(
        tmp_path / "a.txt", "Sample Mass: 6 mg\nUser: a\n", header, TIME, KELVIN, first * MASS
    )
    text, (run,), *_ = drafted("x", {"tga": [path]})
    told = "it starts at 96.0 % of the stated initial mass, as after a drying"
    assert (told in text) == (first < 6.0)
    assert any(told in line for line in lines_on_files([run])) == (first < 6.0)


@pytest.mark.parametrize(
    "line", ["Surface area (cm2): 88.4", "Specimen area;0.00884 m2", "Exposed area: 8840 mm2"]
)
def test_area_of_the_file_divides_its_values(line: str, tmp_path: Path) -> None:
    path = record(tmp_path / "a.txt", f"{line}\nUser: a\n", "Time (s);HRR (kW)", TIME, 1.0 + MASS)
    run = draft.read_experiment("cone", path)
    expected = 1e3 * (1.0 + MASS) / 0.00884
    frame = run.frames["heat_release_rate"]
    np.testing.assert_allclose(frame["heat_release_rate_W_m2"], expected, rtol=1e-5)
    assert "sample_area_m2: 0.00884 # of the file" in drafted("x", {"cone": [path]})[0]


def test_empty_cell_leaves_values_under_their_keys() -> None:
    names = ["Flux (kW/m2)", "tig (s)"]
    assert stated_in([names, ["", "85"]]).flux_kW_m2 is None
    assert stated_in([names, ["25", "85"]]).flux_kW_m2 == 25.0
    assert stated_in([["Sample mass", "", "8.2", "mg"]]).mass_kg == 8.2e-6


def test_facts_are_not_taken_from_other_words() -> None:
    found = stated_in(
        [["Gas flow", "50"], ["Flux compensation", "on"], ["Exotic", "1"], ["Mass", ""]]
    )
    assert (found.mass_kg, found.exothermic_up, found.gas, found.flux_kW_m2) == (
        None,
        None,
        "",
        None,
    )


@pytest.mark.parametrize(
    ("column", "sign"),
    [
        ("Heat flow endo up", "positive # as the file states"),
        ("DSC_exo_up", "negative # as the file states"),
        ("Heat flow (exotherm down)", "positive # as the file states"),
        ("Heat flow endo-down", "negative # as the file states"),
        ("Heat flow exo", "positive # CHANGE"),
    ],
)
def test_name_of_a_column_tells_the_sign_of_heat_flow(
    column: str, sign: str, tmp_path: Path
) -> None:
    header = f"Time (s);Temp (K);{column} (mW/mg)"
    path = record(tmp_path / "sta_10K.csv", "", header, TIME, KELVIN, MASS)
    assert f"endothermic: {sign}" in drafted("x", {"dsc": [path]})[0]


def test_line_above_the_table_counts_before_the_name_of_a_column() -> None:
    assert stated_in([["Endo Up"]]).exothermic_up is False
    assert stated_in([["Direction: exo up or endo up"]]).exothermic_up is None


@pytest.mark.parametrize(
    "line",
    [
        "Method: 1 ramp 10 K/min to 625 C in N2; 2 switch to air; 3 isothermal 20 min",
        "Ablauf: Segment 1 25 °C bis 600 °C N2; Gaswechsel auf Luft; 15 min isotherm",
        "Atmosphere: nitrogen until 600 °C, then air",
    ],
)
def test_steps_in_one_line_tell_a_change_of_gas(line: str) -> None:
    stated = stated_in([re.split(r"[;,] ", line)])
    assert stated.gas.casefold() in ("n2", "nitrogen")
    assert stated.then_gas.casefold() in ("air", "luft")


@pytest.mark.parametrize(
    ("line", "gas"),
    [
        ("Gas: N2 50 ml/min, O2 0 ml/min", False),
        ("Purge gas: N2 5.0 (O2 < 3 ppm)", False),
        ("Atmosphere: oxygen-free argon", False),
        ("Atmosphere: 4 % O2 in N2", True),
        ("#PURGE 2 MFC: OXYGEN 20.0 ml/min", True),
    ],
)
def test_oxygen_of_a_gas_line_is_more_than_a_trace(line: str, gas: bool) -> None:
    assert holds_oxygen(stated_in([[line]]).gas) == gas


def test_switch_to_air_alone_is_a_change_of_gas() -> None:
    assert stated_in([["Gas switched to air at 700 C"]]).then_gas == "air"
