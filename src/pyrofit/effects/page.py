"""The catalogue of effects as a page of the documentation."""

from collections.abc import Collection

from pyrofit.effects import known_effects
from pyrofit.effects.base import FAMILIES, Effect, Quantity, reacts

_HEAD = """\
# Effects

The effects that a model may lack, by the name a study gives them. At the null value of its strength
an effect leaves the base model exactly as it is. Form parameters say how the effect looks; left
out, they take their default. Effects that set the same number of the description exclude each
other. Those of one group are forms of one another. The strength of an effect of apparatus or
surroundings has a plausible range, left open by a careful description; `diagnosis.plausible`
states another one.

{belongs}
| group | effects |
|---|---|
"""
_BELONGS = "| family | belongs to | effects |\n|---|---|---|\n"
_COLUMNS = (
    "| parameter | symbol | meaning | unit | from | to | {} | source |\n"
    "|---|---|---|---|---|---|---|---|"
)


def effects_page() -> str:
    """Return the page: every effect with its equation, parameters, limits and sources."""
    effects = known_effects().values()
    groups: dict[str, list[str]] = {}
    for effect in effects:
        groups.setdefault(effect.group, []).append(f"`{effect.name}`")
    rows = [f"| {group} | {', '.join(names)} |\n" for group, names in sorted(groups.items())]
    head = _HEAD.format(belongs=_belongs(effects))
    return "\n".join(["".join([head, *rows]), *(_section(effect) for effect in effects)])


def _belongs(effects: Collection[Effect]) -> str:
    """Return the table of the families of effects."""
    rows = []
    for family, words in FAMILIES.items():
        names = ", ".join(f"`{e.name}`" for e in effects if e.family == family)
        rows.append(f"| {family} | {words} | {names} |\n")
    return "".join([_BELONGS, *rows])


def _section(effect: Effect) -> str:
    lines = [f"## `{effect.name}`", "", f"{effect.title[0].upper()}{effect.title[1:]}:", ""]
    lines += [f"    {effect.equation}", ""]
    needs = "" if effect.needs is reacts else f" Needs {effect.needs.words}."
    lines += [f"Group: {effect.group}. Family: {effect.family}.{needs}", ""]
    if effect.distinct_in:
        lines += [f"A candidate only where there is {effect.distinct_in.words}.", ""]
    if effect.same_as:
        lines += [f"Measurements hardly tell it from `{effect.same_as}`.", ""]
    lines += [_COLUMNS.format("null, typical"), *_rows(effect.strength)]
    for q in effect.strength.values():
        if q.plausible:
            low, high = q.plausible
            lines += [
                "",
                f"Plausible: {low:g} to {high:g}, two standard deviations to either side.",
            ]
    if effect.form:
        lines += ["", "Form:", "", _COLUMNS.format("default, alternative"), *_rows(effect.form)]
    return "\n".join([*lines, ""])


def _rows(quantities: dict[str, Quantity]) -> list[str]:
    return [
        f"| `{name}` | {q.symbol} | {q.label} | {q.unit} | {q.lower:g} | {q.upper:g} "
        f"| {q.value:g}, {q.typical:g} | {q.source} |"
        for name, q in quantities.items()
    ]
