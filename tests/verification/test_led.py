"""Sets that are led take cells and time steps of the first one: their differences are smooth."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import yaml

from pyrofit.config import as_study
from pyrofit.estimate.derivatives import SECANT
from pyrofit.experiments import Gasification
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasification, simulate_slabs
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.run import LANES

PAPER = Path(__file__).parents[2] / "config" / "paper.yaml"
TIME = np.arange(5.0, 400.0, 5.0)
REQUESTS = {
    "mlr": Request(TIME - 2.5, 5.0),
    "mass": Request(TIME),
    "front_temperature": Request(TIME),
    "back_temperature": Request(TIME),
}
COARSE = Accuracy().coarsened()
FINE = Accuracy().refined().refined()
SMALL, LARGER = SECANT.step, 10.0 * SECANT.step
"""Steps of differences, as fractions of the limits' distance."""


@cache
def described() -> tuple[Gasification, Material, dict[str, tuple[float, float]]]:
    """Return a test of the published study, its material, and the limits of the parameters."""
    study = as_study(yaml.safe_load(PAPER.read_text(encoding="utf-8")), "paper.yaml")
    experiment = study.experiments["capa_60"]
    assert isinstance(experiment, Gasification)
    limits = {n: (p.factor * p.lower, p.factor * p.upper) for n, p in study.parameters.items()}
    return experiment, study.material, limits


def beside(step: float, seed: int = 2) -> tuple[dict[str, FloatArray], list[str]]:
    """Return random values, then sets with each parameter moved by a step, and their names."""
    _, _, limits = described()
    draw = np.random.default_rng(seed).uniform(0.3, 0.7, len(limits))
    share = dict(zip(limits, draw, strict=True))
    values = {
        name: np.full(len(limits) + 1, low + share[name] * (high - low))
        for name, (low, high) in limits.items()
    }
    for k, (name, (low, high)) in enumerate(limits.items()):
        values[name][k + 1] += step * (high - low)
    return values, list(limits)


def simulated(
    values: Mapping[str, FloatArray],
    led: bool,
    accuracy: Accuracy = COARSE,
    experiment: Gasification | None = None,
) -> list[Curves]:
    given, material, _ = described()
    (sets,) = {x.size for x in values.values()}
    asked = [REQUESTS]
    (found,) = simulate_slabs([experiment or given], material, values, asked, accuracy, sets, led)
    return found


def alone(values: Mapping[str, FloatArray], experiment: Gasification | None = None) -> Curves:
    given, material, _ = described()
    first = {name: float(x[0]) for name, x in values.items()}
    return simulate_gasification(experiment or given, material, first, REQUESTS, COARSE)


def bits(curves: Curves) -> dict[str, bytes]:
    return {name: curve.tobytes() for name, curve in curves.signals.items()}


@cache
def slopes(
    step: float, led: bool, seed: int = 2, fine: bool = False
) -> dict[tuple[str, str], FloatArray]:
    """Return differences over the step by parameter and signal, zero for idle parameters."""
    values, names = beside(step, seed)
    leader, *others = simulated(values, led, FINE if fine else COARSE)
    return {
        (name, signal): (one.signals[signal] - curve) / step
        for name, one in zip(names, others, strict=True)
        for signal, curve in leader.signals.items()
    }


def largest_difference(
    some: dict[tuple[str, str], FloatArray], others: dict[tuple[str, str], FloatArray]
) -> float:
    """Return the largest rms difference over the rms of the others."""
    sizes = {key: float(np.sqrt(np.mean(slope**2))) for key, slope in others.items()}
    return max(
        float(np.sqrt(np.mean((some[key] - others[key]) ** 2))) / size
        for key, size in sizes.items()
        if size > 0.0
    )


def test_leader_has_the_curves_that_it_has_alone() -> None:
    values, _ = beside(0.3)
    assert len(values["dh"]) > LANES
    leader, *others = simulated(values, led=True)
    assert bits(leader) == bits(alone(values))
    assert {one.cells for one in others} == {leader.cells}
    assert len({one.cells for one in simulated(values, led=False)}) > 1


def test_copies_of_the_leader_have_its_curves() -> None:
    values, _ = beside(0.0)
    leader, *others = simulated(values, led=True)
    assert {one.steps for one in others} == {leader.steps}
    assert all(bits(one) == bits(leader) for one in others)


def test_differences_hardly_depend_on_their_step() -> None:
    assert largest_difference(slopes(SMALL, True, 4), slopes(LARGER, True, 4)) < 1e-3
    assert largest_difference(slopes(1e-4, True, 4), slopes(SMALL, True, 4)) < 0.02
    # Sets that choose their own steps refuse one here and not there.
    assert largest_difference(slopes(1e-4, False, 4), slopes(1e-5, False, 4)) > 0.1


def test_differences_of_coarse_runs_are_near_those_of_fine_ones() -> None:
    fine = slopes(SMALL, True, fine=True)
    assert largest_difference(slopes(SMALL, True), fine) < 0.1
    # The error of own steps changes with the parameters.
    assert largest_difference(slopes(SMALL, False), fine) > 1.0


@pytest.mark.parametrize(
    "change",
    [
        {"front": {"spread": 0.1}},
        {"signals": {"mlr": {"file": "a.csv", "delay_s": "w_A"}}},
        {"sample": {"backing": [{"component": "residue", "thickness_m": 0.004}]}},
    ],
    ids=["flux spread", "clocks that differ", "backing"],
)
def test_leader_leads_in_other_set_ups(change: dict[str, dict[str, object]]) -> None:
    given, _, _ = described()
    parts = given.model_dump(exclude_unset=True)
    for key, update in change.items():
        parts[key] = {**parts[key], **update}
    experiment = type(given).model_validate(parts)
    values, _ = beside(SMALL)
    leader, *others = simulated(values, True, experiment=experiment)
    assert bits(leader) == bits(alone(values, experiment))
    assert all(one.status is leader.status for one in others)
