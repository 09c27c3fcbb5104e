"""The further tests: an own small YAML file with experiments as in a study."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pyrofit.config import Study, as_study, read_mapping
from pyrofit.config.keys.study import is_own
from pyrofit.effects.apply import with_shared
from pyrofit.errors import StudyError, suggest
from pyrofit.model.slab import SlabExperiment
from pyrofit.stages.reading import SYNTHETIC

KEYS = ("experiments", "components", "area_m2", "assumed")
USUAL_AREA_M2 = 0.01
"""Exposed area of the samples whose masses MaCFP-2 and MaCFP-4 ask for [m2]."""


class Given(NamedTuple):
    """Tests to compare with.

    Parameters
    ----------
    study
        The study with these experiments alone.
    area_m2
        Area to which the masses of predictions belong [m2].
    assumed
        Assumptions on the tests, in words.
    """

    study: Study
    area_m2: float
    assumed: tuple[str, ...]


def read_tests(path: Path, study: Study) -> Given:
    """Read the tests, and put them in place of the experiments of a study.

    Paths of measured files are relative to the folder of the YAML file. `components` adds materials
    of the apparatus, such as a wool.

    Raises
    ------
    StudyError
        A key or an experiment breaks a rule; a name exists in the study already.
    """
    keys = read_mapping(path)
    for key in keys:
        if key not in KEYS:
            raise StudyError(f"{path}: key '{key}' is not known. {suggest(str(key), KEYS)}")
    experiments = _mapping(path, keys, "experiments")
    if not experiments:
        raise StudyError(f"{path}: `experiments` is missing; list the tests as in a study")
    for name in experiments:
        if name in study.experiments:
            raise StudyError(
                f"{path}: experiments.{name}: the study has an experiment of this name, and may "
                "have fitted it. Give the test a name of its own"
            )
    posed = _elsewhere(study).model_dump(mode="json")
    present = posed["material"]["components"]
    components = _mapping(path, keys, "components")
    for name in components:
        if name in present:
            raise StudyError(
                f"{path}: components.{name}: the study has a component of this name; leave it out "
                "or take another name"
            )
    posed["material"]["components"] = present | components
    posed["experiments"] |= experiments
    every = as_study(posed, str(path))
    own = {n: e for n, e in every.experiments.items() if n not in study.experiments}
    own = with_shared(every.material, own, study.with_effects)
    tests = every.model_copy(update={"experiments": own})
    assumed = _assumed(path, keys, experiments)
    return Given(tests, _area(path, keys), (*assumed, *_shared(study, tests)))


def exposure(experiment: SlabExperiment) -> tuple[float, float]:
    """Return the largest flux [W/m2] that a test states, and the time at which it begins [s].

    Raises
    ------
    StudyError
        The flux is a parameter.
    """
    flux = experiment.front.flux_W_m2
    if isinstance(flux, int | float):
        return float(flux), 0.0
    times, values = getattr(flux, "time_s", None), getattr(flux, "value", None)
    if times is None or values is None or any(isinstance(v, str) for v in values):
        raise StudyError("flux_W_m2 is no number; predictions of others are matched by it")
    largest = int(np.argmax(np.asarray(values, float)))
    return float(values[largest]), float(times[largest])


def thickness(experiment: SlabExperiment) -> float:
    """Return the thickness of the sample [m]; NaN where it is a parameter."""
    layers = [layer.thickness_m for layer in experiment.sample.layers]
    return sum(float("nan") if isinstance(d, str) else float(d) for d in layers)


def _elsewhere(study: Study) -> Study:
    """Return a study whose paths hold in each folder."""
    experiments = {
        name: experiment.model_copy(
            update={
                "signals": {
                    label: signal.model_copy(update={"file": str(Path(signal.file).resolve())})
                    if is_own(signal.file)
                    else signal
                    for label, signal in experiment.signals.items()
                }
            }
        )
        for name, experiment in study.experiments.items()
    }
    plugins = tuple(str(Path(name).resolve()) for name in study.plugins)
    return study.model_copy(update={"experiments": experiments, "plugins": plugins})


def _shared(study: Study, tests: Study) -> list[str]:
    """Say which measured files the study has as well: its stages may have used them."""
    files = {
        _where(signal.file): f"{name}, {label}"
        for name, experiment in study.experiments.items()
        for label, signal in experiment.signals.items()
    }
    return [
        f"{name}, {label}: the study has this file as {files[_where(signal.file)]}. It is no new "
        "test if the study fitted it."
        for name, experiment in tests.experiments.items()
        for label, signal in experiment.signals.items()
        if signal.file != SYNTHETIC and _where(signal.file) in files
    ]


def _where(file: str) -> str:
    return str(Path(file).resolve()) if is_own(file) else file


def _mapping(path: Path, keys: Mapping[str, Any], key: str) -> dict[str, Any]:
    found = keys.get(key) or {}
    if not isinstance(found, Mapping):
        raise StudyError(f"{path}: `{key}` is no mapping; give a mapping of names, as in a study")
    return dict(found)


def _area(path: Path, keys: Mapping[str, Any]) -> float:
    area = keys.get("area_m2", USUAL_AREA_M2)
    if isinstance(area, bool) or not isinstance(area, int | float) or not 0.0 < area < 10.0:
        raise StudyError(
            f"{path}: area_m2 = {area}; it must be a number of m2 above 0 and below 10, the area "
            "to which the masses in predictions belong"
        )
    return float(area)


def _assumed(
    path: Path, keys: Mapping[str, Any], experiments: Mapping[str, Any]
) -> tuple[str, ...]:
    """Return what is assumed: the words of the file, the area, boundary conditions left out."""
    said = keys.get("assumed") or []
    if isinstance(said, str):
        said = [said]
    if not isinstance(said, list) or not all(isinstance(line, str) for line in said):
        raise StudyError(f"{path}: `assumed` is no list of texts; give one line per assumption")
    lines = list(said)
    if "area_m2" not in keys:
        lines.append(f"Masses in predictions belong to {USUAL_AREA_M2:g} m² (`area_m2`).")
    for name, keys_of in experiments.items():
        front = keys_of.get("front") if isinstance(keys_of, Mapping) else None
        if isinstance(front, Mapping) and "flux_W_m2" in front:
            usual = ("h_W_m2K", "gas_temperature_K", "wall_temperature_K")
            left = [key for key in usual if key not in front]
            words = ", ".join(left)
            if left:
                lines.append(f"{name}: front without {words}: default values.")
    return tuple(lines)
