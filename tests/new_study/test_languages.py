"""Headers in other languages than English are those of the same quantities."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.data.stated import stated_in
from pyrofit.new_study.draft import MeasuredFile
from pyrofit.new_study.write import drafted

KELVIN = np.arange(300.0, 900.0, 2.0)
TIME = 6.0 * (KELVIN - 300.0)
MASS = 1.0 + 5.0 / (1.0 + np.exp((KELVIN - 640.0) / 12.0))
CELSIUS = KELVIN - 273.15
RATE = 200.0 * np.exp(-(((TIME - 1200.0) / 300.0) ** 2))


def read(tmp_path: Path, kind: str, header: str, *columns: np.ndarray) -> MeasuredFile:
    """Return the record of a file with semicolons and decimal commas."""
    rows = [";".join(f"{x:.4f}".replace(".", ",") for x in row) for row in zip(*columns)]  # noqa: B905
    (tmp_path / "a.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return drafted("x", {kind: [tmp_path / "a.csv"]})[1][0]


TGA = [
    "Temps (s);Température (°C);Masse (mg)",
    "Zeit/s;Probentemperatur/°C;Gewicht/mg",
    "Zeit in s;Temperatur in °C;Masse in mg",
    "Tiempo (s);Temperatura (°C);Masa (mg)",
    "Tempo (s);Temperatura (°C);Massa (mg)",
    "temps_s;temperature_C;masse_mg",
]


@pytest.mark.parametrize("header", TGA)
def test_a_tga_is_read_without_an_edit(header: str, tmp_path: Path) -> None:
    run = read(tmp_path, "tga", header, TIME, CELSIUS, MASS)
    frame = run.frames["mass_fraction"]
    np.testing.assert_allclose(frame["time_s"], TIME)
    np.testing.assert_allclose(frame["temperature_K"], KELVIN)
    np.testing.assert_allclose(frame["mass_fraction"], MASS / MASS[0], atol=1e-4)
    assert not run.left


def test_the_sample_stands_beside_the_furnace(tmp_path: Path) -> None:
    header = "Temps (s);Température du four (°C);Température échantillon (°C);Masse (mg)"
    run = read(tmp_path, "tga", header, TIME, CELSIUS + 5.0, CELSIUS, MASS)
    np.testing.assert_allclose(run.frames["mass_fraction"]["temperature_K"], KELVIN)


@pytest.mark.parametrize("name", ["Perte de masse", "Weight loss", "Masseverlust"])
def test_a_loss_is_not_taken_for_the_mass(name: str, tmp_path: Path) -> None:
    run = read(tmp_path, "tga", f"Time (s);Temp (K);{name} (%)", TIME, KELVIN, 6.0 - MASS)
    assert not run.frames
    assert run.left[name].startswith("it is a loss of mass; make the mass a column")


@pytest.mark.parametrize(
    ("header", "found"),
    [
        ("Temps (s);Débit calorifique (kW/m2);Masse (g)", {"heat_release_rate", "mass"}),
        ("Zeit (s);Wärmefreisetzungsrate (kW/m2);Masse (g)", {"heat_release_rate", "mass"}),
        (
            "Zeit (s);HRR (kW/m2);Rückseitentemperatur (K)",
            {"heat_release_rate", "back_temperature"},
        ),
        (
            "Temps (s);Vitesse de perte de masse (g/s);Température arrière (K)",
            {"mlr", "back_temperature"},
        ),
    ],
)
def test_a_cone_is_read(header: str, found: set[str], tmp_path: Path) -> None:
    run = read(tmp_path, "cone", header, TIME, RATE, 300.0 + MASS)
    assert {one.quantity for one in run.signals} == found
    assert not any(one.missing or one.guessed for one in run.signals)


def test_a_heat_flow_is_read(tmp_path: Path) -> None:
    for name in ("Flux de chaleur", "Wärmestrom", "Flujo de calor"):
        header = f"Temps (s);Température (K);{name} (W/g)"
        run = read(tmp_path, "dsc", header, TIME, KELVIN, MASS - 3.0)
        assert run.frames["heat_flow"]["heat_flow_W_kg"].iloc[0] == pytest.approx(3000.0, rel=1e-3)


def test_facts_above_a_table_are_read() -> None:
    lines = [["Masse initiale", "8,2 mg"], ["Gaz vecteur", "Air"], ["Flux (kW/m²)", "50"]]
    stated = stated_in(lines)
    assert (stated.mass_kg, stated.gas, stated.flux_kW_m2) == (8.2e-6, "Air", 50.0)
    assert stated_in([["Trägergas", "Stickstoff"]]).gas == "Stickstoff"


SPELLINGS = [
    ("Time(min.),Temperature(deg C),TG(mg)", 60.0),
    ("Time [minutes],Temperature [Celsius],Mass [milligrams]", 60.0),
    ("Time/min,Ts/°C,TG/mg", 60.0),
    ("t/s,T/°C,m/m0", 1.0),
]


@pytest.mark.parametrize(("header", "per_unit"), SPELLINGS)
def test_a_spelling_of_an_instrument_is_read(header: str, per_unit: float, tmp_path: Path) -> None:
    run = read(tmp_path, "tga", header.replace(",", ";"), TIME / per_unit, CELSIUS, MASS / MASS[0])
    frame = run.frames["mass_fraction"]
    np.testing.assert_allclose(frame["time_s"], TIME, atol=0.01)
    np.testing.assert_allclose(frame["temperature_K"], KELVIN, atol=1e-6)
    np.testing.assert_allclose(frame["mass_fraction"], MASS / MASS[0], atol=2e-4)


@pytest.mark.parametrize("name", ["Time", "Time (min)", "Time (hh:mm:ss)"])
def test_times_of_a_clock_are_seconds_whatever_the_header_says(name: str, tmp_path: Path) -> None:
    clock = [f"{int(s) // 3600:02d}:{int(s) // 60 % 60:02d}:{int(s) % 60:02d}" for s in TIME]
    rows = [f"{c},{T:.3f},{m:.5f}" for c, T, m in zip(clock, KELVIN, MASS, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join([f"{name},Temp (K),Mass (mg)", *rows]) + "\n", encoding="utf-8")
    (run,) = drafted("x", {"tga": [path]})[1]
    np.testing.assert_allclose(run.frames["mass_fraction"]["time_s"], TIME)
    assert not run.signals[0].guessed


def test_tenths_of_a_second_tell_minutes_and_seconds_from_hours(tmp_path: Path) -> None:
    cells = [f"{int(s) // 60:02d}:{s % 60:04.1f}" for s in TIME]
    rows = [f"{c},{T:.3f},{m:.5f}" for c, T, m in zip(cells, KELVIN, MASS, strict=True)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time,Temp (K),Mass (mg)", *rows]) + "\n", encoding="utf-8")
    (run,) = drafted("x", {"tga": [path]})[1]
    np.testing.assert_allclose(run.frames["mass_fraction"]["time_s"], TIME, atol=0.051)
    assert not run.signals[0].guessed


@pytest.mark.parametrize("unit", ["mm:ss", "hh:mm:ss", ""])
def test_a_clock_tells_the_times(unit: str, tmp_path: Path) -> None:
    start = 0 if unit == "mm:ss" else 84_000  # past midnight
    cells = [
        f"{int(s) // 60:02d}:{int(s) % 60:02d}"
        if unit == "mm:ss"
        else f"{s // 3600 % 24:02.0f}:{s // 60 % 60:02.0f}:{s % 60:02.0f}"
        for s in np.floor(TIME) + start
    ]
    rows = [f"{c},{T:.3f},{m:.5f}" for c, T, m in zip(cells, KELVIN, MASS, strict=True)]
    path = tmp_path / "a.csv"
    header = f"Clock{f' ({unit})' if unit else ''},Temp (K),Mass (mg)"
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    (run,) = drafted("x", {"tga": [path]})[1]
    np.testing.assert_allclose(run.frames["mass_fraction"]["time_s"], np.floor(TIME))


def test_a_change_of_mass_is_told_as_such(tmp_path: Path) -> None:
    run = read(tmp_path, "tga", "Time (s);Temp (K);Delta m (mg)", TIME, KELVIN, MASS - MASS[0])
    assert run.left["Delta m"].startswith("it is a change of mass; name it as the value")


def test_facts_between_commas_are_read(tmp_path: Path) -> None:
    rows = [f"{s:.1f},{h:.3f}" for s, h in zip(TIME, RATE, strict=True)]
    above = ["Heat flux (kW/m²),35", "Sample Mass,9.000 g", "Time (s),HRR (kW/m2)"]
    path = tmp_path / "test7.csv"
    path.write_text("\n".join([*above, *rows]) + "\n", encoding="utf-8")
    (run,) = drafted("x", {"cone": [path]})[1]
    assert (run.number, run.told) == (35.0, "file")
    assert run.signals[0].stated.mass_kg == pytest.approx(0.009)
