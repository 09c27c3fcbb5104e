"""The catalogue of effects as a page of the documentation."""

from collections.abc import Collection

from pyrofit.effects import known_effects
from pyrofit.effects.base import ASSUMED, FAMILIES, Effect, Quantity, has_slab, reacts

_HEAD = """\
# Effects

Find an effect that a model may lack, by the name a study gives it. At the null value of its
strength an effect leaves the base model exactly as it is. Form parameters say how the effect looks;
left out, they take their default. Effects that set the same number of the description exclude each
other, and those of one group are forms of one another. Ranges are limits of the fit. A plausible
range, two standard deviations to either side, is left open by a careful description;
`diagnosis.plausible` states another one. The last sentence of a parameter is the
source of its range; without one the range is assumed. Unless told otherwise, an effect acts on
slabs under radiant heat.

{families}

Effects by group and family:

{groups}"""


def effects_page() -> str:
    """Return the page: every effect with its equation, parameters, limits and sources."""
    effects = known_effects().values()
    families = "\n".join(f"- {family}: {words}" for family, words in FAMILIES.items())
    head = _HEAD.format(families=families, groups=_groups(effects))
    return "\n".join([head, *(_section(effect) for effect in effects)])


def _groups(effects: Collection[Effect]) -> str:
    """Return the lines of the groups with their effects."""
    groups: dict[tuple[str, str], list[str]] = {}
    for effect in effects:
        link = f"[`{effect.name}`](#{effect.name.lower()})"
        groups.setdefault((effect.group, effect.family), []).append(link)
    rows = sorted(groups.items())
    return "".join(f"- {of[0]} ({of[1]}): {', '.join(names)}\n" for of, names in rows)


def _section(effect: Effect) -> str:
    lines = [f"## `{effect.name}`", "", f"{effect.title[0].upper()}{effect.title[1:]}:", ""]
    lines += [f"    {effect.equation}", ""]
    notes = []
    if effect.needs is reacts:
        notes.append("Acts on all samples that react.")
    elif effect.needs is not has_slab:
        notes.append(f"Needs {effect.needs.words}.")
    if effect.distinct_in:
        notes.append(f"A candidate only where there is {effect.distinct_in.words}.")
    if effect.same_as:
        notes.append(f"Measurements hardly tell it from `{effect.same_as}`.")
    if notes:
        lines += [" ".join(notes), ""]
    lines += [_item(name, q, "null", "typical") for name, q in effect.strength.items()]
    if effect.form:
        lines += ["", "Form:", ""]
        lines += [_item(name, q, "default", "alternative") for name, q in effect.form.items()]
    return "\n".join([*lines, ""])


def _item(name: str, q: Quantity, at_value: str, at_typical: str) -> str:
    """Return the line of a parameter; the symbol is that of the equation."""
    unit = "" if q.unit == "-" else f" {q.unit}"
    sentences = [
        f"- {q.symbol}, `{name}`: {q.label}, {q.lower:g} to {q.upper:g}{unit}",
        f"{at_value[0].upper()}{at_value[1:]} {q.value:g}, {at_typical} {q.typical:g}",
    ]
    if q.plausible:
        sentences.append("Plausible {:g} to {:g}".format(*q.plausible))
    if q.source != ASSUMED:
        sentences.append(f"{q.source[0].upper()}{q.source[1:]}")
    return ". ".join(sentences) + "."
