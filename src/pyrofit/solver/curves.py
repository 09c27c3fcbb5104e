"""What is asked of a simulation, and what it returns."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from pyrofit.solver.arrays import FloatArray, IntArray, Status

_STATUSES = tuple(Status)


@dataclass(frozen=True)
class Request:
    """What a signal asks of a run: its times [s], bin width [s], for TGA its temperatures [K].

    ``output`` names the curve, see `pyrofit.solver.outputs`; without it the signal's own name does.
    """

    time_s: FloatArray
    average_s: float = 0.0
    temperature_K: FloatArray | None = None
    output: str = ""

    def of(self, signal: str) -> str:
        """Return the name of the curve that a signal asks for."""
        return self.output or signal


class Curves(NamedTuple):
    """How a run ended, the signals asked for, and the balances of the run."""

    status: Status
    signals: Mapping[str, FloatArray]
    cells: int = 0
    steps: int = 0
    energy_error: float = 0.0
    mass_error: float = 0.0


@dataclass(frozen=True)
class Runs:
    """The same of several sets: shape (sets,), signals (sets, points)."""

    status: IntArray
    signals: Mapping[str, FloatArray]
    cells: IntArray
    steps: IntArray
    energy_error: FloatArray
    mass_error: FloatArray

    def curves(self) -> list[Curves]:
        """Return the sets one by one; what did not finish has no signals."""
        numbers = self.cells, self.steps, self.energy_error, self.mass_error
        statuses = map(_STATUSES.__getitem__, self.status.tolist())
        books = zip(*(n.tolist() for n in numbers), strict=True)
        return [
            Curves(status, self._signals(s) if status.finished else {}, *numbers)
            for s, (status, numbers) in enumerate(zip(statuses, books, strict=True))
        ]

    def _signals(self, s: int) -> dict[str, FloatArray]:
        return {name: curve[s] for name, curve in self.signals.items()}
