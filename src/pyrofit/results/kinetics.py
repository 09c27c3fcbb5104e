"""Results of the fit of the kinetics."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv, read_json
from pyrofit.results.needed import EACH, Keys
from pyrofit.solver.outputs import MASS_FRACTION

FITTED = "fitted"
_SETS_OF_KINETICS = ("A_1_s", "E_J_mol", "order", MASS_FRACTION)


def parameters(study: Study, results: Results) -> dict[str, float]:
    """Return the parameters fitted to TGA, SI units."""
    names = study.kinetics.estimate if study.kinetics else ()
    found = read_json(results.kinetics("fit.json"), {("parameters", n): float for n in names})
    values: dict[str, float] = found["parameters"]
    return values


def ends(study: Study, results: Results) -> list[dict[str, float]]:
    """Return the fit to TGA and the ends of least squares beside it, SI units."""
    names = study.kinetics.estimate if study.kinetics else ()
    needs: dict[Keys, type] = {("parameters", name): float for name in names}
    needs |= {("least_squares", EACH, "parameters", name): float for name in names}
    found = read_json(results.kinetics("fit.json"), needs)
    return [found["parameters"], *(start["parameters"] for start in found["least_squares"])]


def sets(study: Study, results: Results) -> dict[str, Any]:
    """Return the fit to TGA: ``cost``, and A, E, n and mass fraction by set and reaction."""
    needs: dict[Keys, type] = {("cost",): float}
    for label in _labels(study):
        for reaction in study.material.reactions:
            needs |= {("sets", label, reaction, key): float for key in _SETS_OF_KINETICS}
    return read_json(results.kinetics("fit.json"), needs)


def curves(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
    """Return the curves of every set at the TGA experiments."""
    return read_csv(
        results.kinetics("curves.csv"),
        {"temperature_K": float, MASS_FRACTION: float, "experiment": object, "set": object},
        {
            ("experiment", "set"): [
                (name, label) for name in experiments for label in _labels(study)
            ]
        },
    )


def scores(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
    """Return the scores of every set at the TGA experiments."""
    return read_csv(
        results.kinetics("scores.csv"),
        {"rmse_mass_fraction": float, "experiment": object, "set": object},
        {
            ("experiment", "set"): [
                (name, label) for name in experiments for label in _labels(study)
            ]
        },
    )


def heat_curves(study: Study, results: Results) -> pd.DataFrame:
    """Return the curves of every set at the signals of heated samples other than mass."""
    columns = {"temperature_K": float, "value": float}
    return _of_heats(study, results, "heats.csv", columns)


def heat_scores(study: Study, results: Results) -> pd.DataFrame:
    """Return the scores of every set at these signals."""
    return _of_heats(study, results, "heat_scores.csv", {"rmse": float})


def _of_heats(
    study: Study, results: Results, file: str, columns: Mapping[str, type]
) -> pd.DataFrame:
    keys = "experiment", "signal", "set"
    rows = [(*pair, label) for pair in heats_shown(study) for label in _labels(study)]
    return read_csv(
        results.kinetics(file), {**columns, **dict.fromkeys(keys, object)}, {keys: rows}
    )


def masses_shown(study: Study) -> dict[str, str]:
    """Return the signal of mass by experiment that is fitted or compared, in the study's order."""
    masses: dict[str, str] = {}
    for name, signal, mass in _shown(study):
        if mass:
            masses.setdefault(name, signal)
    return masses


def heats_shown(study: Study) -> list[tuple[str, str]]:
    """Return experiment and signal of the other records of heated samples, in the study's order."""
    return [(name, signal) for name, signal, mass in _shown(study) if not mass]


def _shown(study: Study) -> Iterator[tuple[str, str, bool]]:
    """Yield experiment, signal, and whether it is a mass, of all that is fitted or compared."""
    if study.kinetics is None:
        return
    names = {term.experiment for term in study.kinetics.cost} | set(study.kinetics.compare)
    for name, experiment in study.of_stage("kinetics").items():
        if name in names:
            for signal in experiment.signals:
                yield name, signal, experiment.quantity(signal).curve == MASS_FRACTION


def _labels(study: Study) -> list[str]:
    return [FITTED, *(study.kinetics.sets if study.kinetics else ())]
