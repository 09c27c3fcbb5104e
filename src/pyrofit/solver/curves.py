"""What is asked of a simulation, and what it returns."""

from collections.abc import Mapping
from dataclasses import dataclass

from pyrofit.solver.arrays import FloatArray, Status


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
