"""Reactions, curves and scores of the fitted and the published kinetics."""

from collections.abc import Iterator, Mapping

import pandas as pd

from pyrofit.config import Study, kinetics_of
from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate.targets import Measurements
from pyrofit.experiments.heated.simulate import request
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.results import kinetics
from pyrofit.results.files import Results, write_csv
from pyrofit.results.kinetics import FITTED, LOWEST, heats_shown, masses_shown
from pyrofit.simulate import simulate_tga
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves
from pyrofit.solver.lower import fractions
from pyrofit.solver.lower_network import rate_factor
from pyrofit.solver.outputs import FRACTION_RATE, MASS_FRACTION

Values = Mapping[str, float]
Sets = Mapping[str, tuple[Material, Values]]


def write_curves(
    study: Study, results: Results, measurements: Measurements, fitted: Values
) -> None:
    """Write reactions, curves and scores of every set, at all experiments fitted or compared.

    ``sets.json`` holds the reactions. ``curves.csv`` and ``scores.csv`` hold mass fractions;
    ``heats.csv`` and ``heat_scores.csv`` all other signals, where there are any.

    Parameters
    ----------
    study, results, measurements
        The study, its results, in which the kinetics have been searched, and its data.
    fitted
        Estimates of the kinetics by name, SI units.
    """
    sets = _sets(study, results, fitted)
    reactions = {label: _reactions(*chosen) for label, chosen in sets.items()}
    kinetics.write_sets(results, reactions)
    curves: list[pd.DataFrame] = []
    scores: list[dict[str, object]] = []
    for name, signal in masses_shown(study).items():
        frame = measurements[name, signal]
        measured = frame[MASS_FRACTION].to_numpy(float)
        for chosen, found in _simulated(study, name, signal, frame, sets):
            mass = found.signals[MASS_FRACTION]
            columns = {MASS_FRACTION: mass, "mass_loss_rate_1_s": found.signals[FRACTION_RATE]}
            curves.append(_curve(study, name, signal, frame, columns).assign(set=chosen))
            about = _about(study, name, signal) | {"set": chosen}
            scores.append(about | {"rmse_mass_fraction": root_mean_square(mass - measured)})
    columns_of_curves = ["time_s", "temperature_K", MASS_FRACTION, "mass_loss_rate_1_s"]
    _write(results, "curves.csv", curves, [*columns_of_curves, "experiment", "set"])
    columns_of_scores = ["experiment", "heating_rate_K_min", "used_in_fit", "set"]
    frames = [pd.DataFrame(scores)] if scores else []
    _write(results, "scores.csv", frames, [*columns_of_scores, "rmse_mass_fraction"])
    if heats_shown(study):
        _write_heats(study, results, measurements, sets)


def _sets(study: Study, results: Results, fitted: Values) -> Sets:
    """Return material and values of every set; published ones have reactions alone."""
    given = study.fixed_values()
    of_set = dict.fromkeys(kinetics.labels(study), fitted)
    if LOWEST in of_set:
        of_set[LOWEST] = kinetics.read_fit(study, results).parameters
    return {
        label: (study.material_with(FITTED if label == LOWEST else label), {**given, **values})
        for label, values in of_set.items()
    }


def _reactions(material: Material, values: Values) -> dict[str, kinetics.ReactionOfSet]:
    """Return A, E, n and the virgin mass fraction of the reactant, by reaction."""
    names = list(material.components)
    share = fractions(material.composition, names, values)[:, 0]
    reactions = material.reactions
    return {
        name: kinetics.ReactionOfSet(
            A_1_s=float(rate_factor(reactions[name], values)),
            E_J_mol=value_of(reactions[name].E_J_mol, values),
            order=value_of(reactions[name].order, values),
            mass_fraction=float(share[names.index(reactions[name].reactant)]),
        )
        for name in material.reaction_order()
    }


def _write_heats(study: Study, results: Results, measurements: Measurements, sets: Sets) -> None:
    curves = []
    scores = []
    for name, signal in heats_shown(study):
        frame = measurements[name, signal]
        quantity = study.experiments[name].quantity(signal)
        for chosen, found in _simulated(study, name, signal, frame, sets):
            curve = found.signals[quantity.curve]
            labels = {"signal": signal, "set": chosen}
            curves.append(_curve(study, name, signal, frame, {"value": curve}).assign(**labels))
            error = root_mean_square(curve - frame[quantity.column].to_numpy(float))
            scores.append(_about(study, name, signal) | labels | {"rmse": error})
    write_csv(results.kinetics("heats.csv"), pd.concat(curves, ignore_index=True))
    write_csv(results.kinetics("heat_scores.csv"), pd.DataFrame(scores))


def _write(results: Results, file: str, frames: list[pd.DataFrame], columns: list[str]) -> None:
    """Write frames one behind the other, or no rows with these columns."""
    frame = pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=columns)
    write_csv(results.kinetics(file), frame)


def _simulated(
    study: Study, name: str, signal: str, frame: pd.DataFrame, sets: Sets
) -> Iterator[tuple[str, Curves]]:
    """Yield the curves of each set at the measured times of a signal."""
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    asked = request(experiment, signal, frame, _times(frame))
    for chosen, (material, values) in sets.items():
        yield chosen, simulate_tga(experiment, material, values, asked, study.accuracy)


def _curve(
    study: Study, name: str, signal: str, frame: pd.DataFrame, columns: Mapping[str, FloatArray]
) -> pd.DataFrame:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    temperature = request(experiment, signal, frame, _times(frame)).programme()[0]
    given = {"time_s": _times(frame), "temperature_K": temperature, **columns}
    return pd.DataFrame(given).assign(experiment=name)


def _about(study: Study, name: str, signal: str) -> dict[str, object]:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    cost = kinetics_of(study).cost
    return {
        "experiment": name,
        "heating_rate_K_min": experiment.heating_rate_K_min,
        "used_in_fit": any((t.experiment, t.signal) == (name, signal) for t in cost),
    }


def _times(frame: pd.DataFrame) -> FloatArray:
    return frame["time_s"].to_numpy(float)
