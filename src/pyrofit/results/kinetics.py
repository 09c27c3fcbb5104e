"""Results of the fit of the kinetics."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results, read_csv, read_json
from pyrofit.results.needed import EACH, Keys
from pyrofit.solver.outputs import MASS_FRACTION

FITTED = "fitted"
"""Set of the estimates: the optimum of the likelihood."""
LOWEST = "lowest cost"
"""Set of the lowest cost that a search found, which studies with published values show as well."""
_SETS_OF_KINETICS = ("A_1_s", "E_J_mol", "order", MASS_FRACTION)


def parameters(study: Study, results: Results) -> dict[str, float]:
    """Return the estimates of the kinetics, SI units: the optimum of their likelihood."""
    found = identification.estimates(study, results, "kinetics")["estimate"]
    return {str(name): float(value) for name, value in found.items()}


def given_to_imp(study: Study, results: Results) -> dict[str, float]:
    """Return the values of all parameters that the inverse modelling does not estimate, SI units.

    Raises
    ------
    DataError
        The kinetics are fitted, and their estimates are missing or broken.
    """
    fitted = parameters(study, results) if study.imp.kinetics == FITTED else {}
    return {**study.fixed_values(), **fitted}


def searched(study: Study, results: Results) -> dict[str, float]:
    """Return the set of the lowest cost that a search of the kinetics found, SI units."""
    names = study.kinetics.estimate if study.kinetics else ()
    found = read_json(results.kinetics("fit.json"), {("parameters", n): float for n in names})
    values: dict[str, float] = found["parameters"]
    return values


def ends(study: Study, results: Results) -> list[dict[str, float]]:
    """Return the set of the lowest cost and the ends of least squares beside it, SI units."""
    names = study.kinetics.estimate if study.kinetics else ()
    needs: dict[Keys, type] = {("parameters", name): float for name in names}
    needs |= {("least_squares", EACH, "parameters", name): float for name in names}
    found = read_json(results.kinetics("fit.json"), needs)
    return [found["parameters"], *(start["parameters"] for start in found["least_squares"])]


def sets(study: Study, results: Results) -> dict[str, Any]:
    """Return A, E, n and mass fraction by set and reaction."""
    needs: dict[Keys, type] = {
        (label, reaction, key): float
        for label in labels(study)
        for reaction in study.material.reactions
        for key in _SETS_OF_KINETICS
    }
    return read_json(results.kinetics("sets.json"), needs)


def lowest_cost(results: Results) -> float:
    """Return the lowest cost that a search found."""
    found: float = read_json(results.kinetics("fit.json"), {("cost",): float})["cost"]
    return found


def curves(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
    """Return the curves of every set at the TGA experiments."""
    return read_csv(
        results.kinetics("curves.csv"),
        {"temperature_K": float, MASS_FRACTION: float, "experiment": object, "set": object},
        {("experiment", "set"): [(name, label) for name in experiments for label in labels(study)]},
    )


def scores(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
    """Return the scores of every set at the TGA experiments."""
    return read_csv(
        results.kinetics("scores.csv"),
        {"rmse_mass_fraction": float, "experiment": object, "set": object},
        {("experiment", "set"): [(name, label) for name in experiments for label in labels(study)]},
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
    rows = [(*pair, label) for pair in heats_shown(study) for label in labels(study)]
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


def labels(study: Study) -> list[str]:
    """Return the labels of the sets: ours and those of the literature."""
    lowest = [LOWEST] if study.published else []
    return [FITTED, *lowest, *(study.kinetics.sets if study.kinetics else ())]
