"""Diagnoses of small twins, made once for all tests."""

import fcntl
import os
import pickle
from collections.abc import Callable

import pytest
from hidden_effects import HIDDEN, SEED, Diagnosed
from small import measured, study

from pyrofit.diagnose.diagnosis import DiagnosisWork, examine

Once = Callable[[str, Callable[[], DiagnosisWork]], DiagnosisWork]


@pytest.fixture(scope="session")
def once(tmp_path_factory: pytest.TempPathFactory) -> Once:
    """Return a diagnosis by its name, made by the first of the processes that share the tests."""
    folder = tmp_path_factory.getbasetemp()
    folder = folder.parent if "PYTEST_XDIST_WORKER" in os.environ else folder
    here: dict[str, DiagnosisWork] = {}

    def made(name: str, make: Callable[[], DiagnosisWork]) -> DiagnosisWork:
        if name not in here:
            with (folder / f"{name}.pickle").open("a+b") as file:
                fcntl.flock(file, fcntl.LOCK_EX)  # the others wait for it
                file.seek(0)
                content = file.read() or pickle.dumps(make())
                if file.tell() == 0:
                    file.write(content)
            here[name] = pickle.loads(content)
        return here[name]

    return made


@pytest.fixture(scope="session")
def diagnosed(once: Once) -> Diagnosed:
    """Return the diagnosis of a twin by what it hides, all effects candidates."""

    def diagnosis(hidden: str) -> DiagnosisWork:
        data = measured(HIDDEN[hidden], SEED)
        return once(hidden, lambda: examine(study(), data, advise=False))

    return diagnosis


@pytest.fixture(scope="session")
def unexplained(once: Once) -> DiagnosisWork:
    """Return the diagnosis of a late heater by a catalogue that has no such thing."""
    candidates = study(effects=["k_T", "c_T"])
    data = measured({"heater_ramp": 8.0}, SEED)
    return once("unexplained", lambda: examine(candidates, data))


@pytest.fixture(scope="session")
def undecided(once: Once) -> DiagnosisWork:
    """Return the diagnosis of a weak effect that others imitate."""
    candidates = study(effects=["front_convection", "back_loss", "gas_temperature"])
    data = measured({"front_convection": 1.2}, SEED)
    return once("undecided", lambda: examine(candidates, data))
