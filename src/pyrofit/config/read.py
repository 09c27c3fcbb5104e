"""Studies from YAML, and digests of their parts."""

import hashlib
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError
from yaml.composer import ComposerError
from yaml.reader import ReaderError

from pyrofit.config.checks import check_study
from pyrofit.config.diagnosis_checks import check_diagnosis
from pyrofit.config.effects import apply_effects
from pyrofit.config.known_checks import check_known
from pyrofit.config.programs import with_programs
from pyrofit.config.repeats import expand_repeats
from pyrofit.config.study import Study, is_own
from pyrofit.config.tables import with_tables
from pyrofit.config.words import in_plain_words, refuse_booleans
from pyrofit.errors import StudyError, suggest
from pyrofit.model.base import Part
from pyrofit.plugins import use_plugins


def as_study(given: Mapping[str, Any], source: str) -> Study:
    """Check a study description.

    Files of the user are found relative to the folder of a YAML ``source``. JSON is what the
    workflow wrote of a study once checked: there they are found already. The study's plugins
    are known from then on, those of a study read before are not.

    Raises
    ------
    StudyError
        With source, key, rule and way out for everything that is wrong.
    """
    path = Path(source)
    folder = None if path.suffix == ".json" else path.parent
    try:
        refuse_booleans(given)
        use_plugins([(folder or Path()) / name for name in _plugins(given)])
        given = expand_repeats(given)
        given = with_tables(given, folder or Path())
        study = with_programs(Study.model_validate(apply_effects(given)), folder)
        check_study(study)
        check_diagnosis(study)
        check_known(study)
    except ValidationError as error:
        lines = in_plain_words(error, given)
    except ValueError as error:
        lines = [str(error)]
    except RecursionError:
        lines = ["an anchor (&) is used inside itself (*); write it out"]
    else:
        return study if folder is None else _located(study, folder)
    rules = "a rule" if len(lines) == 1 else f"{len(lines)} rules"
    text = "".join(f"\n  {line}" for line in lines)
    raise StudyError(f"{source}: the study description breaks {rules}:{text}")


def _plugins(given: Mapping[str, Any]) -> list[str]:
    """Return the folders of a study's plugins; none where they are no list of names."""
    names = given.get("plugins")
    if not isinstance(names, list | tuple):
        return []  # the checks of the study say what is wrong
    return [name for name in names if isinstance(name, str)]


def _located(study: Study, folder: Path) -> Study:
    """Return the study with the paths of the user's files as seen from the working folder."""
    experiments = {
        name: experiment.model_copy(
            update={
                "signals": {
                    quantity: signal.model_copy(update={"file": (folder / signal.file).as_posix()})
                    if is_own(signal.file)
                    else signal
                    for quantity, signal in experiment.signals.items()
                }
            }
        )
        for name, experiment in study.experiments.items()
    }
    plugins = tuple((folder / name).as_posix() for name in study.plugins)
    return study.model_copy(update={"experiments": experiments, "plugins": plugins})


def read_study(path: Path) -> Study:
    """Read a study from a YAML or JSON file.

    Raises
    ------
    StudyError
        The file is missing, a directory, not YAML, or breaks a rule.
    """
    return as_study(read_mapping(path), str(path))


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


def _read_text(path: Path) -> str:
    if path.is_dir():
        raise StudyError(f"{path}: this is a directory; give the study's YAML file")
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        near = [p.name for p in path.parent.glob("*.y*ml")] if path.parent.is_dir() else []
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
        # Before aliases are merged: what a merge brings along may be overwritten.
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


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+$"),
    list("-+.0123456789"),
)

_WAYS_OUT = {
    r"character '\t'": "indent with spaces, not with tabs",
    "stands twice": "",
    "none of a text file": "delete it",
    "undefined alias": "mark the repeated part with & further up, or correct its name",
    "found duplicate anchor": "give every & a name of its own",
    "could not determine a constructor": "leave the tag out",
    "unhashable": "a key must be a single word",
}


def _explain(error: yaml.YAMLError, text: str) -> str:
    """Return line, problem and way out of what YAML complains about."""
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


def digest(part: object) -> str:
    """Return the SHA-256 of a slice of a description, order of keys excepted."""
    text = json.dumps(part, sort_keys=True, default=_plain)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _plain(part: object) -> object:
    if isinstance(part, Part):
        return part.model_dump(mode="json")
    if isinstance(part, set):
        return sorted(part)
    raise TypeError(f"cannot digest {type(part).__name__}")
