"""A record that can be read but cannot be meant so is told, at init and at check."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from pyrofit import cli
from pyrofit.config import as_study
from pyrofit.data.suspect import suspicions
from pyrofit.new_study.write import drafted
from pyrofit.quantities import known_quantities
from pyrofit.stages.reading import check_measurements

TIME = np.arange(0.0, 3000.0, 6.0)
KELVIN = 300.0 + TIME / 6.0
MASS = 1.0 - 0.9 / (1.0 + np.exp((640.0 - KELVIN) / 12.0))
HOT = 1.25 * KELVIN - 75.0
FEW = np.delete(np.arange(TIME.size), np.s_[200:240])
PAUSE = TIME + np.where(TIME > 1500.0, 86400.0, 0.0)
SLOW = TIME + np.where(TIME > 0.0, 120.0, 0.0)
"""One point for each kelvin, the first of them late."""
DENSE = np.where(TIME < 1500.0, TIME / 10.0, TIME - 1350.0)

SUSPECT = {
    "degrees C under K": ((TIME, KELVIN - 113.0, MASS), "it starts at 187 K, below room"),
    "K under degrees C": ((TIME, KELVIN + 273.15, MASS), "so that it starts at 300 K"),
    "constant mass": ((TIME, KELVIN, 1.0 + 0 * TIME), "falls by no more than 0 %"),
    "rising mass": ((TIME, KELVIN, 1.0 + 0.33 * TIME / TIME[-1]), "the mass rises by 32 %"),
    "buoyancy": (
        (TIME, KELVIN, MASS + 0.01 * (1.0 - np.exp(-TIME / 600.0))),
        "the mass rises by 0.9 % before it falls",
    ),
    "drift below zero": (
        (TIME, KELVIN, MASS - 0.25 * TIME / TIME[-1]),
        "the mass ends 15 % of its start below zero",
    ),
    "cooling": (
        (TIME, KELVIN - 2.0 * np.clip(KELVIN - 700.0, 0.0, None), MASS),
        "from then on the record cools, which is no heating. Give `until_s: 24",
    ),
    "jumps": (
        (TIME, KELVIN, MASS + 0.5 * (np.arange(TIME.size) % 200 == 50)),
        "3 values of the mass jump and come back, the first at 300 s",
    ),
    "dried sample": ((TIME, KELVIN, 0.93 * MASS), "it starts at 93.0 % of the initial mass"),
    "lost rows": (
        (TIME[FEW], KELVIN[FEW], MASS[FEW]),
        "no point of the mass fraction lies between 1194 s and 1440 s",
    ),
    "minutes under s": ((TIME / 60.0, KELVIN, MASS), "by 10 K/min if its times are in min"),
    "hours under s": ((TIME / 3600.0, KELVIN, MASS), "by 10 K/min if its times are in h"),
    "seconds under min": ((60.0 * TIME, KELVIN, MASS), "by 0.167 K/min at most. If its times are"),
    "more than all of the mass": (
        (TIME, KELVIN, 1.03 * MASS),
        "it starts at 103.0 % of the initial",
    ),
    "degrees F under degrees C": (
        (TIME, 1.8 * KELVIN - 459.67 + 273.15, MASS),
        "it starts at 80 °C and heats by 18 K/min, which would be 10 K/min if the column is in °F",
    ),
    "loss of mass": ((TIME, KELVIN, 1.0 - MASS), "and rises, as a loss of mass does"),
    "char lost late": (
        (TIME, HOT, 0.7 * MASS + 0.3 - 5e-4 * np.clip(HOT - 800.0, 0.0, None)),
        "it loses 5.4 % of the mass from 800 to 900 K",
    ),
    "pause of a day": (
        (PAUSE, KELVIN, MASS),
        "no point of the mass fraction lies between 1500 s and 87906 s",
    ),
}


def frame_of(time: np.ndarray, kelvin: np.ndarray, mass: np.ndarray) -> pd.DataFrame:
    return pd.DataFrame({"time_s": time, "temperature_K": kelvin, "mass_fraction": mass})


@pytest.mark.parametrize(("columns", "words"), SUSPECT.values(), ids=SUSPECT)
def test_suspect_record_is_told_with_the_way_out(
    columns: tuple[np.ndarray, ...], words: str
) -> None:
    (said,) = suspicions(known_quantities()["mass_fraction"], frame_of(*columns))
    assert words in said
    assert any(
        way in said
        for way in ("give", "Give", "divide", "complete", "Delete", "Make", "Subtract", "Correct")
    )


@pytest.mark.parametrize(
    "time", [TIME, DENSE, SLOW], ids=["even", "dense in a part", "a slow start"]
)
def test_good_record_gives_no_note(time: np.ndarray) -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.005, TIME.size)
    frame = frame_of(time, KELVIN, MASS + noise)
    assert suspicions(known_quantities()["mass_fraction"], frame) == []


def test_mass_of_a_slab_that_rises_is_told() -> None:
    frame = pd.DataFrame({"time_s": TIME, "mass_kg_m2": 6.0 + TIME / 1000.0})
    (said,) = suspicions(known_quantities()["mass"], frame)
    assert "the mass rises by 49 %" in said


@pytest.mark.parametrize(("start", "told"), [(35.0, True), (7.0, False)])
def test_a_mass_with_the_holder_is_told(start: float, told: bool) -> None:
    mass = start - 4.0 * TIME / TIME[-1]
    frame = pd.DataFrame({"time_s": TIME, "mass_kg_m2": mass})
    said = suspicions(known_quantities()["mass"], frame)
    assert [one for one in said if "falls by 11 %, as with its holder" in one] == said
    assert bool(said) == told


def test_init_and_check_tell_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    header = "Time (s),Temperature (K),Mass (mg)"
    np.savetxt(
        "flat.csv", np.c_[TIME, KELVIN, 9.0 + 0 * TIME], "%g", ",", header=header, comments=""
    )
    assert cli.main(["init", "x", "--tga", "flat.csv"]) == 0
    assert "flat.csv: look at this record: the mass falls" in capsys.readouterr().err
    assert cli.main(["check", "x/x.yaml"]) == 0
    assert "flat.csv: look at this record: the mass falls" in capsys.readouterr().err


def test_cooling_after_the_heating_is_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    back = np.arange(1.0, 400.0)
    time = np.r_[TIME, TIME[-1] + 6.0 * back]
    kelvin, mass = np.r_[KELVIN, KELVIN[-1] - back], np.r_[MASS, MASS[-1] + 0 * back]
    header = "Time (s),Temperature (K),Mass (%)"
    np.savetxt("a.csv", np.c_[time, kelvin, 100 * mass], "%.4f", ",", header=header, comments="")
    assert cli.main(["init", "x", "--tga", "a.csv"]) == 0
    out, err = capsys.readouterr()
    assert "is valid" in out
    assert "a.csv: read until 3048 s: from then on the record cools" in out
    text = Path("x/x.yaml").read_text("utf-8")
    assert "heating_rate_K_min: 10\n" in text
    assert "until_s: 3048 # from then on the record cools" in text
    assert "look at" not in err


def made(tmp_path: Path, above: str, *columns: np.ndarray, name: str = "a.csv") -> str:
    """Return the study of a TGA file with lines above its table."""
    rows = "\n".join(",".join(f"{x:.5f}" for x in row) for row in zip(*columns, strict=True))
    text = f"{above}Time (s),Temperature (K),Mass (%)\n{rows}\n"
    (tmp_path / name).write_text(text, encoding="utf-8")
    return drafted("x", {"tga": [tmp_path / name]})[0]


def burnt(start: float, lasts: float, *, held: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a heating to 900 K, a hold, and the loss of a third of the residue in it."""
    time = np.arange(0.0, 3600.0 + held, 6.0)
    kelvin = np.minimum(300.0 + time / 6.0, 900.0)
    mass = 0.3 + 0.7 / (1.0 + np.exp((kelvin - 640.0) / 12.0))
    mass -= 0.1 * np.clip((time - start) / lasts, 0.0, 1.0)
    noise = np.random.default_rng(3).normal(0.0, 3e-4, time.size)
    return time, kelvin, 100.0 * (mass + noise)


