"""Studies from YAML, and digests of their parts."""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from pyrofit.config.study import Study, is_own
from pyrofit.config.words import as_meant, in_plain_words
from pyrofit.errors import StudyError, suggest
from pyrofit.model.base import Part


def as_study(given: Mapping[str, Any], source: str) -> Study:
    """Check a study description.

    Files of the user are found relative to the folder of a YAML ``source``. JSON is what the
    workflow wrote of a study once checked: there they are found already.

    Raises
    ------
    StudyError
        With source, key, rule and way out for everything that is wrong.
    """
    try:
        meant = as_meant(given)
        study = Study.model_validate(meant)
    except ValidationError as error:
        lines = in_plain_words(error, meant)
    except ValueError as error:
        lines = [str(error)]
    else:
        path = Path(source)
        return study if path.suffix == ".json" else _located(study, path.parent)
    rules = "a rule" if len(lines) == 1 else f"{len(lines)} rules"
    text = "".join(f"\n  {line}" for line in lines)
    raise StudyError(f"{source}: the study description breaks {rules}:{text}")


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
    return study.model_copy(update={"experiments": experiments})


def read_study(path: Path) -> Study:
    """Read a study from a YAML or JSON file.

    Raises
    ------
    StudyError
        The file is missing, a directory, not YAML, or breaks a rule.
    """
    if path.is_dir():
        raise StudyError(f"{path}: this is a directory; give the study's YAML file")
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        near = [p.name for p in path.parent.glob("*.y*ml")] if path.parent.is_dir() else []
        hint = f" {suggest(path.name, near)}" if near else ""
        raise StudyError(f"{path}: there is no such study file.{hint}") from None
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{path}: cannot be read ({error}); check the file") from None
    try:
        given = json.loads(text) if path.suffix == ".json" else yaml.safe_load(text)
    except (yaml.YAMLError, json.JSONDecodeError) as error:
        raise StudyError(f"{path}: not valid {path.suffix[1:]}: {error}") from None
    if not isinstance(given, dict):
        what = (
            "this file is empty" if given is None else f"this is {_KIND.get(type(given), 'text')}"
        )
        raise StudyError(f"{path}: a study is a mapping of keys; {what}")
    return as_study(given, str(path))


_KIND = {list: "a list", int: "a number", float: "a number", bool: "true or false"}


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
