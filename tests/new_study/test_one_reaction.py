"""Whether one reaction describes records, as `pyrofit init` decides it."""

from collections.abc import Callable

import numpy as np
import pytest

from pyrofit.new_study.draft import KineticsDraft, kinetics_limits
from pyrofit.new_study.one_reaction import Record, one_reaction_describes
from pyrofit.new_study.words import said_of_scheme
from pyrofit.solver.arrays import FloatArray

Program = Callable[[FloatArray], FloatArray]
ONE = [(1.0, 180e3, 590.0)]
THREE = [(0.3, 150e3, 540.0), (0.45, 190e3, 610.0), (0.25, 90e3, 640.0)]


def record(parts: list[tuple[float, float, float]], program: Program, seed: int = 0) -> Record:
    """Return a record of parallel reactions: share, E, and temperature of k = 0.001 1/s."""
    time = np.linspace(0.0, 3600.0, 300)
    T, mass = program(time), np.full(time.size, 0.2)
    for share, E, at in parts:
        k = 1e-3 * np.exp(-E / 8.314 * (1.0 / T - 1.0 / at))
        done = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1]) * np.diff(time))])
        mass += 0.8 * share * np.exp(-done)
    mass += np.random.default_rng(seed).normal(0.0, 1e-3, time.size)
    return time, T, mass


def ramp(rate: float, off: float = 0.0) -> Program:
    return lambda time: 320.0 + off + rate * time / 60.0


def hold(at: float, off: float = 0.0) -> Program:
    return lambda time: np.minimum(320.0 + time / 2.0, at) + off


@pytest.mark.parametrize(
    "programs",
    [[ramp(10.0)], [ramp(8.0), ramp(12.0), ramp(12.0, 1.5)], [hold(570.0), hold(590.0, 0.5)]],
    ids=["ramp", "ramps", "holds"],
)
def test_one_reaction_describes_its_own_records(programs: list[Program]) -> None:
    frames = [record(ONE, program, k) for k, program in enumerate(programs)]
    assert one_reaction_describes(frames, 600.0)


@pytest.mark.parametrize("programs", [[ramp(10.0)], [ramp(8.0), ramp(12.0)]])
def test_one_reaction_does_not_describe_three(programs: list[Program]) -> None:
    assert not one_reaction_describes([record(THREE, program) for program in programs], 600.0)


def test_records_of_one_shape_at_other_temperatures_are_not_one_reaction() -> None:
    time, _, mass = record(ONE, ramp(10.0, 15.0))
    early = time, ramp(10.0)(time), mass
    assert not one_reaction_describes([record(ONE, ramp(10.0)), early], 600.0)


def test_kinetics_without_records_are_not_single() -> None:
    assert not kinetics_limits([]).single


@pytest.mark.parametrize(
    ("residue", "moisture", "single", "charring", "lines"),
    [
        (0.20, 0.00, False, True, 0),
        (0.08, 0.06, False, True, 0),
        (0.08, 0.06, True, False, 1),
        (0.08, 0.00, False, False, 1),
        (0.03, 0.06, False, False, 2),
        (0.03, 0.00, True, False, 0),
    ],
)
def test_moist_solid_of_several_reactions_chars_and_left_out_ones_are_told(
    residue: float, moisture: float, single: bool, charring: bool, lines: int
) -> None:
    draft = KineticsDraft(residue=residue, known_residue=True, moisture=moisture, single=single)
    assert draft.charring is charring
    assert len(said_of_scheme(draft)) == lines
