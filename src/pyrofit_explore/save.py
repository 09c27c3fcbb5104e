"""A state of the page as files: a study that `pyrofit run` takes, and its set of values."""

import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

from pyrofit.api.saving import write_study
from pyrofit.api.studies import read_study
from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.errors import StudyError
from pyrofit.results.files import write_json
from pyrofit_explore.session import Session, State

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,60}")


def save_state(
    session: Session, state: State, ticked: Collection[str], name: str, folder: Path
) -> list[Path]:
    """Write ``<name>.yaml`` and ``<name>.json``; return their paths.

    The study has the effects that are switched on. It estimates the ticked parameters, and holds
    the others at their values. The set has all values in SI units, as ``--set`` takes it.

    Raises
    ------
    StudyError
        The name is none, a file is there already, nothing is ticked, or the study breaks a rule.
    """
    if not _NAME.fullmatch(name):
        raise StudyError(f"name '{name}': use letters, digits and _, a letter first")
    paths = [folder / f"{name}.yaml", folder / f"{name}.json"]
    for path in paths:
        if path.exists():
            raise StudyError(f"{path}: it is there already; give another name")
    model = session.model(state.effects)
    values = session.values(model, state)
    changed = read_study(
        session.study, **_changes(session.study, model.study, state, ticked, values)
    )
    write_study(changed.model_copy(update={"name": name}), paths[0])
    write_json(paths[1], {"study": name, "values_SI": dict(sorted(values.items()))})
    return paths


def _changes(
    study: Study,
    with_effects: Study,
    state: State,
    ticked: Collection[str],
    values: dict[str, float],
) -> dict[str, Any]:
    """Return the changes of a study that make it the one of a state."""
    changes: dict[str, Any] = {}
    for name, value in values.items():
        p = with_effects.parameters[name]
        if name in study.parameters and name not in ticked and p.lower is not None:
            changes[f"parameters.{name}.fixed"] = value / p.factor
    effects: dict[str, dict[str, float | str]] = {}
    added = []
    for effect in state.effects:
        effects[effect] = {}
        true = study.synthetic.effects.get(effect) if study.synthetic else None
        if true is not None:
            changes[f"synthetic.effects.{effect}"] = None
        for key, quantity in known_effects()[effect].quantities.items():
            own = f"{effect}_{key}"
            if own not in ticked and study.synthetic is None:
                effects[effect][key] = values[own]
                continue
            # Synthetic measurements keep their truth. The number is a parameter, held or ticked.
            effects[effect][key] = own
            p = with_effects.parameters[own]
            described = p.model_dump(include={"unit", "lower", "upper", "label"})
            if own in ticked:
                added.append(own)
            else:
                described["fixed"] = values[own] / p.factor
            changes[f"parameters.{own}"] = described
            if study.synthetic is not None:
                changes[f"synthetic.truth.{own}"] = (true or {}).get(key, quantity.value)
    if study.kinetics is not None and not set(study.kinetics.estimate) & set(ticked):
        changes["kinetics"], changes["imp.kinetics"] = None, "described"
    if not {*study.imp.estimate, *added} & set(ticked):
        raise StudyError(
            "save: a study estimates at least one parameter of its slabs; tick one of "
            + ", ".join(study.imp.estimate)
        )
    if effects:
        changes["effects"] = effects
        changes["imp.estimate"] = [*study.imp.estimate, *added]
    return changes
