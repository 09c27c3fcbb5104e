"""Isothermal TGA, and TGA without times."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from cases import powder

from pyrofit import cli
from pyrofit.config import as_study
from pyrofit.constants import GAS_CONSTANT
from pyrofit.errors import StudyError
from pyrofit.experiments import files_of
from pyrofit.experiments.heated.simulate import reference, request, simulate, synthetic
from pyrofit.experiments.tga import Tga
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.new_study import draft
from pyrofit.stages.reading import read_all

E, A, HELD_K = 1.5e5, 1e10, 620.0
TIME = np.linspace(0.0, 3000.0, 301)
HEATED = pd.DataFrame({"time_s": TIME, "temperature_K": np.minimum(300.0 + TIME, HELD_K)})
TEST = {
    "kind": "tga",
    "heating_rate_K_min": 60.0,
    "set_point_K": HELD_K,
    "signals": {"mass_fraction": {"file": "x.csv"}},
}
MATERIAL = powder("A", {"A": 1.0}, {"reactant": "A", "A_1_s": A, "E_J_mol": E})


@pytest.mark.parametrize("program", ["measured", "nominal"])
def test_mass_decays_exponentially_while_a_temperature_is_held(program: str) -> None:
    test = Tga.model_validate({**TEST, "program": program})
    asked = {"mass_fraction": request(test, "mass_fraction", HEATED, TIME)}
    ((curves,),) = simulate([test], MATERIAL, {}, [asked], Accuracy())
    mass = curves.signals["mass_fraction"]
    held = HELD_K - 300.0 < TIME
    k = A * np.exp(-E / (GAS_CONSTANT * HELD_K))
    exact = mass[held][0] * np.exp(-k * (TIME[held] - TIME[held][0]))
    np.testing.assert_allclose(mass[held], exact, rtol=1e-9)
    assert 1e-3 < mass[-1] < 0.5 < mass[held][0]


def test_both_solvers_agree_on_a_computed_isothermal_test() -> None:
    test = Tga.model_validate({**TEST, "start_temperature_K": 300.0, "hold_s": 600.0})
    asked = synthetic(test, ["mass_fraction"])
    ((curves,),) = simulate([test], MATERIAL, {}, [asked], Accuracy())
    other = reference(test, MATERIAL, {}, asked, Resolution())
    times = asked["mass_fraction"].time_s
    assert times[-1] == pytest.approx(320.0 + 600.0, abs=2.0)
    np.testing.assert_allclose(
        curves.signals["mass_fraction"], other.signals["mass_fraction"], atol=2e-5
    )


def test_lag_is_refused_while_a_temperature_is_held() -> None:
    with pytest.raises(ValueError, match="lag_s: while a temperature is held"):
        Tga.model_validate({**TEST, "lag_s": 3.0})


def test_new_study_recognises_a_hold(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    mass = 5.0 * np.exp(-np.clip(TIME - 320.0, 0.0, None) / 900.0)
    rows = zip(TIME, HEATED["temperature_K"], mass, strict=True)
    text = "".join(f"{a:.3f},{b:.3f},{c:.5f}\n" for a, b, c in rows)
    Path("hold.csv").write_text("Time (s),Temperature (K),Mass (mg)\n" + text, encoding="utf-8")
    run = draft.read_experiment("tga", Path("hold.csv"))
    assert run.number == pytest.approx(60.0)
    loss = files_of("tga").loss(run.frames)
    assert loss is not None
    assert loss.residue is None  # the mass still falls
    assert cli.main(["init", "x", "--tga", "hold.csv"]) == 0
    given = yaml.safe_load(Path("x/x.yaml").read_text(encoding="utf-8"))
    assert given["experiments"]["hold"]["set_point_K"] == HELD_K
    given["experiments"]["hold"]["set_point_K"] = 660.0
    with pytest.raises(Exception, match=r"last quarter of the record is at 620.0 K"):
        read_all(as_study(given, "x/x.yaml"))


def test_file_without_times_has_those_of_the_heating_rate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    temperature = np.array([30.0, 40.0, 40.0, 50.0, 49.9, 60.0, 90.0, 120.0])
    text = "".join(f"{T},{100 - 0.1 * T}\n" for T in temperature)
    Path("tga_20K.csv").write_text("Temperature (°C),Mass (%)\n" + text, encoding="utf-8")
    assert cli.main(["init", "x", "--tga", "tga_20K.csv"]) == 0
    assert "no times: those of a heating rate of 20 K/min" in capsys.readouterr().out
    given = yaml.safe_load(Path("x/x.yaml").read_text(encoding="utf-8"))
    frame, about = read_all(as_study(given, "x/x.yaml"))["tga_20K", "mass_fraction"]
    np.testing.assert_allclose(frame["time_s"], [0.0, 30.0, 60.0, 90.0, 180.0, 270.0], rtol=1e-12)
    assert "left out, the temperature does not rise: 2 rows" in about.notes
    given["experiments"]["tga_20K"]["set_point_K"] = 400.0
    with pytest.raises(StudyError, match="the files must have times"):
        as_study(given, "x/x.yaml")
