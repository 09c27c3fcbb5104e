"""The study of a run: written by the process that starts it, read by all others."""

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pyrofit.config import Study, as_study, digest, read_mapping
from pyrofit.errors import StudyError
from pyrofit.results.files import write_text

FROZEN = "PYROFIT_STUDY"
"""Environment variable that passes digest and file of the frozen study to jobs."""
MOST_NAMED = 5


def freeze(study: Study, path: Path) -> None:
    """Write the study, every key completed, and pass its place to jobs by `FROZEN`.

    Raises
    ------
    DataError
        The file cannot be written.
    """
    whole = study.model_dump(mode="json")
    text = json.dumps(whole, indent=1) + "\n"
    if not path.exists() or path.read_bytes() != text.encode():
        write_text(path, text)
    os.environ[FROZEN] = f"{digest(whole)} {path}"


def frozen_study(given: dict[str, Any], source: str) -> Study:
    """Return the study that the run of this job was started with.

    Parameters
    ----------
    given, source
        The study as its file now says, and the name of the file. They are used only if the
        environment of the run did not reach this job: the study must then equal the frozen one.

    Raises
    ------
    StudyError
        The frozen study is missing or was changed, or the study file differs from it.
    """
    told = os.environ.get(FROZEN)
    if told is None:
        return _unchanged(as_study(given, source), source)
    expected, _, name = told.partition(" ")
    kept = as_study(read_mapping(Path(name)), name)
    if digest(kept.model_dump(mode="json")) != expected:
        raise StudyError(
            f"{name}: this is not the study '{kept.name}' that the run was started with; only the "
            "start of a run writes this file. Run it again"
        )
    return kept


def _unchanged(study: Study, source: str) -> Study:
    path = Path("results") / study.name / "study.json"
    kept, now = read_mapping(path), study.model_dump(mode="json")
    changed = list(changed_places(kept, json.loads(json.dumps(now))))
    if changed:
        more = "" if len(changed) <= MOST_NAMED else f" and {len(changed) - MOST_NAMED} more"
        raise StudyError(
            f"{source}: changed while the workflow runs: {', '.join(changed[:MOST_NAMED])}{more}. "
            f"This run is of {path}; undo the change, or stop the run and start it again"
        )
    return study


def changed_places(one: Any, other: Any, place: str = "") -> Iterator[str]:
    """Yield the places of all values in which two studies differ.

    >>> one, other = {"seed": 7, "imp": {"costs": [1, 2]}}, {"seed": 8, "imp": {"costs": [1]}}
    >>> list(changed_places(one, other))
    ['seed', 'imp.costs']
    """
    if isinstance(one, dict) and isinstance(other, dict):
        for key in dict.fromkeys([*one, *other]):
            yield from changed_places(
                one.get(key), other.get(key), f"{place}.{key}".removeprefix(".")
            )
    elif one != other:
        yield place
