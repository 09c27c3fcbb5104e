"""Single points far off their neighbours are found, and hardly count in the noise."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pyrofit.cost import Target
from pyrofit.estimate.noise import estimate_noise
from pyrofit.estimate.spikes import spikes
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray

TIME = np.arange(2.5, 1700.0, 5.0)
MLR = known_quantities()["mlr"]
SD = 2e-4
AT = [40, 150, 300]
OFF = 30.0 * SD * np.array([1.0, -1.0, 1.0])


def measured(seed: int) -> FloatArray:
    """A rate with a steep onset and burn-out, and white noise [kg/(m2 s)]."""
    curve = 8e-3 / (1.0 + np.exp(-(TIME - 120.0) / 5.0)) / (1.0 + np.exp((TIME - 1150.0) / 8.0))
    return np.asarray(curve + SD * np.random.default_rng(seed).standard_normal(TIME.size))


def with_spikes(seed: int) -> FloatArray:
    y = measured(seed)
    y[AT] += OFF
    return y


@given(st.integers(0, 10_000))
def test_noise_and_steep_parts_are_no_spikes(seed: int) -> None:
    assert not np.any(spikes(measured(seed)))


def test_spikes_are_found_where_they_are_and_as_large_as_they_are() -> None:
    found = spikes(with_spikes(1))
    assert np.flatnonzero(found).tolist() == AT
    assert found[AT] == pytest.approx(OFF, abs=5.0 * SD)


def test_step_and_corner_are_no_spikes() -> None:
    steps = np.repeat([0.0, 1.0, 5.0, 5.0, 0.0], 6)
    assert not np.any(spikes(steps))
    assert not np.any(spikes(np.abs(np.linspace(-1.0, 1.0, 41))))


def test_short_series_has_no_spikes() -> None:
    assert not np.any(spikes(np.array([0.0, 9.0, 0.0, 0.0])))


@pytest.mark.parametrize("stated", [False, True])
def test_spikes_hardly_change_the_noise_of_other_points(stated: bool) -> None:
    sd = np.full(TIME.size, SD) if stated else None
    clean, spiked = (
        estimate_noise(Target(TIME, y, sd), MLR) for y in (measured(2), with_spikes(2))
    )
    others = np.setdiff1d(np.arange(TIME.size), AT)
    assert spiked.sd[others] == pytest.approx(clean.sd[others], rel=0.1)
    assert np.all(spiked.sd[AT] > 20.0 * SD)
    assert (clean.spikes, spiked.spikes) == (0, 3)
    assert "outliers that count little: 3" in spiked.describe()
    assert "outliers" not in clean.describe()


def test_misfit_of_a_steep_part_is_no_spike() -> None:
    """Two steep curves a moment apart differ in one point alone."""
    y = measured(3)
    late = np.interp(TIME - 4.0, TIME, y)
    assert estimate_noise(Target(TIME, y, np.full(TIME.size, SD)), MLR, about=late).spikes == 0
