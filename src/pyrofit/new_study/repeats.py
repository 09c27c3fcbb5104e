"""Files that are repeats of one test, by their names."""

import re
from collections.abc import Sequence
from dataclasses import replace

from pyrofit.new_study.draft import MeasuredFile

_REPEAT = re.compile(r"_(?:r|rep|repeat|run|test)?_?\d{1,2}$", re.IGNORECASE)


def root_of(name: str) -> str:
    """Return the name of a file without the number of a repeat.

    >>> root_of("UMD_TGA_N2_10K_R2"), root_of("slab_50kW_3"), root_of("slab_50kW")
    ('UMD_TGA_N2_10K', 'slab_50kW', 'slab_50kW')
    """
    return _REPEAT.sub("", name)


def grouped_by_names(records: Sequence[MeasuredFile]) -> list[MeasuredFile]:
    """Return the tests: files whose names differ in a number at the end alone are repeats of one.

    They must be of one kind and have the same heating rate or flux, which must be known. A test
    has the signals of all its repeats.

    >>> one = [MeasuredFile("tga", f"a_10K_{end}", None, 10.0) for end in ("R1", "R2")]
    >>> [test.name for test in grouped_by_names([*one, MeasuredFile("tga", "a_20K_1", None, 20.0)])]
    ['a_10K', 'a_20K_1']
    """
    alike: dict[tuple[str, str, float], list[MeasuredFile]] = {}
    for run in records:
        root = root_of(run.name) if run.told else run.name
        alike.setdefault((run.kind, root, run.number), []).append(run)
    roots = [root for _, root, _ in alike]
    taken = {run.name for run in records}
    tests = []
    for (_, root, _), runs in alike.items():
        free = root not in taken and roots.count(root) == 1
        tests += [_test(root, runs)] if len(runs) > 1 and free else runs
    return tests


def _test(name: str, runs: Sequence[MeasuredFile]) -> MeasuredFile:
    signals = {found.signal: found for run in reversed(runs) for found in run.signals}
    order = {found.signal: None for run in runs for found in run.signals}
    return replace(
        runs[0],
        name=name,
        signals=tuple(signals[signal] for signal in order),
        repeats=tuple(runs),
    )
