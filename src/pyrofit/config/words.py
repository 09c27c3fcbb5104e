"""What YAML and pydantic say, in plain words."""

import re
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError


def as_meant(given: Any, place: str = "") -> Any:
    """Undo what YAML 1.1 makes of words and numbers: 1e-3 is text to it, ``no`` is not."""
    if isinstance(given, bool):
        raise ValueError(
            f"{place}: no key takes true or false (YAML reads yes, no, on, off as such); "
            "give a number, or put text in quotes"
        )
    if isinstance(given, str) and EXPONENT.fullmatch(given):
        return float(given)
    if isinstance(given, Mapping):
        return {k: as_meant(v, f"{place}.{k}" if place else str(k)) for k, v in given.items()}
    if isinstance(given, list):
        return [as_meant(v, f"{place}.{i}") for i, v in enumerate(given)]
    return given


def in_plain_words(error: ValidationError, given: object) -> list[str]:
    """Return one line for each place where something is wrong."""
    found: dict[str, list[Any]] = {}
    for problem in error.errors():
        found.setdefault(_place(problem, given), []).append(problem)
    lines = []
    for place, problems in found.items():
        # What a place takes may have several forms, and each complains; errors inside it, and
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
    """Return what is wrong as a rule."""
    words = WORDS.get(problem["type"])
    if words is None:
        return str(problem["msg"]).removeprefix("Value error, ")
    given = problem["input"]
    shown = f"'{given}'" if isinstance(given, str) else f"{given}"
    return words.format(given=shown, **problem.get("ctx", {}))


EXPONENT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+")
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
    "less_than_equal": "{given} must be at most {le:g}",
    "model_type": "{given} is not a mapping of keys",
    "model_attributes_type": "{given} is not a mapping of keys",
    "dict_type": "{given} is not a mapping of keys",
    "tuple_type": "{given} is not a list",
    "too_short": "a list of {actual_length} is too short; give at least {min_length}",
    "too_long": "a list of {actual_length} is too long; give at most {max_length}",
    "literal_error": "{given} must be {expected}",
    "union_tag_invalid": "unknown {discriminator} '{tag}'; known: {expected_tags}",
    "union_tag_not_found": "{discriminator} is missing, and is required",
}
"""What pydantic finds, as rules."""
