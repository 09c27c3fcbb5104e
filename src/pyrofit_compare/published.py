"""Published parameter sets, and how they describe the tests of a study."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from pyrofit.config import Study, parameters_in
from pyrofit.data.fetch import store
from pyrofit.errors import DataError, suggest
from pyrofit.experiments import kind_of
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.stages.reading import SYNTHETIC
from pyrofit_compare.compute import REPEATS, Key, Series, both_records, measured_series
from pyrofit_compare.from_fds import set_of_fds
from pyrofit_compare.score import mean_at_times, mean_of, nrms
from pyrofit_exchange.macfp.material import has_heat, material_of
from pyrofit_exchange.macfp.read import read_set
from pyrofit_exchange.macfp.schema import StrictSet

FOLDER = "Material_Properties"
MEAN = "mean"
LIBRARY = Path(__file__).parent / "library"
"""Materials of FDS's validation, which NIST has put into the public domain."""


class PublishedSet(NamedTuple):
    """A published parameter set.

    Parameters
    ----------
    name
        Its file, without folder and ending.
    strict
        The set in the strict form.
    remarks
        The parts of a file of FDS that are not taken over.
    """

    name: str
    strict: StrictSet
    remarks: tuple[str, ...] = ()


def published(folder: Path | None = None) -> tuple[dict[str, PublishedSet], list[str]]:
    """Return published sets by name, and files left out.

    Parameters
    ----------
    folder
        A copy of the MaCFP data base, whose sets lie below its folders `Material_Properties`, or a
        folder of such sets and of files of FDS. By default the sets that come with pyrofit, and
        those of the data base where it is on this machine.

    Raises
    ------
    DataError
        There is no set.
    """
    if folder is not None:
        found, left = _sets_in(folder)
        if not found:
            raise DataError(
                f"{folder}: no parameter sets. Give a copy of the MaCFP data base, which has them "
                f"in MATERIAL/{FOLDER}, or a folder of such sets and of files of FDS"
                + "".join(f"; {why}" for why in left)
            )
        return found, left
    found, left = _sets_in(LIBRARY)
    try:
        of_base, others = _sets_in(store())
    except DataError as error:
        return found, [*left, f"the sets of the MaCFP data base are not here: {error}"]
    return found | of_base, left + others


def _sets_in(root: Path) -> tuple[dict[str, PublishedSet], list[str]]:
    """Return the sets of a copy of the data base, or else of a folder."""
    paths = sorted(root.glob(f"*/{FOLDER}/**/*.json"))
    found: dict[str, PublishedSet] = {}
    left = []
    for path in paths or [*sorted(root.glob("*.json")), *sorted(root.glob("*.fds"))]:
        try:
            found[path.stem] = _published(path)
        except DataError as error:
            left.append(str(error))
    return found, left


def _published(path: Path) -> PublishedSet:
    if path.suffix == ".fds":
        return PublishedSet(path.stem, *set_of_fds(path))
    return PublishedSet(path.stem, read_set(path).strict)


def chosen_sets(sets: Mapping[str, PublishedSet], names: Sequence[str]) -> dict[str, PublishedSet]:
    """Return the sets of some names, or with these parts in their names; by default all.

    Raises
    ------
    DataError
        No set has such a name.
    """
    found: dict[str, PublishedSet] = {}
    for name in names:
        exact = {name: sets[name]} if name in sets else {}
        some = exact or {k: one for k, one in sets.items() if name.lower() in k.lower()}
        if not some:
            raise DataError(f"no parameter set is named '{name}'. {suggest(name, sets)}")
        found |= some
    return found or dict(sets)


def overview_of_sets(sets: Mapping[str, PublishedSet]) -> pd.DataFrame:
    """Return a row for each set: material, laboratory, reactions, what it describes."""
    return pd.DataFrame(
        {
            "set": one.name,
            "material": one.strict.material,
            "laboratory": one.strict.laboratory,
            "components": one.strict.composition.count,
            "reactions": len(one.strict.kinetics.A),
            "describes": "slab and kinetics" if has_heat(one.strict) else "kinetics",
        }
        for one in sets.values()
    )


