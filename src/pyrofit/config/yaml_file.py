"""The keys of a study as they stand in its YAML or JSON file."""

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from yaml.composer import ComposerError
from yaml.reader import ReaderError

from pyrofit.errors import StudyError, suggest

LARGEST_BYTES = 50_000_000
"""Size from which a file is not taken for a study."""
MOST_VALUES = 100_000
"""Values that a study may stand for, aliases written out."""


def read_mapping(path: Path) -> dict[str, Any]:
    """Read the keys of a study from a YAML or JSON file, unchecked.

    Raises
    ------
    StudyError
        The file is missing, a directory, not UTF-8 or not YAML, or a key stands twice.
    """
    text = _read_text(path)
    try:
        given = json.loads(text) if path.suffix == ".json" else yaml.load(text, _Loader)
    except yaml.YAMLError as error:
        raise StudyError(f"{path}: not valid yaml{_explain(error, text)}") from None
    except RecursionError:
        raise StudyError(f"{path}: nested too deep; write it flatter") from None
    except ValueError as error:
        if path.suffix == ".json":
            raise StudyError(f"{path}: not valid json: {error}; correct it there") from None
        raise StudyError(
            f"{path}: not valid yaml: a date or number that cannot be ({error}); correct it, or "
            "put text in quotes"
        ) from None
    if not isinstance(given, dict):
        what = (
            "this file is empty" if given is None else f"this is {_KIND.get(type(given), 'text')}"
        )
        raise StudyError(
            f"{path}: a study is a mapping of keys; {what}. Start from config/twin.yaml"
        )
    return given


def as_read(keys: Mapping[str, Any]) -> dict[str, Any]:
    """Return keys that another program has read from YAML, its numbers as here.

    >>> as_read({"noise": "1e-3", "unit": "K"})
    {'noise': 0.001, 'unit': 'K'}
    """
    # What is text to YAML 1.1 stands there without quotes.
    read: dict[str, Any] = yaml.load(yaml.safe_dump(json.loads(json.dumps(keys))), _Loader)
    return read


def _studies_near(folder: Path) -> list[str]:
    """Return the YAML files of a folder, or else of the folders in it; hidden ones do not count."""
    for pattern in ("[!.]*.y*ml", "[!.]*/[!.]*.y*ml"):
        if found := [str(path.relative_to(folder)) for path in folder.glob(pattern)]:
            return found
    return []


def _read_text(path: Path) -> str:
    if path.is_dir():
        raise StudyError(f"{path}: this is a directory; give the study's YAML file")
    if path.exists() and not path.is_file():
        raise StudyError(f"{path}: this is no file but a pipe or a device; give the YAML file")
    if path.is_file() and path.stat().st_size > LARGEST_BYTES:
        raise StudyError(
            f"{path}: larger than {LARGEST_BYTES // 10**6} MB, too large for a study; give the "
            "YAML file"
        )
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        near = _studies_near(path.parent) if path.parent.is_dir() else []
        hint = suggest(path.name, near) if near else "Nor is any other beside it; check the path."
        raise StudyError(f"{path}: there is no such study file. {hint}") from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise StudyError(
            f"{path}: cannot be read, line {line}: byte 0x{error.object[error.start]:02x} is not "
            "UTF-8 text; save the file as text in UTF-8"
        ) from None
    except OSError as error:
        raise StudyError(
            f"{path}: cannot be read ({error.strerror}); check its permissions and its disk"
        ) from None


_KIND = {list: "a list", int: "a number", float: "a number", bool: "true or false"}


class _Loader(yaml.SafeLoader):
    """YAML in which 1e-3 is a number, as everywhere else, and a key stands once."""

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        # Before aliases are merged: keys that a merge brings along may be overwritten.
        node = super().compose_mapping_node(anchor)
        first: dict[tuple[str, str], yaml.Mark] = {}
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                continue
            if (word := (key.tag, key.value)) in first:
                raise ComposerError(
                    problem=f"the key '{key.value}' stands twice, first in line "
                    f"{first[word].line + 1}; delete or rename one of the two",
                    problem_mark=key.start_mark,
                )
            first[word] = key.start_mark
        return node

    def get_single_node(self) -> yaml.Node | None:
        node: yaml.Node | None = super().get_single_node()
        if _expanded(node, {}) > MOST_VALUES:
            raise ComposerError(
                problem=f"its aliases (*) stand for more than {MOST_VALUES:,} values; write out "
                "the ones that are meant",
                problem_mark=None if node is None else node.start_mark,
            )
        return node


def _expanded(node: yaml.Node | None, known: dict[int, float]) -> float:
    """Return how many values a node stands for, its aliases written out."""
    if node is None or isinstance(node, yaml.ScalarNode):
        return 1.0
    if id(node) not in known:
        known[id(node)] = 0.0  # of an anchor inside itself, which is refused later
        pairs = isinstance(node, yaml.MappingNode)
        parts = [part for pair in node.value for part in pair] if pairs else node.value
        known[id(node)] = 1.0 + sum(_expanded(part, known) for part in parts)
    return known[id(node)]


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+$"),
    list("-+.0123456789"),
)

_WAYS_OUT = {
    r"character '\t'": "indent with spaces, not with tabs",
    "stands twice": "",
    "its aliases": "",
    "none of a text file": "delete it",
    "undefined alias": "mark the repeated part with & further up, or correct its name",
    "found duplicate anchor": "give every & a name of its own",
    "could not determine a constructor": "leave the tag out",
    "unhashable": "a key must be a single word",
}


def _explain(error: yaml.YAMLError, text: str) -> str:
    """Return line, problem and remedy of an error of YAML."""
    if isinstance(error, ReaderError):
        line = text.count("\n", 0, error.position)
        problem = f"the character #x{ord(text[error.position]):02x} is none of a text file"
    else:
        mark = getattr(error, "problem_mark", None)
        line = mark.line if mark else 0
        problem = str(getattr(error, "problem", error))
    known = (way for words, way in _WAYS_OUT.items() if words in problem)
    way = next(known, "check the indentation, colons, quotes and brackets there and just above")
    return f", line {line + 1}: {problem}" + (f"; {way}" if way else "")


def as_yaml(keys: Mapping[str, Any], comment: str) -> str:
    """Return a study's keys as YAML, under a comment."""
    text = yaml.safe_dump(dict(keys), sort_keys=False, allow_unicode=True, width=100)
    return "".join(f"# {line}\n" for line in comment.splitlines()) + "\n" + text
