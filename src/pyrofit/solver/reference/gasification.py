"""Gasification of a slab by the reference solver."""

import math
from collections.abc import Mapping

import numpy as np

from pyrofit.model.accuracy import Resolution
from pyrofit.model.base import value_of
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.numerics import linear
from pyrofit.solver.arrays import BoolArray, FloatArray, IntArray, Status
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.observe import observe_one
from pyrofit.solver.outputs import BACK, FRONT, HEAT, MASS, RATE, THICKNESS
from pyrofit.solver.reference.bdf import ReferenceBdf
from pyrofit.solver.reference.factors import slab_factor
from pyrofit.solver.reference.places import inside
from pyrofit.solver.reference.slab import Slab
from pyrofit.solver.reference.specimen import make_slab
from pyrofit.solver.reference.substance import COLDEST_K, HOTTEST_K
from pyrofit.solver.reference.surroundings import Fire, LinearPiece, Outside, fire, pieces

BURNT_FRACTION = 1e-5
"""Reactant left in the sample, relative to its initial mass, at which it counts as burnt out."""
EARLY = {RATE, HEAT, MASS}
"""Curves that do not change any more once the reactant is gone."""
_UNBURNT, _UNOXIDISED = "unburnt", "unoxidised"
_SUMS = {RATE: MASS, HEAT: _UNBURNT}
"""By rate, the remaining amount of which it is the loss."""


def reference_gasification(
    experiment: SlabExperiment,
    material: Material,
    values: Mapping[str, float],
    requests: Mapping[str, Request],
    resolution: Resolution | None = None,
) -> Curves:
    """Simulate a gasification experiment, as `pyrofit.simulate.simulate_gasification` does.

    Arguments and result are the same; ``resolution`` holds the numerical settings. MLR over a bin
    is the difference of the mass, which closes to round-off because extents are the unknowns.
    """
    resolution = resolution or Resolution()
    slab = make_slab(experiment, material, values, resolution.elements)
    flame = fire(experiment.burning(), values)

    def solve(factor: float, asked: Mapping[str, Request]) -> Curves:
        edges = [_clipped(edge, flame) for r in asked.values() for edge in _edges(r)]
        time = np.unique(np.concatenate([edge for both in edges for edge in both]))
        run = _Run(slab, resolution, time, {r.of(n) for n, r in asked.items()} <= EARLY)
        given = list(pieces(experiment, flame, values, float(time[-1]), factor))
        run.go(given)
        if not run.status.finished:
            return Curves(run.status, {}, resolution.elements, run.steps)
        lit = (time >= flame.begins) & (time <= flame.ends)
        shut = lit & (experiment.burning() is not None)
        oxygen = np.where(shut, 0.0, value_of(experiment.oxygen, values))
        spans = [piece.span for piece in given]
        h = np.array([_convection(slab, *of, spans) for of in zip(time, run.states, strict=True)])
        lines = _lines(slab, run.states, lit, (oxygen, h))
        for name in (RATE, HEAT):
            lines[name][time > run.ended] = 0.0
        signals = {
            name: _sample(r.of(name), r, time, lines, flame)
            if r.place is None
            else inside(slab, run.states[_at(r, time)], r.place, experiment.sample, values)
            for name, r in asked.items()
        }
        energy_error = abs(run.heat_missing) / max(run.heat_crossed, 1e-300)
        return Curves(run.status, signals, resolution.elements, run.steps, energy_error)

    return observe_one(experiment, values, requests, solve)


def _edges(request: Request) -> tuple[FloatArray, FloatArray]:
    """Return start and end of the bins; nothing happens before 0, where the initial state holds."""
    half = 0.5 * request.average_s
    return np.maximum(request.time_s - half, 0.0), np.maximum(request.time_s + half, 0.0)


def _clipped(edge: FloatArray, flame: Fire) -> tuple[FloatArray, FloatArray]:
    """Return times, and the same moved into the time in which the flame burns."""
    return edge, np.clip(edge, flame.begins, flame.ends)


def _sample(
    name: str, request: Request, time: FloatArray, lines: Mapping[str, FloatArray], flame: Fire
) -> FloatArray:
    if name in _SUMS and request.average_s > 0.0:
        start, end = _edges(request)
        width = np.maximum(end - start, 1e-9)
        if name == HEAT:
            start, end = _clipped(start, flame)[1], _clipped(end, flame)[1]
        lost = _lost(_SUMS[name], start, end, time, lines)
        if name == HEAT:
            lost = lost + _lost(_UNOXIDISED, *_edges(request), time, lines)
        return np.asarray(lost / width)
    return lines[name][_at(request, time)]


def _lost(
    name: str,
    start: FloatArray,
    end: FloatArray,
    time: FloatArray,
    lines: Mapping[str, FloatArray],
) -> FloatArray:
    """Return by how much a line falls over the bins."""
    line = lines[name]
    return np.asarray(line[np.searchsorted(time, start)] - line[np.searchsorted(time, end)])


def _at(request: Request, time: FloatArray) -> IntArray:
    """Return the positions of the times asked for among those of the states."""
    return np.searchsorted(time, np.maximum(request.time_s, 0.0))


