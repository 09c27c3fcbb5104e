"""Facts that the files of a new study tell, such as the time of ignition."""

from collections.abc import Mapping, Sequence
from typing import Any

from pyrofit.experiments import files_of
from pyrofit.new_study.draft import MeasuredFile


def facts_of(runs: Sequence[MeasuredFile]) -> dict[str, Mapping[str, Any]]:
    """Return the facts that files tell, by experiment.

    A slab that has none takes that of another slab of its kind and number, which may be a record of
    the same test. A heated sample whose temperature is not held has none to take.
    """
    own = {run.name: files_of(run.kind).facts(run.frames) for run in runs}
    known: dict[tuple[str, float, str], Any] = {}
    for run in runs:
        for key, fact in own[run.name].items():
            if fact is not None and run.told and run.of.stage == "imp":
                known.setdefault((run.kind, run.number, key), fact)
    return {
        run.name: {
            key: known.get((run.kind, run.number, key)) if fact is None and run.told else fact
            for key, fact in own[run.name].items()
        }
        for run in runs
    }
