"""Tables that hold several tests, side by side or below each other, become a file each."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.config import read_study
from pyrofit.data.csvfile import read_table
from pyrofit.model.heated import HeatedExperiment
from pyrofit.new_study.wide_tables import split_table
from pyrofit.new_study.write import init

T = np.linspace(300.0, 800.0, 101)


def mass(rate: float) -> np.ndarray:
    return 100.0 - 90.0 / (1.0 + np.exp(-(T - 600.0 - 8.0 * np.log(rate)) / 12.0))


def written(path: Path, header: str, columns: list[np.ndarray], delimiter: str = ",") -> Path:
    np.savetxt(path, np.column_stack(columns), "%.4f", delimiter, header=header, comments="")
    return path


@pytest.mark.parametrize(
    ("header", "own"),
    [
        ("temperature,rate_3,rate_5,rate_10", False),
        ("T [°C],3 K/min,5 K/min,10 K/min", False),
        ("Temperature (K),TG 3 °C/min (%),TG 5 °C/min (%),TG 10 °C/min (%)", False),
        ("Temperature (K),Mass% 3K/min,Mass% 5K/min,Mass% 10K/min", False),
        ("Temperature (K),m 3K (%),Temperature (K),m 5K (%),Temperature (K),m 10K (%)", True),
    ],
)
def test_rates_as_columns_become_a_test_each(header: str, own: bool, tmp_path: Path) -> None:
    at = T - 273.15 if "°C" in header else T
    masses = [mass(rate) for rate in (3, 5, 10)]
    columns = [c for m in masses for c in (at, m)] if own else [at, *masses]
    table = written(tmp_path / "ALL.csv", header, columns)
    study, lines = init("x", {"tga": [table]}, tmp_path)
    assert "Times follow from the rates" in lines[0]
    found = read_study(study).experiments
    rates = [e.heating_rate_K_min for e in found.values() if isinstance(e, HeatedExperiment)]
    assert sorted(rates) == [3, 5, 10]
    read = read_table(study.parent / "data" / "ALL_5K.csv").columns
    assert read["Time"] == pytest.approx((T - T[0]) * 12.0, abs=0.01)
    assert read["Mass"] == pytest.approx(mass(5), abs=1e-3)


PAIRS = "T (K),m (%),T (K),m (%),T (K),m (%)"


@pytest.mark.parametrize(
    "header",
    [
        f"3 K/min,,5 K/min,,10 K/min,\n{PAIRS}",
        f"PMMA 3°C/min,,PMMA 5°C/min,,PMMA 10°C/min,\n{PAIRS}",
        f"Heating rate,3,,5,,10\n{PAIRS}",
        f"Heating rate (K/min),3,,5,,10\n{PAIRS}",
        "3 K/min,,5 K/min,,10 K/min,\nTemperature,Weight,Temperature,Weight,Temperature,Weight\n"
        "K,%,K,%,K,%",
        f"Data of the laboratory\n\n3 K/min,3 K/min,5 K/min,5 K/min,10 K/min,10 K/min\n{PAIRS}",
    ],
    ids=["rates", "materials", "word", "unit", "units below", "both columns"],
)
def test_row_of_rates_above_the_names_tells_the_tests(header: str, tmp_path: Path) -> None:
    columns = [c for rate in (3, 5, 10) for c in (T, mass(rate))]
    study, _ = init("x", {"tga": [written(tmp_path / "ALL.csv", header, columns)]}, tmp_path)
    found = read_study(study).experiments
    rates = {n: e.heating_rate_K_min for n, e in found.items() if isinstance(e, HeatedExperiment)}
    assert rates == {"ALL_3K": 3, "ALL_5K": 5, "ALL_10K": 10}
    assert "CHANGE" not in study.read_text().split("experiments:")[1].split("signals")[0]
    read = read_table(study.parent / "data" / "ALL_5K.csv").columns
    assert read["Time"] == pytest.approx((T - T[0]) * 12.0, abs=0.01)
    assert read["Mass"] == pytest.approx(mass(5), abs=1e-3)


def test_blocks_of_one_rate_are_repeats(tmp_path: Path) -> None:
    columns = [c for rate in (3, 3, 10) for c in (T, mass(rate))]
    header = f"3 K/min,,3 K/min,,10 K/min,\n{PAIRS}"
    study, lines = init("x", {"tga": [written(tmp_path / "ALL.csv", header, columns)]}, tmp_path)
    assert any("ALL_3K_R1, ALL_3K_R2: taken as repeats" in line for line in lines)
    assert set(read_study(study).experiments) >= {"ALL_3K_R1", "ALL_10K"}


@pytest.mark.parametrize("labels", ["Run 3,,Run 5,,Run 10,", "3 K/min,,,,,"])
def test_number_that_is_no_rate_tells_none(labels: str, tmp_path: Path) -> None:
    columns = [c for rate in (3, 5, 10) for c in (T, mass(rate))]
    table = written(tmp_path / "ALL.csv", f"{labels}\n{PAIRS}", columns)
    files = split_table("tga", table, tmp_path)
    assert [file.stem for file in files] == ["ALL_a", "ALL_b", "ALL_c"]


def test_fluxes_above_the_names_tell_the_tests_of_slabs(tmp_path: Path) -> None:
    time = np.linspace(0.0, 600.0, 61)
    columns = [
        c for peak in (10.0, 20.0) for c in (time, peak * np.exp(-(((time - 300) / 90) ** 2)))
    ]
    names = "Time (s),MLR (g/m2s),Time (s),MLR (g/m2s)"
    table = written(tmp_path / "ALL.csv", f"Heat flux kW/m2,25,,50\n{names}", columns)
    files = split_table("gasification", table, tmp_path)
    assert [file.stem for file in files] == ["ALL_25kW", "ALL_50kW"]
    assert list(read_table(files[1]).columns) == ["Time", "MLR"]


@pytest.mark.parametrize(
    "header",
    [
        "time (s),temperature,rate_3,rate_5,rate_10",
        "temperature,mass,signal,other",
        "temperature,rate_3,again_3,rate_10",
    ],
    ids=["time", "no rates", "one rate twice"],
)
def test_table_that_is_not_clear_stays_one(header: str, tmp_path: Path) -> None:
    columns = [T, T, *(mass(rate) for rate in (3, 5, 10))][-len(header.split(",")) :]
    table = written(tmp_path / "ALL.csv", header, columns)
    assert split_table("tga", table, tmp_path) == [table]


def test_slabs_are_not_split(tmp_path: Path) -> None:
    table = written(tmp_path / "a.csv", "temperature,rate_3,rate_5", [T, mass(3), mass(5)])
    assert split_table("gasification", table, tmp_path) == [table]


def rates_of(study: Path) -> dict[str, float]:
    found = read_study(study).experiments
    return {n: e.heating_rate_K_min for n, e in found.items() if isinstance(e, HeatedExperiment)}


@pytest.mark.parametrize(
    "header",
    [
        "Temperature (K),m_3 (%),m_5 (%),m_10 (%)",
        "Temperature (K),m 3,Temperature (K),m 5,Temperature (K),m 10",
        "T (K),m (%),T (K),m (%),T (K),m (%)",
    ],
)
def test_a_number_without_a_unit_is_asked_for(header: str, tmp_path: Path) -> None:
    masses = [mass(rate) for rate in (3, 5, 10)]
    own = header.count(",") == 5
    columns = [c for m in masses for c in (T, m)] if own else [T, *masses]
    study, _ = init("x", {"tga": [written(tmp_path / "ALL.csv", header, columns)]}, tmp_path)
    lines = [line for line in study.read_text("utf-8").splitlines() if "heating_rate" in line]
    assert len(lines) == 3
    assert all("# CHANGE" in line for line in lines)
    # A number that the file does not hold tells no rate.
    told = "# CHANGE: a number in the name of the file"
    assert all((told in line) == ("m_3" in header or "m 3" in header) for line in lines)
    assert "Time" not in read_table(next((study.parent / "data").iterdir())).columns


@pytest.mark.parametrize(
    "header",
    [
        "Time {} (min),Temp {} (K),Mass {} (%)",
        "Time (min),Temp (K),Mass (%)",
        "t{} (min),T{} (K),m{} (%)",
    ],
)
def test_times_of_each_test_tell_its_rate(header: str, tmp_path: Path) -> None:
    tests = [(i, rate) for i, rate in enumerate((5, 10), start=1)]
    names = ",".join(header.format(i, i, i) for i, _ in tests)
    columns = [c for _, rate in tests for c in ((T - T[0]) / rate, T, mass(rate))]
    study, _ = init("x", {"tga": [written(tmp_path / "a.csv", names, columns)]}, tmp_path)
    assert sorted(rates_of(study).values()) == [5, 10]
    assert "CHANGE" not in "".join(
        line for line in study.read_text("utf-8").splitlines() if "heating_rate" in line
    )


def test_fluxes_as_columns_become_a_test_each(tmp_path: Path) -> None:
    header = "Time (s);Mass 25 kW (g);HRR 25 kW (kW/m2);Mass 50 kW (g);HRR 50 kW (kW/m2)"
    time, rate = T - T[0], 200.0 * np.exp(-(((T - 500.0) / 80.0) ** 2))
    columns = [time, mass(3), rate, mass(10), 2.0 * rate]
    table = written(tmp_path / "board.csv", header, columns, ";")
    first, second = split_table("cone", table, tmp_path)
    assert [first.name, second.name] == ["board_25kW.csv", "board_50kW.csv"]
    assert read_table(second).columns["HRR"] == pytest.approx(2.0 * rate, abs=1e-3)


def test_thermocouples_of_one_test_are_no_tests(tmp_path: Path) -> None:
    table = written(tmp_path / "a.csv", "Time (s),TC back 1 (K),TC back 2 (K)", [T, T, T])
    assert split_table("gasification", table, tmp_path) == [table]


def test_heat_flows_keep_their_names(tmp_path: Path) -> None:
    header = "T (K),DSC 5 K/min (W/g),DSC 10 K/min (W/g)"
    table = written(tmp_path / "a.csv", header, [T, mass(5) - 60.0, mass(10) - 60.0])
    first, _ = split_table("dsc", table, tmp_path)
    assert list(read_table(first).columns) == ["Time", "Temperature", "DSC"]


@pytest.mark.parametrize(
    ("header", "numbers", "names"),
    [
        ("Run,Time (s),Temperature (K),Mass (%)", (1, 2, 3), ("run1", "run2", "run3")),
        (
            "Heating rate (K/min),Time (s),Temperature (K),Mass (%)",
            (5, 10, 20),
            ("5K", "10K", "20K"),
        ),
        ("Time (s),Temperature (K),Mass (%),Sample No.", (4, 7, 9), ("run4", "run7", "run9")),
    ],
)
def test_tests_below_each_other_become_a_file_each(
    header: str, numbers: tuple[int, ...], names: tuple[str, ...], tmp_path: Path
) -> None:
    rates = 5.0, 10.0, 20.0
    parts = []
    for number, rate in zip(numbers, rates, strict=True):
        own = [(T - T[0]) / rate * 60.0, T, mass(rate)]
        label = [np.full(T.size, float(number))]
        parts.append(np.column_stack([*own, *label] if header.endswith("No.") else [*label, *own]))
    path = written(tmp_path / "all.csv", header, list(np.vstack(parts).T))
    study, lines = init("x", {"tga": [path]}, tmp_path)
    found = read_study(study).experiments
    assert set(found) == {f"all_{name}" for name in names}
    for name, rate in zip(names, rates, strict=True):
        one = found[f"all_{name}"]
        assert isinstance(one, HeatedExperiment)
        assert one.heating_rate_K_min == pytest.approx(rate, rel=1e-3)
    assert any("by a number of the test, became" in line for line in lines)


def test_rows_without_a_number_of_their_test_stay_one_table(tmp_path: Path) -> None:
    own = np.column_stack([6.0 * (T - T[0]), T, mass(10.0)])
    path = written(
        tmp_path / "all.csv", "Time (s),Temperature (K),Mass (%)", list(np.vstack([own, own]).T)
    )
    assert split_table("tga", path, tmp_path) == [path]
