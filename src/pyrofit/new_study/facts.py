"""Facts that the files of a new study tell, such as the time of ignition."""

from collections.abc import Mapping, Sequence
from typing import Any

from pyrofit.experiments import files_of
from pyrofit.new_study.draft import MeasuredFile


def facts_of(runs: Sequence[MeasuredFile]) -> dict[str, Mapping[str, Any]]:
    """Return the facts that files tell, by experiment.

    One that has none takes that of another experiment of its kind and number, which may be a
    record of the same test.
    """
    own = {run.name: files_of(run.kind).facts(run.frames) for run in runs}
    known: dict[tuple[str, float, str], Any] = {}
    for run in runs:
        for key, fact in own[run.name].items():
            if fact is not None and run.told:
                known.setdefault((run.kind, run.number, key), fact)
    return {
        run.name: {
            key: known.get((run.kind, run.number, key)) if fact is None and run.told else fact
            for key, fact in own[run.name].items()
        }
        for run in runs
    }
