"""How far laboratories differ in TGA of PMMA: see docs/measured_pmma.md.

    python benchmarks/tga_scatter.py

Reads tests at 10 K/min in nitrogen below ``PYROFIT_DATA_DIR``. Of each laboratory: the median of
its repeats. Between laboratories: the root mean square standard deviation of the mass fraction,
as measured and with the curves aligned at half of the mass.
"""

import os
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.solver.arrays import FloatArray

FOLDER = "PMMA/Calibration_Data"
LABORATORIES = ("FSRI", "HKPoly", "TIFP", "UMD", "UMET")
RANGE_K = (400.0, 710.0)
AROUND_HALF_K = (-200.0, 60.0)
EMPTY = 0.05
"""Largest mass fraction at the end: records that end above it are no single decomposition."""


def record(path: Path) -> tuple[FloatArray, FloatArray]:
    """Return temperature [K] and mass over that at the start of the range."""
    table = pd.read_csv(path, encoding="latin-1", low_memory=False)
    numbers = table.apply(pd.to_numeric, errors="coerce").dropna(how="all", axis=1).dropna()
    _, T, m = numbers.to_numpy()[:, :3].T
    return T, m / np.interp(RANGE_K[0], T, m)


def of_laboratory(folder: Path, T: FloatArray) -> FloatArray:
    """Return the median mass fraction of a laboratory's repeats at temperatures."""
    files = sorted(folder.glob("*_TGA_N2_10K*.csv"))
    curves = np.array([np.interp(T, *record(path)) for path in files])
    return np.asarray(np.median(curves[curves[:, -1] < EMPTY], axis=0))


def scatter(curves: FloatArray) -> float:
    """Return the root mean square over points of the standard deviation of curves."""
    return float(np.sqrt(np.mean(np.var(curves, axis=0, ddof=1))))


if __name__ == "__main__":
    below = Path(os.environ["PYROFIT_DATA_DIR"]) / FOLDER
    at = np.arange(RANGE_K[0], RANGE_K[1] + 1.0)
    found = np.array([of_laboratory(below / name, at) for name in LABORATORIES])

    def temperature(curve: FloatArray, fraction: float) -> float:
        return float(np.interp(-fraction, -curve, at))

    half = [temperature(curve, 0.5) for curve in found]
    for name, curve, middle in zip(LABORATORIES, found, half, strict=True):
        width = temperature(curve, 0.2) - temperature(curve, 0.8)
        print(f"{name}: half of the mass is lost at {middle:.1f} K, 80 to 20 % in {width:.0f} K")
    about = np.arange(*AROUND_HALF_K)
    aligned = [np.interp(x + about, at, curve) for x, curve in zip(half, found, strict=True)]
    print(f"standard deviation of the temperature {np.std(half, ddof=1):.1f} K")
    print(f"of the mass fraction, as measured {scatter(found):.3f}")
    print(f"of the mass fraction, aligned {scatter(np.array(aligned)):.3f}")
