"""Files of a new study that hold the numbers of another: the study leaves one of both out."""

from collections.abc import Sequence

from pyrofit.analysis.copied_records import numbers_of
from pyrofit.data.copies import copies, is_copy
from pyrofit.new_study.draft import MeasuredFile
from pyrofit.new_study.words import other_number
from pyrofit.quantities import known_quantities


def without_copies(records: Sequence[MeasuredFile]) -> tuple[list[MeasuredFile], list[str]]:
    """Return the records without those that repeat the numbers of another, and lines on them.

    Of two, that is left out whose name tells another heating rate or flux than its record, else the
    second. A file of which one signal alone is a copy stays, and is told.
    """
    series = [(run, name, frame) for run in records for name, frame in run.frames.items()]
    columns = {name: known_quantities()[name].column for _, name, _ in series}
    values = [(name, frame[columns[name]].to_numpy(float)) for _, name, frame in series]
    shared: dict[tuple[str, str], dict[str, str]] = {}
    for found in copies(values):
        (run, name, frame), (other, _, theirs) = series[found.position], series[found.of]
        if run is not other and found.most and is_copy(found, frame, theirs):
            said = numbers_of(found, known_quantities()[name], frame, theirs)
            shared.setdefault((run.name, other.name), {}).setdefault(name, said)
    by_name = {run.name: run for run in records}
    left, lines = set(), []
    for names, copied in shared.items():
        second, first = (by_name[name] for name in names)
        wrong = next((run for run in (first, second) if other_number(run)), second)
        beginning = f"{second.path}: " + "; ".join(f"{s} {first.path}" for s in copied.values())
        if set(copied) == set(wrong.frames):
            left.add(wrong.name)
            lines.append(f"{beginning}. {wrong.name} is left out; give one of both to choose it")
        else:
            lines.append(f"{beginning}. Look which one is right")
    return [run for run in records if run.name not in left], lines
