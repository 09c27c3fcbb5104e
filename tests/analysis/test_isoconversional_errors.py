"""Errors of activation energies where the mass hardly changes, and energies that are none."""

import numpy as np
import pytest

from pyrofit.analysis.isoconversional.analyse import Analysis, analyse
from pyrofit.analysis.isoconversional.curve import curve_of
from pyrofit.analysis.isoconversional.line import counted

PLATEAU, MAIN = 1, 9
"""Levels of conversion 0.10 and 0.50."""


def dried(slope: float, late: float) -> Analysis:
    """Return the analysis of a solid that loses a tenth as water, and the rest far above.

    The mass falls in between by ``slope`` [1/K]. Half of the main loss comes ``late`` [K] later
    for each factor e of the heating rate.
    """
    kelvin = np.linspace(310.0, 760.0, 900)
    curves = []
    for rate, off in ((5.0, 0.002), (10.0, -0.002), (20.0, 0.001)):
        water = 0.1 / (1.0 + np.exp((340.0 + 5.0 * np.log(rate) - kelvin) / 6.0))
        main = 0.9 / (1.0 + np.exp((600.0 + late * np.log(rate) - kelvin) / 9.0))
        between = (off + slope * (kelvin - 470.0)) * np.exp(-(((kelvin - 470.0) / 60.0) ** 4))
        mass = 1.0 - water - main - between
        time = (kelvin - kelvin[0]) * 60.0 / rate
        curves.append(curve_of(f"{rate:g}", f"{rate:g} K/min", rate, time, kelvin, mass))
    return analyse(curves)


def test_energy_on_a_plateau_has_the_error_of_the_mass() -> None:
    found = dried(2e-4, 15.0).energies["friedman"]
    usual = found.value[MAIN]
    assert abs(found.value[PLATEAU] - usual) < found.error[PLATEAU]
    assert found.error[MAIN] < 0.5 * usual


def test_an_error_of_temperature_does_not_vanish_with_a_wrong_energy() -> None:
    sizes = counted(np.array([-1e3, 1e5, 2e5, np.nan, 3e5]))
    assert sizes[:3] == pytest.approx([1.5e5, 1.5e5, 2e5])
    assert np.isnan(counted(np.array([np.nan]))).all()


def test_an_energy_at_a_limit_of_the_search_is_missing() -> None:
    # The slower heating is the hotter one: no energy above zero fits.
    found = dried(2e-4, -15.0).energies["vyazovkin"]
    assert np.isnan(found.value[MAIN])
    assert np.isnan(found.error[MAIN])
