"""How far repeats and laboratories of the study of pine differ: a table of docs/measured_pine.md.

    python benchmarks/wood_scatter.py [config/pine.yaml]

Of each signal: the root mean square difference between two repeats, the least and the largest, over
the time that both have. Of boards of the same flux: that between the mean masses of two
laboratories, as shares of the initial mass.
"""

import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.config import Study, read_study
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.reading import read_all

POINTS = 300
BOARDS = (("tifp_30", "aalto_30"), ("tifp_60", "aalto_60"))
Records = dict[tuple[str, str], pd.DataFrame]


def on_common_times(frames: list[pd.DataFrame], column: str) -> list[FloatArray]:
    """Return the records at the same times."""
    time = np.linspace(0.0, min(float(f["time_s"].iloc[-1]) for f in frames), POINTS)
    return [np.interp(time, f["time_s"], f[column]) for f in frames]


def rms(one: FloatArray, other: FloatArray) -> float:
    """Return the root mean square difference."""
    return float(np.sqrt(np.mean((one - other) ** 2)))


def repeats(study: Study, records: Records) -> dict[tuple[str, str], list[str]]:
    """Return the experiments that repeat a test, by test and signal."""
    found: dict[tuple[str, str], list[str]] = {}
    for name, signal in records:
        repeat = study.experiments[name].repeat
        if repeat is not None:
            found.setdefault((repeat.test, signal), []).append(name)
    return found


def between_repeats(study: Study, records: Records) -> list[str]:
    """Return a line of Markdown for each signal of a repeated test."""
    lines = ["| test | signal | least | largest |", "|---|---|---|---|"]
    for (test, signal), names in repeats(study, records).items():
        column = study.experiments[names[0]].quantity(signal).column
        curves = on_common_times([records[name, signal] for name in names], column)
        apart = [rms(a, b) for a, b in combinations(curves, 2)]
        lines.append(f"| {test} | {signal} | {min(apart):.3g} | {max(apart):.3g} |")
    return lines


def between_laboratories(study: Study, records: Records) -> list[str]:
    """Return a line for each flux at which two laboratories tested boards."""
    names = repeats(study, records)
    lines = []
    for pair in BOARDS:
        frames = [[records[n, "mass"] for n in names[test, "mass"]] for test in pair]
        curves = on_common_times([f for of in frames for f in of], "mass_kg_m2")
        shares = [curve / curve[0] for curve in curves]
        count = len(frames[0])
        apart = rms(np.mean(shares[:count], axis=0), np.mean(shares[count:], axis=0))
        lines.append(f"{' and '.join(pair)}: {apart:.3f} of the initial mass")
    return lines


if __name__ == "__main__":
    described = read_study(Path(sys.argv[1] if len(sys.argv) > 1 else "config/pine.yaml"))
    measured = {key: frame for key, (frame, _) in read_all(described).items()}
    print("\n".join([*between_repeats(described, measured), ""]))
    print("\n".join(between_laboratories(described, measured)))