def _convection(slab: Slab, t: float, state: FloatArray, spans: list[tuple[float, float]]) -> float:
    """Return the heat transfer coefficient of the front [W/(m2 K)] at time t."""
    last = spans[-1] if spans else (t, t)  # of a record that ends before the test begins
    span = next((span for span in spans if span[0] <= t < span[1]), last)
    return float(slab.front.convection(slab.split(state)[0][0], t, span)[0])


def _lines(
    slab: Slab, states: FloatArray, lit: BoolArray, gas: tuple[FloatArray, FloatArray]
) -> dict[str, FloatArray]:
    """Return all signals at the times of the states, at which gas burns.

    ``gas`` is the volume fraction of oxygen, and the heat transfer coefficient of the front.
    """
    T, extent = slab.split(states)
    present = slab.masses(extent)
    oxygen, h = (of[:, None, None] for of in gas)
    air = slab.air(T, extent, oxygen, h)
    still = Outside(0.0, 0.0, np.zeros(T.shape[-1]), (0.0, 0.0), air=air)
    rate = slab.derivative(states, still)
    reactions = slab.substance.reactions
    reacting = slab.split(rate)[1]
    burning, glow = reactions.burning, reactions.glow
    return {
        RATE: linear.product(reacting, reactions.gas, slab.mass),
        HEAT: lit * linear.product(reacting, burning, slab.mass)
        + linear.product(reacting, glow, slab.mass),
        _UNBURNT: -(linear.product(extent, burning, slab.mass)),
        _UNOXIDISED: -(linear.product(extent, glow, slab.mass)),
        MASS: present[..., : slab.sample, :].sum(axis=(-2, -1)),
        THICKNESS: slab.thickness(T, extent)[..., : slab.sample].sum(axis=-1),
        FRONT: T[:, 0].copy(),
        BACK: T[:, -1].copy(),
    }


class _Run:
    """One integration: it collects the states at the times asked for."""

    def __init__(
        self, slab: Slab, resolution: Resolution, time: FloatArray, may_stop: bool
    ) -> None:
        self.slab, self.resolution, self.time, self.may_stop = slab, resolution, time, may_stop
        self.states = np.tile(slab.start, (time.size, 1))
        self.filled = int(np.searchsorted(time, 0.0, side="right"))
        self.status = Status.UNBURNT
        self.steps = 0
        self.ended = math.inf
        self.heat_missing = self.heat_crossed = 0.0
        self.reactants = np.unique(slab.substance.reactions.reactant)

    def go(self, parts: list[LinearPiece]) -> None:
        """Integrate over the pieces, from new at each."""
        y = self.slab.start
        with np.errstate(all="ignore"):
            for part in parts:
                y = self._integrate(part, y)
                if not self.status.finished or self.ended < math.inf:
                    break

    def _integrate(self, part: LinearPiece, y: FloatArray) -> FloatArray:
        slab = self.slab
        tolerance = np.full(y.size, self.resolution.tolerance)
        tolerance[:: slab.stride] *= 100.0
        heat = slab.heat_in(y, slab.outside(part.start, part, y))
        solver = ReferenceBdf(
            lambda t, y: slab.derivative(y, slab.outside(t, part, y)),
            part.start,
            y,
            part.end,
            self.resolution.tolerance,
            tolerance,
            lambda t, y: slab.jacobian(y, slab.outside(t, part, y)),
            slab_factor,
        )
        while solver.status == "running" and self.status.finished and self.ended == math.inf:
            before = solver.t, solver.y
            solver.step()
            self._accept(solver)
            heat = self._book(before, heat, solver, part)
        return np.asarray(solver.y)

    def _accept(self, solver: ReferenceBdf) -> None:
        """Judge a step and keep the states at the times in it."""
        self.steps += 1
        self.status = self._judge(solver)
        if not self.status.finished:
            return
        to = int(np.searchsorted(self.time, solver.t, side="right"))
        if to > self.filled:
            inside = solver.dense_output()(self.time[self.filled : to])
            self.states[self.filled : to] = inside.T
            self.filled = to
        if self.status == Status.OK and self.may_stop:
            self.states[self.filled :] = solver.y
            self.ended = solver.t

    def _book(
        self, before: tuple[float, FloatArray], heat: float, solver: ReferenceBdf, part: LinearPiece
    ) -> float:
        """Add a step to the heat balance, by the trapezoidal rule; return the heat flux after."""
        t, y = before
        outside = self.slab.outside(solver.t, part, solver.y)
        after = self.slab.heat_in(solver.y, outside)
        half = 0.5 * (solver.t - t)
        self.heat_crossed += half * abs(heat + after)
        self.heat_missing += half * (heat + after) - self.slab.heat_taken(y, solver.y)
        return after

    def _judge(self, solver: ReferenceBdf) -> Status:
        if not np.isfinite(solver.y).all():
            return Status.NON_FINITE
        T, extent = self.slab.split(solver.y)
        if T.min() <= COLDEST_K or T.max() >= HOTTEST_K:
            return Status.DIVERGED
        if solver.status == "failed" or self.steps >= self.resolution.most_steps:
            return Status.TOO_MANY_STEPS
        left = self.slab.masses(extent)[:, self.reactants].sum()
        burnt = left < BURNT_FRACTION * self.slab.sample_mass
        return Status.OK if burnt or self.status == Status.OK else Status.UNBURNT