def errors_of_published(
    study: Study, sets: Mapping[str, PublishedSet]
) -> tuple[pd.DataFrame, list[str]]:
    """Return the error of each set at each test of a study, and remarks.

    The error is that of `pyrofit_compare.score.nrms`, the root mean square of the predicted
    minus the measured mean over its range. Rows are sets, the smallest mean error first; those that
    predict a part of the tests follow. Columns are tests and signals. The last row has the scatter
    of the repeats.

    A set brings material and composition; apparatus and samples are those of the study. Sets of
    kinetics alone predict TGA only.

    Raises
    ------
    DataError
        A measured file breaks a rule, or no test can be predicted.
    """
    values = {n: known.value * study.parameters[n].factor for n, known in study.known.items()}
    values |= study.fixed_values()
    against = {name: _obstacle(e, values) for name, e in study.experiments.items()}
    possible = {name: e for name, e in study.experiments.items() if not against[name]}
    remarks = [
        f"left out: {', '.join(n for n, other in against.items() if other == why)}: {why}"
        for why in dict.fromkeys(filter(None, against.values()))
    ]
    if not possible:
        raise DataError(f"no test of the study can be predicted: {'; '.join(remarks)}")
    posed = study.model_copy(update={"experiments": possible})
    series = measured_series(posed, study.name)
    rows: dict[str, dict[Key, float]] = {}
    floors: dict[Key, float] = {}
    for one in sets.values():
        try:
            rows[one.name] = _errors_of(posed, series, one, values, floors)
        except DataError as error:
            remarks.append(f"{one.name} is left out: {error}")
    if not rows:
        raise DataError(f"no set predicts the tests of the study: {'; '.join(remarks)}")
    columns = pd.MultiIndex.from_tuples(floors, names=["test", "signal"])
    found = [[row.get(key, np.nan) for key in floors] for row in rows.values()]
    frame = pd.DataFrame(found, index=pd.Index(rows, name="set"), columns=columns)
    whole = frame.notna().all(axis=1)
    order = frame.mean(axis=1).sort_values(kind="stable").index
    frame = pd.concat([frame.loc[order][whole[order]], frame.loc[order][~whole[order]]])
    frame.loc[REPEATS] = list(floors.values())
    return frame, remarks


def means_by_signal(found: pd.DataFrame) -> pd.DataFrame:
    """Return the mean of errors over all tests, and over the tests of each signal."""
    signals = found.T.groupby(level="signal", sort=False).mean().T
    return signals.assign(**{MEAN: found.mean(axis=1)})[[MEAN, *signals.columns]]


def _obstacle(experiment: Experiment, values: Mapping[str, float]) -> str:
    """Say why no set of the data base can predict an experiment, or nothing."""
    if any(signal.file == SYNTHETIC for signal in experiment.signals.values()):
        return "the measurement is computed"
    if free := sorted(parameters_in(experiment) - set(values)):
        return f"no value is given for {free[0]}"
    layers = experiment.sample.layers if isinstance(experiment, SlabExperiment) else ()
    own = any(layer.composition or layer.beside for layer in layers)
    return "a layer has its own composition" if own else ""


def _errors_of(
    study: Study,
    series: Series,
    one: PublishedSet,
    values: Mapping[str, float],
    floors: dict[Key, float],
) -> dict[Key, float]:
    """Return the errors of a set by test and signal; the scatter of repeats goes to ``floors``."""
    shown = shown_by(study, one)
    if not shown:
        raise DataError("it has kinetics alone, and the study has no TGA")
    posed = study.model_copy(update={"experiments": shown})
    measured, simulated, _ = both_records(posed, series, one.name, material_in(posed, one), values)
    found = {}
    for (test, signal), repeats in measured.items():
        mean = mean_of(repeats)
        label = test, signal
        floors[label] = mean.floor
        found[label] = nrms(mean, mean_at_times(mean, simulated[test, signal]))
    return found


def shown_by(study: Study, one: PublishedSet) -> dict[str, Experiment]:
    """Return the experiments of a study that a set can describe: TGA alone if it has no heats."""
    return {
        name: experiment
        for name, experiment in study.experiments.items()
        if has_heat(one.strict) or _shows_kinetics_alone(experiment)
    }


def _shows_kinetics_alone(experiment: Experiment) -> bool:
    """Tell whether an experiment depends on no thermal property: a small sample that is weighed."""
    weighed = all("mass" in experiment.quantity(s).scales for s in experiment.signals)
    return weighed and kind_of(experiment).stage == "kinetics"


def material_in(study: Study, one: PublishedSet) -> Material:
    """Return the material of a set, with the components of the apparatus of a study."""
    given = material_of(one.strict)
    slabs = [e for e in study.experiments.values() if isinstance(e, SlabExperiment)]
    bodies = {name for e in slabs for name in e.sample.bodies}
    described = study.material.model_dump(mode="json")["components"]
    given["components"] = {n: described[n] for n in bodies if n in described} | given["components"]
    return Material.model_validate(given)
