"""Read JSON with faults, and list the mended ones."""

import json
import re
from pathlib import Path
from typing import Any, NamedTuple

from pyrofit.errors import DataError

_MOST = 100
_WORD = re.compile(r"-?\d[\d.]*[A-Za-z][\w./]*")
"""A number with its unit, which JSON cannot express."""


class Read(NamedTuple):
    """The content of a file.

    Parameters
    ----------
    content
        The object.
    mended
        The mended faults, with line numbers; nothing where the file is JSON.
    """

    content: dict[str, Any]
    mended: tuple[str, ...]


def read_tolerant_json(path: Path) -> Read:
    """Read a JSON object; mend the faults of hand-written files.

    The faults are an encoding other than UTF-8, a missing comma, and a comma before a closing
    bracket. A number with a unit becomes text; text behind the end of the object is left out.

    Raises
    ------
    DataError
        The file cannot be read, or is no object even then.
    """
    notes: list[str] = []
    try:
        data = path.read_bytes()
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); check the name.") from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        notes.append(f"line {line}: not UTF-8; read as cp1252")
        text = data.decode("cp1252", errors="replace")
    content = _parsed(path, text, notes)
    if not isinstance(content, dict):
        raise DataError(f"{path}: a parameter set is an object in braces; this is none.")
    return Read(content, tuple(notes))


def _parsed(path: Path, text: str, notes: list[str]) -> Any:
    for _ in range(_MOST):
        try:
            return json.loads(text, strict=False)
        except json.JSONDecodeError as error:
            mended = _mended(text, error, notes)
            if mended is None:
                raise DataError(
                    f"{path}, line {error.lineno}, column {error.colno}: {error.msg}; "
                    "correct the file by hand."
                ) from None
            text = mended
    raise DataError(f"{path}: more than {_MOST} places are no JSON; correct the file by hand.")


def _mended(text: str, error: json.JSONDecodeError, notes: list[str]) -> str | None:
    """Return the text with one place mended; None where it is not clear how."""
    at, line = error.pos, f"line {error.lineno}"
    before = text[:at].rstrip()
    if error.msg == "Extra data":
        rest = len(text[at:].splitlines())
        notes.append(f"{line}: {rest} lines behind the end of the object, left out")
        return before
    if error.msg.startswith("Expecting ',' delimiter"):
        start = re.search(r"-?\d[\d.]*$", text[:at])
        word = _WORD.match(text, start.start()) if start else None
        if word:
            notes.append(f"{line}: '{word[0]}' is a number with a unit; read as text")
            return f'{text[: word.start()]}"{word[0]}"{text[word.end() :]}'
        end = len(before)
        notes.append(f"line {text[:end].count(chr(10)) + 1}: a comma is missing at its end")
        return f"{text[:end]},{text[end:]}"
    closing = text[at : at + 1] in ("]", "}")
    if before.endswith(",") and (closing or _closes(text, at)):
        where = text[: len(before)].count("\n") + 1
        notes.append(f"line {where}: a comma too many before a closing bracket")
        return before[:-1] + text[len(before) :]
    return None


def _closes(text: str, at: int) -> bool:
    """Tell whether the next sign from a place on is a closing bracket."""
    return text[at:].lstrip(" \t\r\n,")[:1] in ("]", "}")
