"""The keys of ``diagnosis.json`` as a page of the documentation."""

from collections.abc import Iterator
from typing import Literal, get_args, get_origin

from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.record import Record

_TYPES = {
    "str": "text",
    "int": "whole number",
    "float": "number",
    "bool": "true or false",
    "NoneType": "null",
}


_HEAD = """\
# Keys of `diagnosis.json`

Find a key of the [result of a diagnosis](diagnosis.md), which is in `results/<study>/diagnosis/`. A
key without a type is a number or a text.

This page is generated: `pyrofit reference --of diagnosis > docs/diagnosis_json.md`.
"""


def schema_page() -> str:
    """Return the keys of ``diagnosis.json`` as Markdown."""
    parts = [_HEAD]
    for record in _records():
        parts += [f"## {_title(record)}", "", f"{record.__doc__}", ""]
        for name, field in record.model_fields.items():
            plain = field.annotation in (float, str)
            words = "" if plain else f" ({_words(field.annotation)})"
            parts.append(f"- `{field.alias or name}`{words}: {field.description}")
        parts.append("")
    return "\n".join(parts)


def _title(record: type[Record]) -> str:
    return record.__name__.removeprefix("Of")


def _records() -> list[type[Record]]:
    """Return the result and all records in it, each once."""
    found: list[type[Record]] = [Diagnosis]
    for one in found:
        held = [part for f in one.model_fields.values() for part in _held(f.annotation)]
        found += [part for part in dict.fromkeys(held) if part not in found]
    return found


def _held(annotation: object) -> Iterator[type[Record]]:
    if isinstance(annotation, type) and issubclass(annotation, Record):
        yield annotation
    for inner in get_args(annotation):
        yield from _held(inner)


def _words(annotation: object) -> str:
    """Return a type in words, linked to the record that it holds."""
    if isinstance(annotation, type) and issubclass(annotation, Record):
        return f"[{_title(annotation)}](#{_title(annotation).lower()})"
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        return ", ".join(f"`{value}`" for value in inner)
    if origin is list:
        return f"list of {_words(inner[0])}"
    if origin is dict:
        return f"{_words(inner[1])} by name"
    if inner:
        return " or ".join(_words(part) for part in inner)
    return _TYPES[getattr(annotation, "__name__", "")]
