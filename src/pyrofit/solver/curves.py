"""The requests to a simulation, and its results."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from pyrofit.model.signal import Follows
from pyrofit.solver.arrays import FloatArray, IntArray, Status, Value

_ENDS = tuple((status, status.finished) for status in Status)


@dataclass(frozen=True)
class Place:
    """A place inside the sample.

    Parameters
    ----------
    depth_m
        Depth in the virgin sample [m], the name of a parameter, or one depth for each set, shape
        (sets,).
    layer
        The place is behind this layer instead; the first one is 1.
    follows
        The material at that depth, or the fixture: the height above the back face stays.
    """

    depth_m: Value | str = 0.0
    layer: int | None = None
    follows: Follows = "material"


@dataclass(frozen=True)
class Request:
    """The request of a signal to a run: its times [s] and bin width [s].

    A heated sample has the programme's temperatures [K] and their rates of change [K/s], by default
    the differences of those. ``output`` names the curve, see `pyrofit.solver.outputs`; without it
    the signal's own name does. ``place`` tells where a temperature in a slab is asked for.
    """

    time_s: FloatArray
    average_s: float = 0.0
    temperature_K: FloatArray | None = None
    output: str = ""
    heating_rate_K_s: FloatArray | None = None
    place: Place | None = None

    def of(self, signal: str) -> str:
        """Return the name of the curve that a signal asks for."""
        return self.output or signal

    def at(self, time_s: FloatArray) -> "Request":
        """Return the request at other times."""
        return Request(
            time_s,
            self.average_s,
            self.temperature_K,
            self.output,
            self.heating_rate_K_s,
            self.place,
        )

    @cached_property
    def alone(self) -> "Request":
        """The request of one set, times of the shape (1, points)."""
        return self.at(self.time_s[None])

    @cached_property
    def end_s(self) -> FloatArray:
        """When it is over in each set [s], shape (sets,), of times of the shape (sets, points)."""
        return np.asarray(self.time_s.max(axis=1) + 0.5 * self.average_s)

    def programme(self) -> tuple[FloatArray, FloatArray]:
        """Return the temperatures [K] and their rates of change [K/s].

        Raises
        ------
        ValueError
            The request has no temperatures.
        """
        T = self.temperature_K
        if T is None:
            raise ValueError("the request for a heated sample needs temperatures")
        if self.heating_rate_K_s is not None:
            return T, self.heating_rate_K_s
        return T, np.gradient(T, self.time_s) if T.size > 1 else np.zeros(T.size)


class Curves(NamedTuple):
    """How a run ended, the signals asked for, and the balances of the run."""

    status: Status
    signals: Mapping[str, FloatArray]
    cells: int = 0
    steps: int = 0
    energy_error: float = 0.0
    mass_error: float = 0.0


class Runs(NamedTuple):
    """The same of several sets: shape (sets,), signals (sets, points)."""

    status: IntArray
    signals: Mapping[str, FloatArray]
    cells: IntArray
    steps: IntArray
    energy_error: FloatArray
    mass_error: FloatArray

    def curves(self) -> list[Curves]:
        """Return the sets one by one; a run that did not finish has no signals."""
        books = self.cells, self.steps, self.energy_error, self.mass_error
        numbers = zip(*(book.tolist() for book in books), strict=True)
        ends = map(_ENDS.__getitem__, self.status.tolist())
        signals = zip(*self.signals.values(), strict=True)
        return [
            Curves(end, dict(zip(self.signals, curves, strict=True)) if finished else {}, *of_set)
            for (end, finished), curves, of_set in zip(ends, signals, numbers, strict=True)
        ]
