"""What is asked of a simulation, and what it returns."""

from collections.abc import Mapping
from dataclasses import dataclass

from pyrofit.solver.arrays import FloatArray, IntArray, Status


@dataclass(frozen=True)
class Request:
    """What a signal asks of a run: its times [s], bin width [s], for TGA its temperatures [K]."""

    time_s: FloatArray
    average_s: float = 0.0
    temperature_K: FloatArray | None = None


@dataclass(frozen=True)
class Curves:
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
        numbers = self.status, self.cells, self.steps, self.energy_error, self.mass_error
        found = []
        for s, (code, *books) in enumerate(zip(*(n.tolist() for n in numbers), strict=True)):
            status = Status(code)
            signals = {name: curve[s] for name, curve in self.signals.items()}
            found.append(Curves(status, signals if status.finished else {}, *books))
        return found
