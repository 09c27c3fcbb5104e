"""Diagnoses of small twins, made once for all tests."""

from collections.abc import Callable

import pytest
from small import measured, study

from pyrofit.diagnose.diagnosis import Diagnosis, examine

HIDDEN: dict[str, dict[str, float]] = {
    "nothing": {},
    "k_T": {"k_T": -1e-3},
    "in_depth": {"in_depth": 3.5e-4},
    "heater_ramp": {"heater_ramp": 8.0},
    "volatile": {"volatile": 0.015},
}
SEED = 2

Diagnosed = Callable[[str], Diagnosis]


@pytest.fixture(scope="session")
def diagnosed() -> Diagnosed:
    """Return the diagnosis of a twin by what it hides, all effects candidates."""
    made: dict[str, Diagnosis] = {}

    def diagnosis(hidden: str) -> Diagnosis:
        if hidden not in made:
            made[hidden] = examine(study(), measured(HIDDEN[hidden], SEED), advise=False)
        return made[hidden]

    return diagnosis


@pytest.fixture(scope="session")
def unexplained() -> Diagnosis:
    """Return the diagnosis of a late heater by a catalogue that has no such thing."""
    candidates = study(effects=["k_T", "c_T"])
    return examine(candidates, measured({"heater_ramp": 8.0}, SEED))


@pytest.fixture(scope="session")
def undecided() -> Diagnosis:
    """Return the diagnosis of a weak effect that others imitate."""
    candidates = study(effects=["front_convection", "back_loss", "gas_temperature"])
    return examine(candidates, measured({"front_convection": 1.2}, SEED))
