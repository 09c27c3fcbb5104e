"""The emissivity of the topmost part of a sample, from the volumes of its elements."""

import numpy as np
import pytest

from pyrofit.solver.reference.radiation import top_average

EMISSIVITY = np.array([0.9, 0.5, 0.8])


def test_layer_of_one_element_keeps_its_emissivity() -> None:
    paint_on_wood = np.array([[1e-5, 0.0, 0.0], [0.0, 1e-4, 0.0], [0.0, 1e-4, 0.0]])
    assert top_average(paint_on_wood, EMISSIVITY, 1e-6) == pytest.approx(0.9)


def test_composition_is_extrapolated_to_the_surface() -> None:
    # Char share 0.4 in the middle of the first element, 0.2 in that of the second: 0.5 in front.
    share = np.array([0.4, 0.2, 0.0])
    volume = 1e-4 * np.column_stack((share, 1.0 - share, np.zeros(3)))
    assert top_average(volume, EMISSIVITY, 1e-9) == pytest.approx(0.5 * 0.9 + 0.5 * 0.5, abs=1e-5)


def test_average_over_a_whole_element_is_its_mean() -> None:
    share = np.array([0.4, 0.2, 0.0])
    volume = 1e-4 * np.column_stack((share, 1.0 - share, np.zeros(3)))
    assert top_average(volume, EMISSIVITY, 1e-4) == pytest.approx(0.4 * 0.9 + 0.6 * 0.5)


def test_extrapolation_stops_at_pure_char() -> None:
    share = np.array([0.9, 0.1])
    volume = 1e-4 * np.column_stack((share, 1.0 - share, np.zeros(2)))
    assert top_average(volume, EMISSIVITY, 1e-9) == pytest.approx(0.9, abs=1e-5)
