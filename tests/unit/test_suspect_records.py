"""A record that can be read but cannot be meant so is told, at init and at check."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from pyrofit import cli
from pyrofit.data.suspect import suspicions
from pyrofit.quantities import known_quantities

TIME = np.arange(0.0, 3000.0, 6.0)
KELVIN = 300.0 + TIME / 6.0
MASS = 1.0 - 0.9 / (1.0 + np.exp((640.0 - KELVIN) / 12.0))
FEW = np.delete(np.arange(TIME.size), np.s_[200:240])
PAUSE = TIME + np.where(TIME > 1500.0, 86400.0, 0.0)
DENSE = np.where(TIME < 1500.0, TIME / 10.0, TIME - 1350.0)

SUSPECT = {
    "degrees C under K": ((TIME, KELVIN - 113.0, MASS), "it starts at 187 K, below room"),
    "K under degrees C": ((TIME, KELVIN + 273.15, MASS), "so that it starts at 300 K"),
    "constant mass": ((TIME, KELVIN, 1.0 + 0 * TIME), "falls by no more than 0 %"),
    "rising mass": ((TIME, KELVIN, 1.0 + 0.33 * TIME / TIME[-1]), "the mass rises by 32 %"),
    "dried sample": ((TIME, KELVIN, 0.93 * MASS), "it starts at 93.0 % of the initial mass"),
    "lost rows": ((TIME[FEW], KELVIN[FEW], MASS[FEW]), "no point lies between 1194 s and 1440 s"),
    "pause of a day": ((PAUSE, KELVIN, MASS), "no point lies between 1500 s and 87906 s"),
}


def frame_of(time: np.ndarray, kelvin: np.ndarray, mass: np.ndarray) -> pd.DataFrame:
    return pd.DataFrame({"time_s": time, "temperature_K": kelvin, "mass_fraction": mass})


@pytest.mark.parametrize(("columns", "words"), SUSPECT.values(), ids=SUSPECT)
def test_suspect_record_is_told_with_the_way_out(
    columns: tuple[np.ndarray, ...], words: str
) -> None:
    (said,) = suspicions(known_quantities()["mass_fraction"], frame_of(*columns))
    assert words in said
    assert any(way in said for way in ("give", "Give", "divide", "complete"))


@pytest.mark.parametrize("time", [TIME, DENSE], ids=["even", "dense in a part"])
def test_good_record_gives_no_note(time: np.ndarray) -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.005, TIME.size)
    frame = frame_of(time, KELVIN, MASS + noise)
    assert suspicions(known_quantities()["mass_fraction"], frame) == []


def test_mass_of_a_slab_that_rises_is_told() -> None:
    frame = pd.DataFrame({"time_s": TIME, "mass_kg_m2": 6.0 + TIME / 1000.0})
    (said,) = suspicions(known_quantities()["mass"], frame)
    assert "the mass rises by 49 %" in said


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
    assert "it cools from then on" in out
    text = Path("x/x.yaml").read_text("utf-8")
    assert "heating_rate_K_min: 10\n" in text
    assert "until_s: 3048 # from then on the record cools" in text
    assert "look at" not in err