@pytest.mark.parametrize("start", [3900.0, 4500.0])
def test_a_burn_off_at_the_held_end_is_no_heating(start: float, tmp_path: Path) -> None:
    text = made(tmp_path, "", *burnt(start, 300.0, held=1800.0))
    (line,) = [line for line in text.splitlines() if "until_s" in line]
    assert "the mass falls anew at a held temperature" in line
    assert start - 12.0 <= float(line.split()[1]) <= start + 18.0
    assert "upper: 0.35, label: char yield" in text  # 0.3 +- 0.05 at the end of the heating


def test_a_slow_loss_at_the_held_end_is_heating(tmp_path: Path) -> None:
    time, kelvin, mass = burnt(0.0, 1.0, held=1800.0)
    mass += 8.0 * np.exp(-np.clip(time - 3600.0, 0.0, None) / 600.0) * (time > 2500.0)
    assert "until_s" not in made(tmp_path, "", time, kelvin, mass)


STEPS = """Sample Weight: 4.0 mg
Switch the Gas to Nitrogen at 45.0 ml/min
1) Hold for 2.0 min at 300 K
2) Heat from 300 K to 800 K at 10 K/min
3) Heat from 800 K to 900 K at 10 K/min
Switch the Gas to {gas} at 45.0 ml/min
Software: 13

"""


def test_heating_ends_where_the_steps_of_a_run_change_the_gas(tmp_path: Path) -> None:
    record = burnt(1e6, 1.0, held=60.0)
    text = made(tmp_path, STEPS.format(gas="Oxygen"), *record)
    assert "until_s: 3120 # from then on the gas is Oxygen" in text
    assert "until_s" not in made(tmp_path, STEPS.format(gas="Argon"), *record)


