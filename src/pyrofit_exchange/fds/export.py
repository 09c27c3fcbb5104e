"""A study in FDS: the file to include, a deck for each test, and pyrofit's curves beside them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit.results.files import write_csv, write_json, write_text
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import BACK, FRONT, MASS, MASS_FRACTION, RATE
from pyrofit_exchange.fds.heated import heated_deck
from pyrofit_exchange.fds.include import all_remarks, heading, include
from pyrofit_exchange.fds.namelists import comment_line, unique, write_all
from pyrofit_exchange.fds.predicted import PredictedByPyrofit, predict_heated, predict_slab
from pyrofit_exchange.fds.slab import Deck, slab_deck
from pyrofit_exchange.fds.versions import Version
from pyrofit_exchange.sets import ParameterSet

MATERIAL, SUMMARY = "material.fds", "export.json"
LEAST_LAST_K, BEHIND_K = 800.0, 30.0
"""A TGA ends at this temperature, or so much behind the end of the reactions."""


class WrittenDeck(NamedTuple):
    """A deck of an experiment with pyrofit's curve of the same.

    Parameters
    ----------
    experiment
        Its name in the study.
    deck
        The deck.
    curve
        pyrofit's curve.
    burn_out_s
        Time of burn-out of a slab, NaN without one.
    """

    experiment: str
    deck: Deck
    curve: pd.DataFrame
    burn_out_s: float


def decks(study: Study, chosen: ParameterSet, version: Version) -> list[WrittenDeck]:
    """Return the decks of a study: every slab, and every heating rate once."""
    names = unique(list(study.experiments), 40)  # FDS takes 50 characters
    found, rates = [], set()
    for name, experiment in study.experiments.items():
        if isinstance(experiment, SlabExperiment):
            found.append(_slab(study, chosen, version, name, names[name]))
        elif isinstance(experiment, HeatedExperiment) and not experiment.is_isothermal:
            if (rate := experiment.heating_rate_K_min) not in rates:
                found.append(_heated(study, chosen, version, name, names[name]))
            rates.add(rate)
    return found


def _slab(
    study: Study, chosen: ParameterSet, version: Version, name: str, chid: str
) -> WrittenDeck:
    experiment = study.experiments[name]
    assert isinstance(experiment, SlabExperiment)
    material, values = chosen.material, chosen.values
    predicted = predict_slab(experiment, material, values, study.accuracy)
    deck = slab_deck(chid, experiment, material, values, version, predicted)
    return WrittenDeck(name, deck, slab_curve(predicted), predicted.burn_out_s)


def slab_curve(predicted: PredictedByPyrofit) -> pd.DataFrame:
    """Return the curves of a slab as a table."""
    columns = {
        "time_s": predicted.time_s,
        f"{RATE}_kg_m2s": predicted.rate,
        f"{BACK}_K": predicted.back_K,
        f"{FRONT}_K": predicted.front_K,
        f"{MASS}_kg_m2": predicted.mass,
    }
    return pd.DataFrame(columns)


def _heated(
    study: Study, chosen: ParameterSet, version: Version, name: str, chid: str
) -> WrittenDeck:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    material, values = chosen.material, chosen.values
    left = predict_heated(experiment, material, values, study.accuracy)
    T = np.arange(experiment.start_temperature_K, 1200.5, 1.0)
    mass = left(T)
    done = float(T[np.flatnonzero(mass - mass[-1] > 2e-3)[-1]]) + BEHIND_K
    last = max(LEAST_LAST_K, 10.0 * np.ceil(0.1 * done))
    deck = heated_deck(chid, experiment, material, values, version, last)
    return WrittenDeck(name, deck, _heated_curve(T, mass, last), float("nan"))


def _heated_curve(T: FloatArray, mass: FloatArray, last: float) -> pd.DataFrame:
    kept = last >= T
    return pd.DataFrame({"temperature_K": T[kept], MASS_FRACTION: mass[kept]})


def text_of_file(deck: Deck, heading_lines: list[str]) -> str:
    """Return a file: heading, inexact terms, and the lines."""
    said = [*heading_lines]
    said += [
        "Differences between FDS and pyrofit:"
        if deck.remarks
        else "All terms of this file are exact."
    ]
    said += [f"  {remark.line}" for remark in deck.remarks]
    comment = "".join(f"{comment_line(line)}\n" for line in said)
    return comment + "\n" + write_all(deck.namelists)


def export(
    study: Study, chosen: ParameterSet, version: Version, folder: Path, proof: list[str]
) -> list[str]:
    """Write all files of a study for FDS; return the inexact terms, one line each.

    Parameters
    ----------
    study, chosen
        The study and its set.
    version
        Version of FDS.
    folder
        Where they go.
    proof
        Result of a comparison with a real FDS, for the heading.
    """
    first = heading(study, chosen, version)
    written = decks(study, chosen, version)
    material = include(study, chosen, version)
    write_text(folder / MATERIAL, text_of_file(material, [*first, *proof]))
    for one in written:
        brief = [*first[:4], f"{one.deck.title}", *_settings(one)]
        write_text(folder / f"{one.deck.name}.fds", text_of_file(one.deck, brief))
        write_csv(folder / f"{one.deck.name}_pyrofit.csv", one.curve)
    write_json(folder / SUMMARY, _summary(study, chosen, version, written, material))
    remarks = all_remarks([material, *(one.deck for one in written)])
    return [f"{remark.line} [{', '.join(of)}]" for remark, of in remarks.items()]


def _settings(one: WrittenDeck) -> list[str]:
    """Return the comment on how a deck is solved."""
    if not one.deck.step_s:
        return ["TGA_ANALYSIS: one temperature, FDS's own steps"]
    burnt = "none" if np.isnan(one.burn_out_s) else f"{one.burn_out_s:.1f} s"
    return [
        f"uniform cells, fixed step of {one.deck.step_s:g} s; burn-out of pyrofit: {burnt}",
        f"pyrofit's curve: {one.deck.name}_pyrofit.csv; DEVC columns are means over the second "
        "before their time",
    ]


def _summary(
    study: Study, chosen: ParameterSet, version: Version, written: list[WrittenDeck], material: Deck
) -> Mapping[str, Any]:
    def of(deck: Deck) -> dict[str, Any]:
        return {"remarks": [remark._asdict() for remark in deck.remarks]}

    return {
        "study": study.name,
        "set": chosen.label,
        "fds": version.name,
        "values_SI": chosen.values,
        "effects": {name: dict(given) for name, given in study.with_effects.items()},
        "material": of(material),
        "decks": [
            {
                "file": f"{one.deck.name}.fds",
                "experiment": one.experiment,
                "step_s": one.deck.step_s,
                "weights": list(one.deck.weights),
                "burn_out_s": None if np.isnan(one.burn_out_s) else one.burn_out_s,
                **of(one.deck),
            }
            for one in written
        ],
    }
