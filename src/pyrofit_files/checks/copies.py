"""Values that stand in two files."""

from collections.abc import Sequence

import numpy as np

from pyrofit_files.examined import Examined, FloatArray

_RUN = 12
"""Values in succession that no two tests share by chance, where most of them differ."""


def check_copies(files: Sequence[Examined]) -> None:
    """Look for signals of two tests that are the same from the start on, or up to the end."""
    starts: dict[tuple[object, ...], tuple[Examined, FloatArray]] = {}
    ends: dict[tuple[object, ...], tuple[Examined, FloatArray]] = {}
    for seen in files:
        for name, signal in seen.signals.items():
            y = signal.y
            if y.size < 3 * _RUN:
                continue
            for known, run, words in ((starts, y[:_RUN], "first"), (ends, y[-_RUN:], "last")):
                if np.unique(run).size < _RUN - 4:
                    continue
                key = (name, signal.quantity, *run.tolist())
                if key not in known:
                    known[key] = seen, y
                elif not _said(seen, known[key][0]):
                    _say(seen, signal.header, y, *known[key], words)


def _said(seen: Examined, other: Examined) -> bool:
    name = other.path.name
    return any(f.check == "copy" and f" {name}" in f.text for f in seen.findings)


def _say(
    seen: Examined, header: str, y: FloatArray, other: Examined, theirs: FloatArray, end: str
) -> None:
    mine, others = (y, theirs) if end == "first" else (y[::-1], theirs[::-1])
    size = min(mine.size, others.size)
    differ = np.flatnonzero(mine[:size] != others[:size])
    same = int(differ[0]) if differ.size else size
    if same == y.size == theirs.size:
        text = f"all {same} values are those of {other.path.name}"
    else:
        text = f"the {end} {same} of {y.size} values are those of {other.path.name}"
    seen.say("copy", "fault", text, header)
