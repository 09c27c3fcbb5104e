"""Fitted parameters and data, and unreliable values, in sentences."""

import math
from collections.abc import Sequence

from pyrofit.analysis.repetitions import FIT, OverRepetitions
from pyrofit.analysis.uses import fitted_experiments, title_of
from pyrofit.config import Study
from pyrofit.show.facts import Facts
from pyrofit.show.text import listed, number, several


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return sentences on fitted parameters and data, costs, and unreliable values."""
    return [_data(study), _lowest(study, facts.repeated), _parameters(facts.repeated)]


def _data(study: Study) -> str:
    used = fitted_experiments(study)
    fitted = listed([title_of(study, name) for name in study.experiments if name in used])
    held = listed([title_of(study, n) for n in study.validation.experiments if n not in used])
    text = (
        f"{several(len(study.imp.estimate), 'parameter')} fitted to {fitted}, with "
        f"{several(len(study.imp.costs), 'cost function')} and "
        f"{several(study.imp.repetitions, 'repetition')} each"
    )
    return f"{text}; held out: {held}." if held else f"{text}."


def _lowest(study: Study, found: Sequence[OverRepetitions]) -> str:
    parts = []
    for one in (one for one in found if one.name == FIT):
        published = study.published.costs.get(one.cost_function, {}) if study.published else {}
        beside = f" (published {number(published[FIT][0])})" if FIT in published else ""
        parts.append(f"{number(one.best)} for {one.cost_function}{beside}")
    return f"The lowest costs that SCE-UA found are {listed(parts)}."


def _parameters(found: Sequence[OverRepetitions]) -> str:
    bound = _costs_by_name([one for one in found if one.bound])
    wide = _costs_by_name([one for one in found if one.is_wide])
    if not bound and not wide:
        once = " (no spread from one repetition)" if math.isnan(found[0].sigma) else ""
        return f"No best set is at a limit, no spread above 20 % of the search range{once}."
    parts = [f"at a limit: {bound}"] if bound else []
    parts += [f"scattered (spread above 20 % of the search range): {wide}"] if wide else []
    return f"Unreliable values in SCE-UA's best sets: {'; '.join(parts)}."


def _costs_by_name(found: Sequence[OverRepetitions]) -> str:
    costs: dict[str, list[str]] = {}
    for one in found:
        costs.setdefault(one.name, []).append(one.cost_function)
    return ", ".join(f"{name} ({', '.join(of)})" for name, of in costs.items())
