"""Results of the fit of the kinetics."""

from collections.abc import Iterator, Mapping, Sequence

import pandas as pd
from pydantic import Field

from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results, read_csv, read_json, write_json
from pyrofit.results.record import Record, check_names, made_of, read_record
from pyrofit.results.searches import End, check_ends
from pyrofit.solver.outputs import MASS_FRACTION

FITTED = "fitted"
"""Set of the estimates: the optimum of the likelihood."""
LOWEST = "lowest cost"
"""Set of the lowest cost that a search found, which studies with published values show as well."""


class Searched(Record):
    """The search of SCE-UA."""

    cost: float = Field(description="lowest cost")
    calls: int = Field(description="model calls")


class KineticsFit(Record):
    """The searches of the kinetics; the estimates are made from their ends."""

    cost: float = Field(description="lowest cost of all searches")
    parameters: dict[str, float] = Field(description="the set of the lowest cost, SI units")
    optimiser: str = Field(description="the optimiser that found it")
    seed: int = Field(description="seed of the searches")
    sceua: Searched = Field(description="SCE-UA")
    least_squares: list[End] = Field(description="least squares by start, best first")


class ReactionOfSet(Record):
    """The kinetics of a reaction in one set."""

    A_1_s: float = Field(description="pre-exponential factor [1/s]")
    E_J_mol: float = Field(description="activation energy [J/mol]")
    order: float = Field(description="reaction order [-]")
    mass_fraction: float = Field(description="virgin mass fraction of the reactant [-]")


Sets = dict[str, dict[str, ReactionOfSet]]
"""Kinetics by set and reaction."""


def parameters(study: Study, results: Results) -> dict[str, float]:
    """Return the estimates of the kinetics, SI units: the optimum of their likelihood."""
    found = identification.estimates(study, results, "kinetics")["estimate"]
    return {str(name): float(value) for name, value in found.items()}


def fixed_for_imp(study: Study, results: Results) -> dict[str, float]:
    """Return the values of all parameters that the inverse modelling does not estimate, SI units.

    Raises
    ------
    DataError
        The kinetics are fitted, and their estimates are missing or broken.
    """
    fitted = parameters(study, results) if study.imp.kinetics == FITTED else {}
    return {**study.fixed_values(), **fitted}


def read_fit(study: Study, results: Results) -> KineticsFit:
    """Return the searches of the kinetics.

    Raises
    ------
    DataError
        The result is missing or broken.
    """
    path = results.kinetics("fit.json")
    found = read_record(path, KineticsFit)
    names = study.kinetics.estimate if study.kinetics else ()
    check_names(path, "parameters", found.parameters, names)
    check_ends(path, "least_squares", found.least_squares, names)
    return found


def read_ends(study: Study, results: Results) -> list[dict[str, float]]:
    """Return the set of the lowest cost and the ends of least squares beside it, SI units."""
    found = read_fit(study, results)
    return [found.parameters, *(end.parameters for end in found.least_squares)]


def write_sets(results: Results, found: Sets) -> None:
    """Write the kinetics of all sets."""
    content = {
        label: {name: one.model_dump() for name, one in of.items()} for label, of in found.items()
    }
    write_json(results.kinetics("sets.json"), content)


def kinetic_sets(study: Study, results: Results) -> Sets:
    """Return the kinetics of all sets.

    Raises
    ------
    DataError
        The result is missing or broken.
    """
    path = results.kinetics("sets.json")
    found = made_of(path, Sets, read_json(path))
    check_names(path, "", found, labels(study))
    for label, of in found.items():
        check_names(path, label, of, study.material.reactions)
    return found


def read_kinetic_curves(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
    """Return the curves of every set at the TGA experiments."""
    return read_csv(
        results.kinetics("curves.csv"),
        {"temperature_K": float, MASS_FRACTION: float, "experiment": object, "set": object},
        {("experiment", "set"): [(name, label) for name in experiments for label in labels(study)]},
    )


def read_kinetic_scores(study: Study, results: Results, experiments: Sequence[str]) -> pd.DataFrame:
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


def read_heat_scores(study: Study, results: Results) -> pd.DataFrame:
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
