"""Studies from their files, and digests of their parts."""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from pyrofit.config.check.diagnosis import check_diagnosis
from pyrofit.config.check.known import check_known
from pyrofit.config.check.programs import check_programs
from pyrofit.config.check.study import check_study
from pyrofit.config.expand.derived import hold_fixed, with_expressions
from pyrofit.config.expand.effects import apply_effects
from pyrofit.config.expand.programs import with_programs, with_units
from pyrofit.config.expand.repeats import expand_repeats
from pyrofit.config.expand.samples import with_samples
from pyrofit.config.expand.tables import with_tables
from pyrofit.config.keys.study import Study, is_own
from pyrofit.config.words import in_plain_words, refuse_booleans
from pyrofit.config.yaml_file import read_mapping
from pyrofit.errors import StudyError
from pyrofit.model.base import Part
from pyrofit.plugins import use_plugins


def as_study(given: Mapping[str, Any], source: str, located: bool = False) -> Study:
    """Check a study description.

    Files of the user are found relative to the folder of a YAML ``source``. In JSON, which the
    workflow wrote of a checked study, they are found already, as in keys that are ``located``. From
    then on the study's plugins are known, those of a study read before are not.

    Raises
    ------
    StudyError
        With source, key, rule and way out for everything that is wrong.
    """
    path = Path(source)
    folder = None if located or path.suffix == ".json" else path.parent
    try:
        refuse_booleans(given)
        use_plugins([(folder or Path()) / name for name in plugins_of(given)])
        given = hold_fixed(expand_repeats(with_samples(given)))
        given = with_tables(given, folder or Path())
        study = with_programs(Study.model_validate(apply_effects(given)), folder)
        check_programs(study)
        study = with_expressions(with_units(study))
        check_study(study)
        check_diagnosis(study)
        check_known(study)
    except ValidationError as error:
        lines = in_plain_words(error, given)
    except ValueError as error:
        lines = [str(error)]
    except RecursionError:
        lines = [
            "an anchor (&) is used inside itself (*), or an expression is too long; write it out"
        ]
    else:
        return study if folder is None else _located(study, folder)
    rules = "a rule" if len(lines) == 1 else f"{len(lines)} rules"
    text = "".join(f"\n  {line}" for line in lines)
    raise StudyError(f"{source}: the study description breaks {rules}:{text}")


def plugins_of(given: Mapping[str, Any]) -> list[str]:
    """Return the folders of a study's plugins; none where they are no list of names."""
    names = given.get("plugins")
    if not isinstance(names, list | tuple):
        return []  # the checks of the study report the error
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
