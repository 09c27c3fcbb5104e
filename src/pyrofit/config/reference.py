"""The reference page of all keys of a study, generated from its description."""

import re
from collections.abc import Iterable, Iterator
from itertools import chain
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt, MinLen
from pydantic.fields import FieldInfo

from pyrofit.config.keys.study import Study
from pyrofit.model.base import ANY, Part, Rule
from pyrofit.model.parameters import UNITS

_HEAD = """\
# Keys of a study

Every key that a study file may have, by its place. `<name>` is a name of your choice, and `[]`
marks the items of a list. A *value* is a number or the name of one of the `parameters`. Units stand
in brackets, and a key without a kind is a text. All keys may be left out but those that are
required. Unknown keys are refused, with the nearest known one; `pyrofit check STUDY` reports all
errors. The studies in this folder are examples, and `pyrofit init NAME` writes one for your own
material.

Units of parameters: {units}.

This page is generated: `pyrofit reference > config/README.md`.
"""
SEVERAL = 3
"""Places that stand on a line of their own."""
_WORDS: dict[Any, str] = {float: "number", int: "whole number", str: "text", Any: "anything"}


def reference_page() -> str:
    """Return the page with every key of a study."""
    head = _HEAD.format(units=", ".join(f"`{unit}`" for unit in UNITS))
    return with_keys(head, Study)


def with_keys(head: str, root: type[Part], elsewhere: Iterable[type[Part]] = ()) -> str:
    """Return a heading and a section per kind of part of a file that does not stand elsewhere."""
    return "\n".join([head, *_sections(root, {*elsewhere})]).rstrip("\n") + "\n"


def _sections(root: type[Part], elsewhere: set[type[Part]]) -> list[str]:
    """Return one section per kind of part, with all places where it stands."""
    places: dict[type[Part], list[str]] = {root: [""]}
    waiting = [root]
    while waiting:
        part = waiting.pop(0)
        for name, field in part.model_fields.items():
            for inner, tail in _parts(field.annotation):
                where = [".".join(filter(None, [place, name + tail])) for place in places[part]]
                # A property may be made of another: the outer place is enough.
                new = [p for p in where if p not in places.get(inner, ()) and name != "of"]
                if inner not in places:
                    waiting.append(inner)
                places.setdefault(inner, []).extend(new)
    shared = _shared(places)
    return [
        _section(part, places.get(part, []), [base for base in shared if _is_kind_of(part, base)])
        for part in _with_shared(places, shared)
        if part not in elsewhere
    ]


def _shared(parts: Iterable[type[Part]]) -> list[type[Part]]:
    """Return the parts whose keys several others have, too, the nearest base first."""
    bases = [
        base
        for part in parts
        for base in part.__mro__[1:]
        if issubclass(base, Part) and base is not Part and base.model_fields
    ]
    often = [base for base in dict.fromkeys(bases) if bases.count(base) > 1]
    return sorted(often, key=lambda base: -len(base.__mro__))


def _with_shared(parts: Iterable[type[Part]], shared: list[type[Part]]) -> list[type[Part]]:
    """Return the parts, each after the bases that have a section of their own."""
    order = [[*(b for b in reversed(shared) if issubclass(part, b)), part] for part in parts]
    return list(dict.fromkeys(chain.from_iterable(order)))


def _is_kind_of(part: type[Part], base: type[Part]) -> bool:
    return part is not base and issubclass(part, base)


def _section(part: type[Part], places: list[str], bases: list[type[Part]]) -> str:
    above = {row for base in bases for row in _rows(base)}
    rows = [row for row in _rows(part) if row not in above]
    if not places:  # a key that each kind describes itself
        rows = [row for row in rows if ": ." not in row]
    title = ", ".join(f"`{place}`" for place in places if place)
    # A list of places would make the sentence long.
    of_places = f"{title}: " if len(places) < SEVERAL else f"{title}\n\n"
    lead = of_places if title else "" if bases or places != [""] else "The whole file: "
    also = f" Further keys: [{bases[0].__name__}](#{bases[0].__name__.lower()})." if bases else ""
    lines = [f"## {part.__name__}", "", f"{lead}{_sentence(part)}{also}"]
    if rows:
        lines += ["", *rows]
    return "\n".join([*lines, ""])


def _rows(part: type[Part]) -> list[str]:
    return [_row(name, field) for name, field in part.model_fields.items()]


