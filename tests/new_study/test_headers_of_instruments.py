"""What a program of an instrument writes is read right, or asked for; never wrong in silence."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from headers_of_instruments import EXPORTS, Export

from pyrofit.experiments import measurable
from pyrofit.new_study.divisor import divisor_of, is_told
from pyrofit.new_study.draft import MeasuredFile, read_experiment

KELVIN = np.arange(300.0, 900.0, 10.0)
TIME = 6.0 * (KELVIN - 300.0)
LEFT = 1.0 - 0.85 / (1.0 + np.exp(-(KELVIN - 640.0) / 12.0))
PEAK = np.exp(-(((TIME - 1200.0) / 300.0) ** 2)) + 0.01

ABSCISSAE = {
    "time": {"s": TIME, "min": TIME / 60.0, "h": TIME / 3600.0, "ms": 1e3 * TIME},
    "temperature": {"C": KELVIN - 273.15, "K": KELVIN, "F": 1.8 * KELVIN - 459.67},
}
VALUES = {
    "mass_fraction": {"mg": 6.0 * LEFT, "ug": 6e3 * LEFT, "g": LEFT, "%": 100.0 * LEFT, "1": LEFT}
    | {"-%": 100.0 * LEFT - 100.0, "-mg": 6.0 * LEFT - 6.0, "+mg": 44.0 + 6.0 * LEFT},
    "mass": {"g": LEFT, "kg/m2": 0.1 * LEFT},
    "heat_flow": {"W/g": PEAK, "-W/g": -PEAK, "mW": 6.0 * PEAK},
    "specific_heat_release_rate": {"W/g": PEAK},
    "heat_release_rate": {"kW/m2": 300.0 * PEAK},
    "mlr": {
        "kg/m2/s": 0.01 * PEAK,
        "g/m2/s": 10.0 * PEAK,
        "g/s": 0.1 * PEAK,
        "mg/cm2/min": 60.0 * PEAK,
    },
    "back_temperature": {"K": KELVIN, "C": KELVIN - 273.15},
}
TRUTH = {
    "mass_fraction": LEFT,
    "mass": 0.1 * LEFT,
    "heat_flow": 1e3 * PEAK,
    "specific_heat_release_rate": 1e3 * PEAK,
    "heat_release_rate": 3e5 * PEAK,
    "mlr": 0.01 * PEAK,
    "back_temperature": KELVIN,
}
OTHERS = {
    "x": np.arange(1.0, 1.0 + TIME.size),
    "one": np.ones(TIME.size),
    "zero": np.zeros(TIME.size),
    "flow": np.full(TIME.size, 50.0),
    "Cf": KELVIN - 268.15,
}
COLUMNS = {
    name: values
    for names in (*ABSCISSAE.values(), *VALUES.values(), OTHERS)
    for name, values in names.items()
}


def read(export: Export, folder: Path) -> MeasuredFile:
    """Return the record of a file as the program writes it."""
    columns = [COLUMNS[name] for name in export.columns.split()]
    rows = (
        export.separator.join(f"{x:.7f}".replace(".", export.decimal) for x in row)
        for row in zip(*columns, strict=True)
    )
    (folder / "a.csv").write_text("\n".join([export.above, *rows]) + "\n", encoding="utf-8")
    return read_experiment(export.kind, folder / "a.csv")


def asked(run: MeasuredFile) -> Iterator[str]:
    """Yield what the study marks with CHANGE."""
    if run.lacks == "time" and run.told not in ("record", "file"):
        yield "heating rate"
    for found in run.signals:
        yield from (*found.missing, *found.guessed, *found.unread)
        if (divisor := divisor_of(found)) is not None and not is_told(found, divisor[0]):
            yield divisor[0]


@pytest.mark.parametrize("export", EXPORTS, ids=lambda export: export.program)
def test_what_is_read_is_right_and_the_rest_is_asked_for(export: Export, tmp_path: Path) -> None:
    run = read(export, tmp_path)
    assert set(asked(run)) == set(export.asked)
    codes = set(export.columns.split())
    there = {name for name in measurable(export.kind) if codes & VALUES.get(name, {}).keys()}
    assert not there - {found.quantity for found in run.signals}
    for found in run.signals:
        frame = run.frames.get(found.quantity)
        if frame is None:
            assert {*found.missing, *found.unread} & set(export.asked)
            continue
        np.testing.assert_allclose(frame["time_s"], TIME, atol=1e-3)
        np.testing.assert_allclose(frame.iloc[:, -1], TRUTH[found.quantity], atol=1e-4)
        if found.of.against_temperature:
            np.testing.assert_allclose(frame["temperature_K"], KELVIN, atol=1e-3)


@pytest.mark.parametrize(
    ("header", "unit", "signal"),
    [
        ("SURFACE DENSITY", "kg/m2", "mass"),
        ("mlr_front", "kg/m2/s", "mlr"),
        ("BURNING RATE", "kg/m2/s", "mlr"),
        ("Surface temperature", "K", "front_temperature"),
    ],
)
def test_unit_decides_where_names_leave_it_open(
    header: str, unit: str, signal: str, tmp_path: Path
) -> None:
    values = {"kg/m2": 0.1 * LEFT, "kg/m2/s": 0.01 * PEAK, "K": KELVIN}[unit]
    rows = "".join(f"{t},{v}\n" for t, v in zip(TIME, values, strict=True))
    path = tmp_path / "slab.csv"
    path.write_text(f"s,{unit}\nTime,{header}\n{rows}", encoding="utf-8")
    found = read_experiment("gasification", path)
    assert [s.quantity for s in found.signals] == [signal]
    assert np.allclose(next(iter(found.frames.values())).iloc[:, -1], values)