def test_a_change_of_gas_without_a_time_is_asked_for(tmp_path: Path) -> None:
    above = "Gas1: Nitrogen\nGas2: Air\n1: Ramp 10 K/min\n2: Select gas: 2\nRun: 3\n\n"
    text = made(tmp_path, above, *burnt(1e6, 1.0, held=60.0))
    assert "# CHANGE: the gas is changed to Air in the run; give `until_s`" in text
    steps = "[1] 30..600 C, 10 K/min, N2 50 ml/min\n[2] 600..800 C, 10 K/min, air 50 ml/min\n\n"
    assert "changed to air" in made(tmp_path, steps, *burnt(1e6, 1.0, held=60.0), name="b.csv")


def test_flows_of_two_gases_are_no_change(tmp_path: Path) -> None:
    above = "Heating Rate (C/s): 1.0\nN2 Flow Rate (cc/min): 80\nO2 Flow Rate (cc/min): 20\n\n"
    assert "the gas is changed" not in made(tmp_path, above, *burnt(1e6, 1.0, held=60.0))


@pytest.mark.parametrize(("dried", "until"), [(390.0, False), (600.0, True)])
def test_a_cooling_after_a_drying_belongs_to_the_heating(
    dried: float, until: bool, tmp_path: Path
) -> None:
    kelvin = np.r_[np.arange(300.0, dried), np.arange(dried, 310.0, -5.0), np.arange(310.0, 900.0)]
    time = 6.0 * np.arange(kelvin.size)
    mass = 30.0 + 70.0 / (1.0 + np.exp((np.maximum.accumulate(kelvin) - 640.0) / 12.0))
    text = made(tmp_path, "", time, kelvin, mass)
    assert ("until_s" in text) == until


def test_a_record_that_starts_after_a_drying_is_divided_by_its_start(tmp_path: Path) -> None:
    text = made(tmp_path, "", TIME, KELVIN, 93.0 * MASS)
    assert "relative_to: first value # CHANGE: it starts at 93.0 %, as" in text
    (tmp_path / "data").mkdir()
    (tmp_path / "a.csv").rename(tmp_path / "data" / "a.csv")
    found = check_measurements(as_study(yaml.safe_load(text), str(tmp_path / "x.yaml")), "x.yaml")
    ((frame, about),) = found.values()
    np.testing.assert_allclose(frame["mass_fraction"], MASS / MASS[0], atol=1e-6)
    assert not [note for note in about.notes if "starts at" in note]
    assert "relative_to" not in made(tmp_path, "", TIME, KELVIN, 99.0 * MASS)


def test_the_temperature_of_a_hold_in_a_name_is_no_heating_rate(tmp_path: Path) -> None:
    time = np.arange(0.0, 6000.0, 6.0)
    kelvin = np.minimum(300.0 + time / 1.2, 573.0)
    mass = 100.0 * np.exp(-np.clip(time - 300.0, 0.0, None) / 2000.0)
    text = made(tmp_path, "", time, kelvin, mass, name="iso_300C.csv")
    assert "set_point_K: 573" in text
    assert "heating_rate_K_min: 50\n" in text


def test_a_heat_flow_that_no_sample_has_is_told() -> None:
    quantity = known_quantities()["heat_flow"]
    for size, count in ((5e4, 1), (1e3, 0), (5.0, 1)):
        flow = size * np.sin(TIME / 300.0)
        frame = pd.DataFrame({"time_s": TIME, "temperature_K": KELVIN, "heat_flow_W_kg": flow})
        assert len([note for note in suspicions(quantity, frame) if "heat flow" in note]) == count


def test_a_heat_flow_of_several_heatings_is_told_and_its_peak_is_that_of_one() -> None:
    quantity = known_quantities()["heat_flow"]
    kelvin = 420.0 - np.abs(np.arange(0.0, 480.0) - 240.0)  # heated and cooled
    slope = np.gradient(kelvin)
    frame = pd.DataFrame(
        {"time_s": 6.0 * np.arange(480.0), "temperature_K": kelvin, "heat_flow_W_kg": 250.0 * slope}
    )
    said = suspicions(quantity, frame)
    assert any("no single heating: the temperature falls by 239 K" in note for note in said)
    assert quantity.remark is not None
    assert quantity.remark(kelvin, 250.0 * slope) == ""
    assert not any("single heating" in note for note in suspicions(quantity, frame[:240]))


@pytest.mark.parametrize(("seconds", "told"), [(20.0, True), (500.0, False)])
def test_a_back_that_rises_as_the_front_does_is_told(seconds: float, told: bool) -> None:
    time = np.arange(0.0, 1000.0, 5.0)
    frame = pd.DataFrame(
        {"time_s": time, "back_temperature_K": 300.0 + 300.0 * np.minimum(time / seconds, 1.0)}
    )
    said = suspicions(known_quantities()["back_temperature"], frame)
    assert any("the signal is the front temperature" in note for note in said) is told


def test_char_lost_in_oxygen_is_no_fault() -> None:
    columns, words = SUSPECT["char lost late"]
    quantity, frame = known_quantities()["mass_fraction"], frame_of(*columns)
    assert not any(words in note for note in suspicions(quantity, frame, in_oxygen=True))
