"""Rules that fail with their place, and messages of YAML and pydantic in plain words."""

import re
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError


def require(ok: bool, place: str, message: str) -> None:
    """Raise ValueError with the place unless something holds."""
    if not ok:
        raise ValueError(f"{place}: {message}")


def refuse_booleans(given: Any, place: str = "") -> None:
    """Refuse a boolean, as which YAML 1.1 reads yes, no, on, off, as a value or a key.

    Raises
    ------
    ValueError
        With the place.
    """
    if isinstance(given, bool):
        raise ValueError(
            f"{place}: no key takes true or false (YAML reads yes, no, on, off as such); "
            "give a number, or put text in quotes"
        )
    if isinstance(given, Mapping):
        for key, value in given.items():
            where = f"{place}.{key}" if place else str(key)
            refuse_booleans(key, where)
            refuse_booleans(value, where)
    elif isinstance(given, list):
        for i, value in enumerate(given):
            refuse_booleans(value, f"{place}.{i}")


def in_plain_words(error: ValidationError, given: object) -> list[str]:
    """Return one line for each place where something is wrong."""
    found: dict[str, list[Any]] = {}
    for problem in error.errors():
        found.setdefault(_place(problem, given), []).append(problem)
    lines = []
    for place, problems in found.items():
        # The value at a place may have several forms, and each complains. Errors inside it, and
        # the form with keys where keys were given, say more.
        if any(other.startswith(f"{place}.") for other in found):
            continue
        said = problems[-1 if isinstance(problems[0]["input"], dict) else 0]
        lines.append(f"{place}: {_rule(said)}".removeprefix(": "))
    return lines


def _place(problem: Any, given: Any) -> str:
    """Return the dotted path of a problem, without the names of forms that pydantic adds."""
    keys = []
    for part in problem["loc"]:
        inside = part in given if isinstance(given, dict) else isinstance(given, list)
        if inside and not (isinstance(given, list) and not isinstance(part, int)):
            keys.append(str(part))
            given = given[part] if isinstance(given, dict) or part < len(given) else None
    if problem["type"] == "missing" and keys[-1:] != [str(problem["loc"][-1])]:
        keys.append(str(problem["loc"][-1]))
    return ".".join(keys)


def _rule(problem: Any) -> str:
    """Return the violated rule."""
    given = problem["input"]
    words = WORDS.get(problem["type"])
    if words is None:
        said = str(problem["msg"]).removeprefix("Value error, ")
    else:
        shown = f"'{given}'" if isinstance(given, str) else f"{given}"
        shown = "an empty value" if given is None else shown
        if problem["type"] == "missing" and isinstance(problem["loc"][-1], int):
            words = "this item of the list is missing, and is required"
        said = words.format(given=shown, **problem.get("ctx", {}))
    if isinstance(given, str) and DECIMAL_COMMA.fullmatch(given):
        said += f"; numbers take a decimal point: {given.replace(',', '.')}"
    return said


DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
WORDS = {
    "missing": "this key is missing, and is required",
    "extra_forbidden": "this key is unknown",
    "float_type": "{given} is not a number",
    "float_parsing": "{given} is not a number",
    "finite_number": "{given} must be finite",
    "int_type": "{given} is not a whole number",
    "int_parsing": "{given} is not a whole number",
    "int_from_float": "{given} is not a whole number",
    "string_type": "{given} is not text; put text in quotes",
    "string_pattern_mismatch": "{given} is no name; letters, digits and _ make one, a letter first",
    "greater_than": "{given} must be above {gt:g}",
    "greater_than_equal": "{given} must be at least {ge:g}",
    "less_than": "{given} must be below {lt:g}",
    "less_than_equal": "{given} must be at most {le:g}",
    "model_type": "{given} is not a mapping of keys",
    "model_attributes_type": "{given} is not a mapping of keys",
    "dict_type": "{given} is not a mapping of keys",
    "tuple_type": "{given} is not a list",
    "too_short": "with {actual_length} items this is too short; give at least {min_length}",
    "too_long": "with {actual_length} items this is too long; give at most {max_length}",
    "literal_error": "{given} must be {expected}",
    "union_tag_invalid": "unknown {discriminator} '{tag}'; known: {expected_tags}",
    "union_tag_not_found": "{discriminator} is missing, and is required",
}
"""Errors of pydantic, as rules."""
