"""Repeats that disagree are named, with what they differ in."""

import numpy as np
import pandas as pd
import pytest

from pyrofit.analysis.differing_repeats import differing_repeats, lines_on_repeats
from pyrofit.estimate.repeats_agree import BURNING, HEATED, differences
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray

T = np.linspace(400.0, 900.0, 401)
T_S = np.linspace(0.0, 600.0, 301)


def step(at: FloatArray, middle: float, width: float, residue: float = 0.05) -> FloatArray:
    """Return a mass that falls from 1 to a residue."""
    return residue + (1.0 - residue) / (1.0 + np.exp((at - middle) / width))


def noisy(values: FloatArray, seed: int) -> FloatArray:
    return values + 5e-4 * np.random.default_rng(seed).standard_normal(values.size)


def rate(at: FloatArray, level: float = 1.0, start: float = 0.0) -> FloatArray:
    """Return a heat release rate [W/m2] that jumps at ignition."""
    t = at - start
    shape = np.exp(-(((t - 300.0) / 150.0) ** 2)) * (1.0 - np.exp(-(t - 60.0) / 15.0))
    return np.where(t > 60.0, 4e5 * level * shape, 0.0)


def test_repeats_of_one_sample_agree() -> None:
    values = [noisy(step(T, 600.0 + d, 12.0), k) for k, d in enumerate((-1.0, 0.0, 2.0))]
    assert differences([T] * 3, values, HEATED) == []
    burning = [rate(T_S, 1.0, 0.0), rate(T_S, 1.06, 4.0), rate(T_S, 0.95, -3.0)]
    assert differences([T_S] * 3, burning, BURNING) == []


@pytest.mark.parametrize("shift", [-26.0, 15.0])
def test_shifted_record_is_named_with_its_shift(shift: float) -> None:
    middles = (600.0 + shift, 600.0, 601.0, 599.0)
    values = [noisy(step(T, middle, 12.0), k) for k, middle in enumerate(middles)]
    (found,) = differences([T] * 4, values, HEATED)
    assert (found.position, found.kind) == (0, "start")
    assert found.size == pytest.approx(shift, abs=1.5)


def test_other_residue_and_other_shape_are_named() -> None:
    two_steps = 0.5 * (step(T, 560.0, 10.0) + step(T, 640.0, 10.0))
    values = [step(T, 600.0, 12.0), step(T, 600.0, 12.0, residue=0.2), two_steps]
    values += [step(T, 600.5, 12.0), step(T, 599.5, 12.0)]
    found = differences([T] * 5, [noisy(v, k) for k, v in enumerate(values)], HEATED)
    assert [(d.position, d.kind) for d in found] == [(1, "level"), (2, "shape")]
    assert found[0].size == pytest.approx(0.8 / 0.95 - 1.0, abs=0.01)


def test_of_two_records_the_second_stands_for_both() -> None:
    (found,) = differences([T, T], [step(T, 600.0, 12.0), step(T, 620.0, 12.0)], HEATED)
    assert found.position == 1
    assert found.size == pytest.approx(20.0, abs=1.0)


def test_records_that_do_not_overlap_are_not_compared() -> None:
    assert differences([T, T + 600.0], [step(T, 600.0, 12.0)] * 2, HEATED) == []


def test_late_ignition_is_named() -> None:
    values = [rate(T_S), rate(T_S, 1.0, 60.0), rate(T_S, 1.02, 2.0)]
    (found,) = differences([T_S] * 3, values, BURNING)
    assert (found.position, found.kind) == (1, "start")
    assert found.size == pytest.approx(60.0, abs=3.0)


def test_records_at_a_held_temperature_are_compared_over_time() -> None:
    time = np.linspace(0.0, 9000.0, 400)
    held = np.minimum(305.0 + time / 6.0, 563.0)
    quantity = known_quantities()["mass_fraction"]

    def frame(half_s: float, seed: int) -> pd.DataFrame:
        mass = noisy(0.2 + 0.8 * np.exp(-((time / half_s) ** 2)), seed)
        drift = held + 0.4 * time / time[-1] + 0.05 * np.sin(time + seed)
        return pd.DataFrame({"time_s": time, "temperature_K": drift, "mass_fraction": mass})

    alike = [frame(4000.0 + d, k) for k, d in enumerate((0.0, 60.0, -60.0))]
    assert differing_repeats(quantity, alike) == []
    (found,) = lines_on_repeats(quantity, "abcd", [*alike, frame(5500.0, 7)])
    assert found.startswith("d differs from its repeats: the mass fraction")
    assert "°C" not in found
    assert " K " not in found
