"""The further tests: an own small YAML file with experiments as in a study."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pyrofit.config import Study, as_study, read_mapping
from pyrofit.config.keys.study import is_own
from pyrofit.effects.apply import with_shared
from pyrofit.errors import StudyError, suggest
from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.stages.reading import SYNTHETIC
from pyrofit_compare.apparatus import Apparatus, fit_apparatus

KEYS = ("experiments", "components", "parameters", "inert", "known", "area_m2", "assumed")
NAMED = ("experiments", "inert", "parameters")
WORDS = {
    "experiments": "an experiment",
    "inert": "an experiment",
    "parameters": "a parameter",
    "components": "a component",
}
USUAL_AREA_M2 = 0.01
"""Exposed area of the samples whose masses MaCFP-2 and MaCFP-4 ask for [m2]."""


class Given(NamedTuple):
    """Tests to compare with.

    Parameters
    ----------
    study
        The study with these experiments alone.
    apparatus
        Numbers of the apparatus that its inert runs tell.
    area_m2
        Area to which the masses of predictions belong [m2].
    assumed
        Assumptions on the tests, in words.
    """

    study: Study
    apparatus: Apparatus
    area_m2: float
    assumed: tuple[str, ...]


def read_tests(path: Path, study: Study, values: Mapping[str, float]) -> Given:
    """Read the tests, and put them in place of the experiments of a study.

    Paths of measured files are relative to the folder of the YAML file. `components` adds materials
    of the apparatus, such as a wool. `parameters` names numbers of the apparatus that are fitted to
    the `inert` runs, with `known` values of some. ``values`` are those of the study, SI units.

    Raises
    ------
    StudyError
        A key or an experiment breaks a rule; a name exists in the study already.
    """
    keys = read_mapping(path)
    for key in keys:
        if key not in KEYS:
            raise StudyError(f"{path}: key '{key}' is not known. {suggest(str(key), KEYS)}")
    tests, inert, parameters = (_mapping(path, keys, key) for key in NAMED)
    if not tests:
        raise StudyError(f"{path}: `experiments` is missing; list the tests as in a study")
    _check_names(path, "experiments", tests, study.experiments)
    _check_names(path, "inert", inert, [*study.experiments, *tests])
    _check_names(path, "parameters", parameters, study.parameters)
    posed = _elsewhere(study).model_dump(mode="json")
    components = _mapping(path, keys, "components")
    _check_names(path, "components", components, posed["material"]["components"])
    posed["material"]["components"] |= components
    posed["experiments"] |= tests | inert
    posed["parameters"] |= {name: _valued(own) for name, own in parameters.items()}
    posed["known"] |= _mapping(path, keys, "known")
    every = as_study(posed, str(path))
    own = {n: e for n, e in every.experiments.items() if n not in study.experiments}
    own = with_shared(every.material, own, study.with_effects)
    every = every.model_copy(update={"experiments": {**every.experiments, **own}})
    runs = [n for n in own if group_of(every, n) in inert]
    apparatus = fit_apparatus(path, every, runs, list(parameters), values)
    new = every.model_copy(update={"experiments": {n: own[n] for n in own if n not in runs}})
    assumed = _assumed(path, keys, tests)
    return Given(new, apparatus, _area(path, keys), (*assumed, *_shared(study, new)))


def group_of(study: Study, name: str) -> str:
    """Return the name of the test that an experiment repeats, or its own."""
    repeat = study.experiments[name].repeat
    return repeat.test if repeat is not None else name


def _valued(keys: Any) -> Any:
    """Return keys of a parameter with a value, which no stage of the study has to estimate."""
    if not isinstance(keys, Mapping):
        return keys  # the checks of the study report the error
    ends: list[Any] = [keys.get("lower"), keys.get("upper")]
    if "value" in keys or not all(isinstance(end, int | float) for end in ends):
        return keys
    return {**keys, "value": 0.5 * sum(ends)}


def _check_names(path: Path, key: str, given: Iterable[str], taken: Iterable[str]) -> None:
    """Refuse names that the study has already: it may have fitted what they stand for."""
    for name in given:
        if name in taken:
            raise StudyError(
                f"{path}: {key}.{name}: {WORDS[key]} of this name is there already, in the study "
                "or above; take another name"
            )


def exposure(experiment: SlabExperiment, values: Mapping[str, float]) -> tuple[float, float]:
    """Return the largest flux of a test [W/m2], and the time at which it begins [s]."""
    flux = experiment.front.flux_W_m2
    if isinstance(flux, int | float | str):
        return float(value_of(flux, values)), 0.0
    given = [float(value_of(number, values)) for number in flux.value]
    largest = int(np.argmax(given))
    return given[largest], float(flux.time_s[largest])


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
