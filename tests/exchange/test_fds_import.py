"""MATL lines become a material: units, places of arrays, versions, unknown keys."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from decks import base, deck_of

from pyrofit.cli import main
from pyrofit.experiments import Tga
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit_exchange.fds.export import text_of_file
from pyrofit_exchange.fds.imported import import_fds
from pyrofit_exchange.fds.predicted import predict_heated
from pyrofit_exchange.fds.versions import NEW, OLD, FdsError

LINES = """
Comment, not a line & nothing
&HEAD CHID='x' /
&MATL ID='WOOD' ! with a comment / here
      FYI='a / b'
      DENSITY=400., CONDUCTIVITY_RAMP="K WOOD", SPECIFIC_HEAT=1.5
      N_REACTIONS=1, A=1.D9, E=1.2E5, N_S=1.
      MATL_ID='CHAR', NU_MATL=0.2, SPEC_ID='GAS', NU_SPEC=0.8
      HEAT_OF_REACTION=300., N_T=0.5 /
&MATL ID='CHAR', DENSITY=100., CONDUCTIVITY=0.1, SPECIFIC_HEAT=1., EMISSIVITY=0.85 /
&MATL ID='BOARD', DENSITY=700., CONDUCTIVITY=0.2, SPECIFIC_HEAT=1. /
&RAMP ID='K WOOD', T=20., F=0.12 /
&RAMP ID='K WOOD', T=500., F=0.2 /
&SURF ID='WALL', MATL_ID='WOOD','BOARD', THICKNESS=0.02,0.01 /
&TAIL /
"""


def imported(text: str, old: bool = False, surface: str = "") -> dict[str, Any]:
    return import_fds(text, "x.fds", OLD if old else NEW, surface).material


def test_units_and_defaults_become_those_of_a_study() -> None:
    found = imported(LINES)
    wood, char = found["components"]["WOOD"], found["components"]["CHAR"]
    assert wood["specific_heat_J_kgK"] == 1500.0
    assert wood["emissivity"] == 0.9
    assert wood["conductivity_W_mK"] == {"temperature_K": [293.15, 773.15], "value": [0.12, 0.2]}
    assert char["emissivity"] == 0.85
    reaction = found["reactions"]["WOOD"]
    assert reaction["A_1_s"] == pytest.approx(1e9, rel=1e-4)
    assert reaction["E_J_mol"] == 1.2e5
    assert reaction["heat_of_reaction_J_kg"] == 3e5
    assert reaction["products"] == {"CHAR": 0.2}
    assert found["composition"] == {"WOOD": 1.0}


def test_what_is_not_taken_over_is_named() -> None:
    said = "\n".join(import_fds(LINES, "x.fds", NEW).remarks)
    assert "N_T is not known" in said
    assert "MATL 'BOARD': not of the virgin material" in said
    assert "ADJUST_H" in said
    assert "FYI" not in said
    assert "ADJUST_H" not in "\n".join(import_fds(LINES, "x.fds", OLD).remarks)


def test_an_export_that_is_imported_loses_mass_as_before() -> None:
    text = text_of_file(deck_of(base(), "tga_10K"), [])
    material = Material.model_validate(imported(text, old=True))
    experiment, T = Tga(kind="tga", heating_rate_K_min=10.0), np.arange(300.0, 800.0, 2.0)
    before, after = (
        predict_heated(experiment, of, base().values, Accuracy())(T)
        for of in (base().material, material)
    )
    np.testing.assert_allclose(after, before, atol=1e-6)


def mixture(order: float) -> str:
    matls = [
        f"&MATL ID='{n}', DENSITY={rho}, CONDUCTIVITY=0.2, SPECIFIC_HEAT=1., N_REACTIONS=1, "
        f"A(1)=1E-4, E(1)=0., N_S(1)={order}, NU_SPEC(1,1)=1., SPEC_ID(1,1)='G' /"
        for n, rho in (("A", 1000.0), ("B", 500.0))
    ]
    surf = "&SURF ID='S', MATL_ID(1,1:2)='A','B', MATL_MASS_FRACTION(1,1:2)=0.4,0.6 /"
    return "\n".join([*matls, surf])


def test_a_of_another_order_follows_the_version() -> None:
    # Layer: 1/(0.4/1000 + 0.6/500) = 625 kg/m3; A: 250 kg/m3, B: 375.
    old, new = (imported(mixture(2.0), old)["reactions"] for old in (True, False))
    assert old["A"]["A_1_s"] == pytest.approx(1e-4 * 0.4)
    assert new["A"]["A_1_s"] == pytest.approx(1e-4 * 250.0, rel=1e-5)
    assert new["B"]["A_1_s"] == pytest.approx(1e-4 * 375.0, rel=1e-5)
    first = imported(mixture(1.0))["reactions"]
    assert first["A"]["A_1_s"] == 1e-4


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        ("A=1.D9, E=1.2E5,", "", "needs A.1. and E.1., or REFERENCE_TEMPERATURE.1."),
        ("A=1.D9, E=1.2E5,", "REFERENCE_TEMPERATURE=350., PYROLYSIS_RANGE=1E-3,", "too narrow"),
        ("'CHAR', NU_MATL", "'COAL', NU_MATL", "'COAL' is missing"),
        ("&RAMP ID='K WOOD', T=500., F=0.2 /", "", "has 1 lines"),
        ("DENSITY=400., ", "", "has no DENSITY"),
        ("MATL_ID='WOOD','BOARD'", "COLOR='RED'", "no SURF line with a MATL_ID"),
        ("N_S=1.", "N_S=one", "'one' is no number"),
        ("NU_MATL=0.2", "NU_MATL=1.2", "no material of pyrofit"),
        ("&TAIL /", "&TAIL", "does not end"),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_place(before: str, after: str, says: str) -> None:
    assert before in LINES
    with pytest.raises(FdsError, match=says) as refused:
        imported(LINES.replace(before, after))
    assert "x.fds" in str(refused.value)


def test_a_file_without_matl_is_refused() -> None:
    with pytest.raises(FdsError, match="no MATL line"):
        imported("&HEAD CHID='x' /")


def test_another_surface_can_be_named() -> None:
    assert imported(LINES + "\n&SURF ID='B', MATL_ID='BOARD' /", surface="B")["composition"] == {
        "BOARD": 1.0
    }
    with pytest.raises(FdsError, match="no SURF line 'C'; SURF lines with materials: WALL"):
        imported(LINES, surface="C")


def test_the_command_writes_yaml_of_a_material(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "in.fds", tmp_path / "material.yaml"
    path.write_text(LINES)
    assert main(["import", "fds", str(path), "--out", str(out)]) == 0
    assert "N_T is not known" in capsys.readouterr().err
    Material.model_validate(yaml.safe_load(out.read_text())["material"])
    assert main(["import", "fds", str(tmp_path / "none.fds")]) == 2


PEAK = "REFERENCE_TEMPERATURE=350., PYROLYSIS_RANGE=60., HEATING_RATE=10.,"


def test_a_peak_becomes_a_and_e_by_the_formula_of_each_version() -> None:
    # E = e (2/60) R 623.15^2, times the yield of gas 0.8 in 6.7; A = e (2 beta/60) exp(E/(R T)).
    text = LINES.replace("A=1.D9, E=1.2E5,", PEAK)
    old, new = (imported(text, old)["reactions"]["WOOD"] for old in (True, False))
    E = math.e * 2.0 / 60.0 * 8.314472 * 623.15**2
    assert new["E_J_mol"] == pytest.approx(E, rel=1e-12)
    assert old["E_J_mol"] == pytest.approx(0.8 * E, rel=1e-12)
    k = new["A_1_s"] * math.exp(-new["E_J_mol"] / (8.314462618 * 623.15))
    assert k == pytest.approx(math.e * (10.0 / 60.0) * 2.0 / 60.0, rel=1e-5)
    said = "\n".join(import_fds(text, "x.fds", NEW).remarks)
    assert f"E is {1e-3 * E:.1f} kJ/mol from 6.8 on and {0.8e-3 * E:.1f} in 6.7" in said


def test_a_peak_rate_does_not_depend_on_the_version() -> None:
    text = LINES.replace(
        "N_REACTIONS=1, A=1.D9, E=1.2E5,", "REFERENCE_TEMPERATURE=350., REFERENCE_RATE=0.002,"
    )
    old, new = (imported(text, old)["reactions"]["WOOD"] for old in (True, False))
    E = math.e * 0.002 * 8.314472 * 623.15**2 / (5.0 / 60.0)
    assert old["E_J_mol"] == new["E_J_mol"] == pytest.approx(E, rel=1e-12)
    assert "User Guide" not in "\n".join(import_fds(text, "x.fds", NEW).remarks)


def test_the_peak_of_the_imported_reaction_is_where_the_line_has_it() -> None:
    text = LINES.replace("A=1.D9, E=1.2E5,", PEAK)
    reaction = imported(text)["reactions"]["WOOD"]
    dT = 0.01
    T = np.arange(450.0, 800.0, dT)
    k = reaction["A_1_s"] * np.exp(-reaction["E_J_mol"] / (8.314462618 * T))
    left = np.exp(-np.cumsum(k) * dT / (10.0 / 60.0))
    assert T[np.argmax(k * left)] == pytest.approx(623.15, abs=0.5)


def test_water_that_is_gone_at_once_is_told() -> None:
    water = mixture(3.31).replace("A(1)=1E-4, E(1)=0.", "A(1)=9.57E22, E(1)=1.36E5")
    said = "\n".join(import_fds(water, "x.fds", NEW).remarks)
    assert "MATL 'A', reaction 1: it reacts at room temperature" in said
    slow = "\n".join(import_fds(LINES, "x.fds", NEW).remarks)
    assert "room temperature" not in slow
