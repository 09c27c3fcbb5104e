"""Error against cost: the cheapest settings of an error, and cells and tolerance varied."""

import itertools
from functools import cache
from typing import NamedTuple

import numpy as np
from case import DURATION_S, FLUXES, error, relative_error, seconds, setup, study

from pyrofit.model.accuracy import Accuracy
from pyrofit.solver.run import LANES

WANTED_ERROR = 2e-3
CELLS = range(20, 72, 2)
TOLERANCES = (2e-3, 2.5e-3, 3e-3, 4e-3, 5e-3, 6e-3, 7e-3, 8e-3, 9e-3, 1e-2, 1.2e-2, 1.5e-2, 2e-2)
FIRST_STEPS_S = (0.03, 0.1, 0.3, 1.0)
LONGEST_STEPS_S = (10.0, 20.0, 40.0, 80.0)
CURVE_CELLS = (16, 24, 32, 48, 64, 96, 128)
CURVE_TOLERANCES = (2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4)
CURVE_LEAST_S = 0.5
"""A timing of a curve, shorter than others because they are many."""
NEIGHBOURS = 64
"""Sets near the published one, each value by up to a tenth away."""


class Point(NamedTuple):
    """A setting, its error and its rate."""

    cells: int
    tolerance: float
    error: float
    rate: float


@cache
def cheapest(name: str) -> Accuracy:
    """Return the setting of least cells times steps with an error of at most 0.2 %."""
    best, least = Accuracy(), np.inf
    for cells, tolerance, first, longest in itertools.product(
        CELLS, TOLERANCES, FIRST_STEPS_S, LONGEST_STEPS_S
    ):
        setting = Accuracy(
            cells=cells, tolerance=tolerance, first_step_s=first, longest_step_s=longest
        )
        steps = setup(name).run(setting)[0].steps
        if cells * steps < least and error(name, setting) <= WANTED_ERROR:
            best, least = setting, cells * steps
    return best


def errors_nearby(name: str, accuracy: Accuracy) -> np.ndarray:
    """Return the errors of the same setting for sets around the published one, sorted."""
    given, generator = setup(name), np.random.default_rng(1)
    limits = study().parameters
    values = {
        n: np.clip(
            x * generator.uniform(0.9, 1.1, NEIGHBOURS),
            limits[n].lower * limits[n].factor,
            limits[n].upper * limits[n].factor,
        )
        for n, x in given.values.items()
    }
    fine = Accuracy(cells=400, tolerance=1e-4, longest_step_s=2.0)
    exact = given.run_sets(values, NEIGHBOURS, fine)
    found = given.run_sets(values, NEIGHBOURS, accuracy)
    pairs = zip(found, exact, strict=True)
    return np.sort([relative_error(a.signals["mlr"], b.signals["mlr"]) for a, b in pairs])


def rate(name: str, accuracy: Accuracy, sets: int) -> float:
    """Return whole evaluations per second of equal sets."""
    return sets / seconds(lambda: setup(name).run(accuracy, sets))


def curve(name: str) -> list[Point]:
    """Return error and evaluations per second in lanes over cells and tolerance."""
    points = []
    for cells, tolerance in itertools.product(CURVE_CELLS, CURVE_TOLERANCES):
        setting = Accuracy(
            cells=cells, tolerance=tolerance, first_step_s=30.0 * tolerance, longest_step_s=40.0
        )
        time = seconds(lambda setting=setting: setup(name).run(setting, LANES), CURVE_LEAST_S)
        points.append(Point(cells, tolerance, error(name, setting), LANES / time))
    return points


def front(points: list[Point]) -> list[Point]:
    """Return the points that no other one beats in both."""
    kept: list[Point] = []
    for point in sorted(points, key=lambda p: -p.rate):
        if not kept or point.error < kept[-1].error:
            kept.append(point)
    return kept


def words(name: str) -> str:
    """Return an experiment in words."""
    return f"{FLUXES[name]} kW/m², {DURATION_S[name]:.0f} s"
