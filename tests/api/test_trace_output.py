"""Curves between the steps of a run."""

from pathlib import Path

import pytest

import pyrofit as pf

PMMA = Path(__file__).parents[2] / "config" / "pmma.yaml"
VALUES = {
    "T_A": 487.0,
    "E_A": 41.3,
    "T_B": 611.7,
    "E_B": 247.4,
    "w_A": 0.0485,
    "rho_a": 1183.6,
    "k_a": 0.185,
    "c_a": 1.129,
    "eps_a": 0.9515,
    "dh": 609.3,
}


@pytest.mark.solver
def test_temperature_inside_does_not_overshoot_as_the_sample_burns_out() -> None:
    """The cells above the wool leave the grid within milliseconds, after steps of seconds."""
    curves = pf.simulate(PMMA, VALUES, experiments=["aalto_65_1"])
    frame = curves["aalto_65_1", "interface_temperature"]
    found = frame["interface_temperature_K"].to_numpy()
    assert found[0] == pytest.approx(319.0, abs=0.1)
    assert found.min() > 318.9
    assert found.max() < 1100.0
