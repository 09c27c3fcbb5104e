"""A study as its pages see it: described once, simulated again and again."""

import base64
import threading
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.api.choices import si_values
from pyrofit.config import Study
from pyrofit.config.read import read_study
from pyrofit.errors import StudyError, suggest
from pyrofit.estimate.targets import Measurements
from pyrofit.results.files import Results
from pyrofit.stages.measurements import computed
from pyrofit.stages.reading import read_all
from pyrofit.steps.posterior import record as posterior
from pyrofit_explore.describe import described_study, in_shown_units, middle
from pyrofit_explore.model import ExploredModel, Simulated, pose_model
from pyrofit_explore.noise import Noise, PendingNoise
from pyrofit_explore.numbers import numbers_of_set
from pyrofit_explore.sets import named_sets

MOST_MODELS = 16
"""Combinations of effects that are kept."""


@dataclass(frozen=True)
class State:
    """The state of a page.

    Parameters
    ----------
    values
        Values of parameters in the units of the study, those of effects included.
    effects
        Effects that are switched on.
    """

    values: Mapping[str, float]
    effects: tuple[str, ...] = ()


def state_of(given: Mapping[str, Any]) -> State:
    """Return the state that a page sends.

    Raises
    ------
    StudyError
        It is no state.
    """
    values, effects = given.get("values"), given.get("effects", [])
    if not isinstance(values, Mapping) or not isinstance(effects, list):
        raise StudyError("state: `values` by name and a list of `effects` are needed")
    return State(values, tuple(sorted({str(name) for name in effects})))


@dataclass(eq=False)
class Session:
    """A study that is explored.

    Parameters
    ----------
    study
        The study.
    measurements
        Its measured series, SI units.
    base
        The study without further effects.
    sets
        Values by set, in the units of the study.
    remarks
        Notes on sets that are left out.
    bands
        Bands of 95 % of the posterior's ensemble, SI units, where the study has one.
    pending
        The noise of the fitted signals; None leaves chi-square out.
    """

    study: Study
    measurements: Measurements
    base: ExploredModel
    sets: Mapping[str, Mapping[str, float]]
    remarks: list[str]
    bands: pd.DataFrame | None = None
    pending: PendingNoise | None = None
    _models: dict[tuple[str, ...], ExploredModel] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    @property
    def noise(self) -> Noise | None:
        """The noise of the fitted signals, once it is known."""
        return self.pending.noise if self.pending else None

    def description(self) -> dict[str, Any]:
        """Return the description of the study, which the page asks for once."""
        return {
            **described_study(self.base, self.bands),
            "sets": {label: dict(values) for label, values in self.sets.items()},
            "remarks": self.remarks,
        }

    def model(self, effects: tuple[str, ...]) -> ExploredModel:
        """Return the study with effects; those used last are kept."""
        if not effects:
            return self.base
        with self._lock:
            model = self._models.pop(effects, None)
            if model is None:
                model = pose_model(self.study, self.measurements, effects)
            self._models[effects] = model
            while len(self._models) > MOST_MODELS:
                del self._models[next(iter(self._models))]
        return model

    def values(self, model: ExploredModel, state: State) -> dict[str, float]:
        """Return the SI values of a state, those that it leaves out as they start.

        Raises
        ------
        StudyError
            A name is unknown, or a value breaks a rule.
        """
        for name in state.values:
            if name not in model.study.parameters:
                known = suggest(str(name), model.study.parameters)
                raise StudyError(f"values: unknown parameter '{name}'. {known}")
        return middle(model) | si_values(model.study, state.values, model.places)

    def simulate(self, state: State) -> tuple[ExploredModel, Simulated]:
        """Return the model with the effects of a state, and its curves."""
        model = self.model(state.effects)
        return model, model.simulate(self.values(model, state))

    def curves(self, state: State) -> dict[str, Any]:
        """Return curves and numbers of a state, as the page takes them.

        ``curves`` holds the drawn points of all signals one after the other: numbers of 32 bits in
        base 64.
        """
        model, simulated = self.simulate(state)
        return {
            "curves": packed(stacked(model, simulated)),
            "numbers": numbers_of_set(model, simulated, self.noise),
            "noise": self.pending.error if self.pending else "",
            "failed": simulated.failed,
        }

    def close(self) -> None:
        """End the jobs that still run."""
        if self.pending:
            self.pending.close()


def stacked(model: ExploredModel, simulated: Simulated) -> np.ndarray:
    """Return the drawn points of all signals one after the other, in the units shown."""
    channels: Iterable[int] = range(len(model.signals))
    return np.concatenate([in_shown_units(model, i, simulated.models[i]) for i in channels])


def packed(values: np.ndarray) -> str:
    """Return numbers as little-endian numbers of 32 bits in base 64.

    >>> packed(np.array([1.0]))
    'AACAPw=='
    """
    return base64.b64encode(values.astype("<f4").tobytes()).decode()


def session_of(
    study: Study | Path, results: Path | None = None, given: str = "", noise: bool = True
) -> Session:
    """Read a study and its measurements, and pose it.

    Parameters
    ----------
    study
        A study or its file.
    results
        Folder of its results, by default ``results/<name>``.
    given
        A further set, as `named_sets` takes it.
    noise
        Whether the noise of the signals is estimated, in a process of its own.

    Raises
    ------
    PyrofitError
        The study or a file breaks a rule.
    """
    beside = study.parent if isinstance(study, Path) else Path()
    read = read_study(study) if isinstance(study, Path) else study
    measurements = {key: frame for key, (frame, _) in read_all(read).items()}
    if read.is_synthetic:
        measurements |= computed(read, fast=True)
    root = Results(results or Path("results") / read.name)
    sets, remarks = named_sets(read, root, given, beside)
    base = pose_model(read, measurements)
    pending = PendingNoise(read, measurements) if noise else None
    there = root.of_step("posterior", posterior.BANDS).exists()
    bands = posterior.read_predicted_bands(root) if there else None
    return Session(read, measurements, base, sets, remarks, bands, pending)
