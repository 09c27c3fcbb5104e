"""Curves of another code and their truths, as a folder of the blind test holds them."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from pydantic import Field, ValidationError

from pyrofit.config import Study
from pyrofit.config.words import in_plain_words
from pyrofit.errors import DataError, StudyError, suggest
from pyrofit.model.base import Part
from pyrofit.results.files import read_csv, read_json
from pyrofit.seeds import seed_for
from pyrofit.solver.curves import Request
from pyrofit.stages.measurements import with_noise
from pyrofit.stages.reading import SYNTHETIC
from pyrofit_blind_test.setting import Draft, Kind, Plan, Setting

KINDS: tuple[Kind, ...] = ("null", "effect", "pair")
"""Kind of a case by the number of its effects."""
MANIFEST = "manifest.json"
EXPERIMENT = "experiment"
"""Column of the experiment's name in a file of curves."""


class Truth(Part):
    """The truth of one case."""

    values: dict[str, float] = Field(description="parameters of the base, SI units")
    effects: dict[str, dict[str, float]] = Field(
        max_length=2,
        description="values of the effects' parameters, SI units, by effect and parameter",
    )
    other_form: bool = Field(
        False,
        description="the code computes the effect by another equation than the catalogue; the "
        "parameters are the nearest ones",
    )

    @property
    def kind(self) -> Kind:
        """Kind of a twin with these effects."""
        return "form" if self.other_form else KINDS[len(self.effects)]


class Manifest(Part):
    """The code and the truths of the curves in a folder."""

    code: str = Field(min_length=1, description="name and version of the code")
    cases: dict[str, Truth] = Field(min_length=1, description="truths by case")

    def truth(self, case: str) -> Truth:
        """Return the truth of a case.

        Raises
        ------
        StudyError
            There is no such case.
        """
        if case not in self.cases:
            raise StudyError(f"unknown case '{case}' of {self.code}. {suggest(case, self.cases)}")
        return self.cases[case]


def read_manifest(folder: Path) -> Manifest:
    """Read the truths of the curves in a folder.

    Raises
    ------
    DataError
        The file is missing or no JSON.
    StudyError
        It breaks a rule.
    """
    path = folder / MANIFEST
    given = read_json(path)
    try:
        return Manifest.model_validate(given)
    except ValidationError as error:
        raise StudyError(f"{path}: " + "; ".join(in_plain_words(error, given))) from None


def read_curve(folder: Path, case: str, experiment: str, column: str) -> pd.DataFrame:
    """Read one noise-free curve: ``time_s`` and the column of the quantity, SI units.

    Raises
    ------
    DataError
        The file is missing or broken, or lacks the experiment.
    """
    path = folder / f"{case}.csv"
    frame = read_csv(path, {EXPERIMENT: object, "time_s": float, column: float})
    here = frame[frame[EXPERIMENT] == experiment]
    if here.empty:
        known = suggest(experiment, list(frame[EXPERIMENT].unique()))
        raise DataError(f"{path}: there is no experiment '{experiment}'. {known}")
    return here[["time_s", column]].reset_index(drop=True)


def drafts(setting: Setting, plan: Plan) -> Iterator[Draft]:
    """Yield drafts of cases: every case and set of signals, with the kinds of noise in turn.

    Raises
    ------
    DataError, StudyError
        The manifest is missing or breaks a rule.
    """
    noises = list(setting.noise)
    repeats = {
        "effect": plan.effects,
        "null": plan.nulls * len(noises),
        "pair": plan.pairs,
        "form": plan.forms,
    }
    count = 0
    for i, (name, truth) in enumerate(read_manifest(Path(setting.curves)).cases.items()):
        for k, signals in enumerate(setting.signals):
            for repeat in range(repeats[truth.kind]):
                single = truth.kind == "effect"
                left_out = single and plan.left_out > 0 and count % plan.left_out == 0
                left_out = left_out or (truth.kind == "pair" and plan.left_out == 1)
                count += single
                yield {
                    "kind": truth.kind,
                    "hidden": truth.effects,
                    "strength": 1.0 if truth.effects else 0.0,
                    "signals": signals,
                    "noise": noises[(i + k + repeat) % len(noises)],
                    "seed": repeat,
                    "left_out": left_out,
                    "curves": name,
                }


def clean(folder: Path, case: str, truth: Study) -> dict[tuple[str, str], pd.DataFrame]:
    """Return the noise-free curves of a case, by (experiment, signal) of a study.

    Raises
    ------
    DataError
        A curve is missing or broken.
    """
    return {
        (name, signal): read_curve(folder, case, name, experiment.quantity(signal).column)
        for name, experiment in truth.experiments.items()
        for signal in experiment.signals
    }


def series_of_case(folder: Path, case: str, truth: Study) -> dict[tuple[str, str], pd.DataFrame]:
    """Return the measurements of a case: its curves, with the noise that a study describes.

    The noise is drawn as that of synthetic measurements, by the seed of the study.

    Raises
    ------
    DataError
        A curve is missing or broken.
    """
    measured = {}
    for (name, signal), curve in clean(folder, case, truth).items():
        experiment = truth.experiments[name]
        quantity, described = experiment.quantity(signal), experiment.signals[signal]
        rng = np.random.default_rng(seed_for(truth.seed, SYNTHETIC, name, signal))
        request = Request(curve["time_s"].to_numpy(float), described.average_s)
        values = curve[quantity.column].to_numpy(float)
        measured[name, signal] = with_noise(quantity, request, values, described.noise, rng)
    return measured