def _sentence(part: type[Part]) -> str:
    """Return the first sentence of a part's docstring, in the middle of a sentence."""
    text = (part.__doc__ or "").split("\n\n")[0].replace("\n", " ").strip()
    return re.sub(r"\s+", " ", text)


def _row(name: str, field: FieldInfo) -> str:
    text, unit = _unit(field.description or "")
    words = " or ".join(dict.fromkeys(_takes(field.annotation)))
    rules = ", ".join(dict.fromkeys(_rules(field)))
    takes = f"{words} [{unit}]" if unit else words
    default = _default(field)
    told = [takes, rules, f"default {default}" if default else ""]
    required = ", required" if field.is_required() else ""
    kind = "; ".join(filter(None, told))
    kind = "" if kind == "text" else f" {kind[0].upper()}{kind[1:]}."
    return f"- `{name}`{required}: {text}.{kind}".replace("<", "\\<")


def _unit(description: str) -> tuple[str, str]:
    """Take the one unit in brackets out of a description.

    >>> _unit("time constant [s]; 0 = never")
    ('time constant; 0 = never', 's')
    """
    units = re.findall(r"\s*\[([^\]]+)\]", description)
    if len(units) != 1:
        return description, ", ".join(units)
    return re.sub(r"\s*\[[^\]]+\]", "", description), units[0]


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return ""
    value = field.get_default(call_default_factory=True)
    if isinstance(value, Part) or value is None or value in ("", (), {}):
        return ""
    if isinstance(value, tuple):
        return ", ".join(f"{item:g}" for item in value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _parts(annotation: Any, tail: str = "") -> Iterator[tuple[type[Part], str]]:
    """Yield the kinds of part in an annotation, with how they are reached."""
    if isinstance(annotation, type) and issubclass(annotation, Part):
        yield annotation, tail
        return
    origin, inside = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        yield from _parts(inside[0], tail)
    elif origin is dict:
        yield from _parts(inside[1], f"{tail}.<name>")
    elif origin is tuple:
        yield from _parts(inside[0], f"{tail}[]")
    elif origin in (Union, UnionType):
        for choice in inside:
            yield from _parts(choice, tail)


def _takes(annotation: Any) -> Iterator[str]:
    """Yield the allowed values of a place, in words."""
    origin, inside = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        yield from _takes(inside[0])
    elif annotation is NoneType:
        return
    elif origin in (Union, UnionType):
        if {*inside} == {float, str}:
            yield "value"
            return
        for choice in inside:
            yield from _takes(choice)
    elif origin is Literal:
        yield from (f"`{choice}`" for choice in inside)
    elif origin is dict:
        yield f"by name: {' or '.join(dict.fromkeys(_takes(inside[1])))}".replace(
            "by name: by name", "by name, by name"
        )
    elif origin is tuple:
        if inside[-1] is Ellipsis:
            yield f"list: {' or '.join(dict.fromkeys(_takes(inside[0])))}"
        else:
            yield f"list of {len(inside)}: {' or '.join(dict.fromkeys(_takes(inside[0])))}"
    elif annotation in _WORDS:
        yield _WORDS[annotation]
    else:
        yield f"[{annotation.__name__}](#{annotation.__name__.lower()})"


def _rules(field: FieldInfo) -> Iterator[str]:
    """Yield the rules for the value, in words."""
    yield from _said(field.metadata)
    choices = get_args(field.annotation)
    for choice in (field.annotation, *choices):
        if get_origin(choice) is Annotated:
            yield from _said(get_args(choice)[1:])


def _said(metadata: Any) -> Iterator[str]:
    for rule in metadata:
        if isinstance(rule, FieldInfo):
            yield from _said(rule.metadata)
        elif isinstance(rule, Rule) and rule is not ANY:
            words = rule.text.split(":")[0].removeprefix("must ")
            yield words.replace("not be ", "not ").removeprefix("be ").removeprefix("lie ")
        elif isinstance(rule, Gt):
            yield f"above {rule.gt:g}"
        elif isinstance(rule, Ge):
            yield f"at least {rule.ge:g}"
        elif isinstance(rule, Le):
            yield f"at most {rule.le:g}"
        elif isinstance(rule, Lt):
            yield f"below {rule.lt:g}"
        elif isinstance(rule, MinLen):
            yield f"at least {rule.min_length}"
