"""The parameter set that is exported: values, where they come from, how well they are known."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from pyrofit.analysis.answer import answer_values, one_each
from pyrofit.analysis.best_sets import published_sets
from pyrofit.analysis.estimates import Estimated, estimates_of
from pyrofit.analysis.uses import ESTIMATES, PUBLISHED
from pyrofit.config import Study, diagnosed_material, parameters_in
from pyrofit.errors import DataError, StudyError, suggest
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.model.material import Material
from pyrofit.results import diagnosis, identification
from pyrofit.results.diagnosis_schema import OfExtended
from pyrofit.results.files import Results, read_json
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.record import Record, made_of
from pyrofit.stages.predict import sets_of

DIAGNOSIS, TRUTH = "diagnosis", "truth"


class ParameterSet(NamedTuple):
    """A parameter set.

    Parameters
    ----------
    label
        Its name.
    material
        The material with the kinetics that belong to it.
    values
        All parameter values, SI units.
    notes
        By parameter: its interval and how well it is determined, in words.
    """

    label: str
    material: Material
    values: dict[str, float]
    notes: dict[str, str]


def parameter_set(study: Study, results: Results, label: str, beside: Path) -> ParameterSet:
    """Return the set of a label with its material, as `named_set` does.

    Raises
    ------
    StudyError
        As of `named_set`, or the study has no material.
    """
    if not study.material.components:
        raise StudyError(
            f"study '{study.name}' has no material: other programs simulate its experiments. "
            "Export a study whose experiments pyrofit simulates"
        )
    return named_set(study, results, label, beside)


def named_set(study: Study, results: Results, label: str, beside: Path) -> ParameterSet:
    """Return the set of a label; without a material if other programs simulate all experiments.

    Parameters
    ----------
    study, results
        The study and its results.
    label
        'estimates', a set of the report, 'truth', '<cost> published', 'diagnosis', or the path of a
        JSON file of values in SI units by name. Empty = the estimates of the report, or else the
        set of the diagnosis, preferably the one beside the study file.
    beside
        Folder of the study file.

    Raises
    ------
    StudyError
        There is no such set, or a value is missing.
    """
    label = label or _usual(study, results, beside)
    if label.endswith(".json"):
        chosen = ParameterSet(label, _fitted(study), {**study.fixed_values(), **_file(label)}, {})
    elif label == DIAGNOSIS:
        chosen = _diagnosed(study, results, beside)
    elif label == ESTIMATES:
        chosen = _estimates(study, results)
    elif label == TRUTH and study.synthetic is not None:
        chosen = ParameterSet(label, _fitted(study), study.true_values(), {})
    elif label.removesuffix(f" {PUBLISHED}") in published_sets(study) and label.endswith(PUBLISHED):
        own = published_sets(study)[label.removesuffix(f" {PUBLISHED}")]
        chosen = ParameterSet(label, _fitted(study), fixed_for_imp(study, results) | own, {})
    else:
        chosen = _of_report(study, results, label)
    needed = parameters_in(chosen.material, *study.experiments.values())
    for name in sorted(needed - set(chosen.values)):
        raise StudyError(
            f"set '{label}' of study '{study.name}' has no value for '{name}'; "
            "give a file with all values: --set values.json"
        )
    return chosen


def _fitted(study: Study) -> Material:
    return study.material_with(study.imp.kinetics)


def _usual(study: Study, results: Results, beside: Path) -> str:
    if results.identification("estimate.csv").exists():
        return ESTIMATES
    if results.imp("summary.csv").exists():
        return f"{next(iter(study.imp.costs))} {OPTIMISERS['least_squares'].words}"
    if _diagnosis_of(results, beside) is not None:
        return DIAGNOSIS
    raise StudyError(
        f"{results.root}: study '{study.name}' has no fitted values there. Run the workflow, or "
        "name the folder of another run by --results. Sets that need no run: --set truth, "
        "--set '<cost> published', --set values.json"
    )


def _estimates(study: Study, results: Results) -> ParameterSet:
    """Return the answer of the study."""
    values = answer_values(study, results)
    return ParameterSet(ESTIMATES, _fitted(study), values, _notes(study, results, values))


def _of_report(study: Study, results: Results, label: str) -> ParameterSet:
    known = sets_of(study, results)
    if label not in known:
        raise StudyError(
            f"study '{study.name}' has no set '{label}'. "
            + suggest(label, [ESTIMATES, *known, DIAGNOSIS, *([TRUTH] if study.synthetic else [])])
        )
    values = fixed_for_imp(study, results) | known[label]
    return ParameterSet(label, _fitted(study), values, _notes(study, results, values))


def _notes(study: Study, results: Results, values: Mapping[str, float]) -> dict[str, str]:
    """Return the interval of each estimate and how well it is determined, in words."""
    try:
        found = estimates_of(study, identification.read(study, results))
    except DataError:
        return {}  # the analysis has not run
    return {
        e.name: _note(e, values[e.name] / study.parameters[e.name].factor)
        for e in one_each(study, found)
        if e.name in values
    }


def _note(found: Estimated, value: float) -> str:
    partner = (
        f", correlated with {found.partner} ({found.correlation:.2f})" if found.partner else ""
    )
    outside = "" if found.low <= value <= found.high else ", which does not hold this value"
    interval = f"95 % interval {found.low:.5g} to {found.high:.5g}{outside}"
    return f"{interval}, {found.grade}{partner}"


def _file(label: str) -> dict[str, float]:
    content: Mapping[str, Any]
    try:
        content = json.loads(Path(label).read_text(encoding="utf-8"))
        content = content.get("values_SI", content)
        return {name: float(value) for name, value in content.items()}
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise StudyError(
            f"{label}: cannot be read ({error}); give a JSON mapping of parameters to values in SI "
            "units"
        ) from None


def _diagnosis_of(results: Results, beside: Path) -> Path | None:
    """Return the diagnosis of a study, or the one that wrote it beside itself."""
    paths = (beside / "diagnosis.json", results.diagnosis("diagnosis.json"))
    return next((path for path in paths if path.exists()), None)


class _Beside(Record, extra="ignore"):
    """The part of a diagnosis that the study beside it needs."""

    extended: OfExtended


def _diagnosed(study: Study, results: Results, beside: Path) -> ParameterSet:
    """Return the values that the diagnosis fitted: with effects where the study has them."""
    path = _diagnosis_of(results, beside)
    if path is None:
        raise StudyError(
            f"{results.diagnosis('diagnosis.json')}: this result is missing; run `snakemake "
            "diagnose`"
        )
    if path.parent == beside:
        # The study beside it has another name than the one that was diagnosed.
        of = made_of(path, _Beside, read_json(path)).extended.parameters
    else:
        of = diagnosis.read(study, results).base.parameters
    values, notes = study.fixed_values(), {}
    for name, p in of.items():
        if name in study.parameters:
            values[name] = p.value * study.parameters[name].factor
            limit = ", at a limit" if p.at_limit else ""
            notes[name] = f"95 % interval {p.low:.5g} to {p.high:.5g} {p.unit}{limit}"
    return ParameterSet(DIAGNOSIS, diagnosed_material(study), values, notes)
