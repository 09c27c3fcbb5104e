"""How often the test of a fit is wrong, and how often intervals hold the truth.

    python benchmarks/fit_test.py OUT.csv --twins 300

draws TGA at 5, 10 and 20 K/min with white noise of the points and the lasting errors of an
apparatus. One reaction of first order is fitted to the outer two rates; `pyrofit init` holds out
the middle one. A row is appended for each fit. Five truths take turns:

right
    One reaction of first order.
lasting
    The same, and one record is off by three standard deviations of its whole noise for a third of
    it.
smooth
    The same, with an error of sin^2 over that third, four standard deviations at its height.
order
    One reaction of order 1.5.
two
    Two reactions of equal E, 40 K apart.

The table counts fits that are said to describe the tests, and 95 % intervals that hold the true E.
Twins whose record that is off is held out do not count.
"""

import argparse
import csv
import warnings
from pathlib import Path

import numpy as np
import pandas as pd

import pyrofit as pf
from pyrofit.estimate.apparatus import LASTING
from pyrofit.solver.arrays import FloatArray

RATES = (5.0, 10.0, 20.0)
KINDS = ("right", "lasting", "smooth", "order", "two")
OFF = ("lasting", "smooth")
HELD_OUT = 1
POINTS = 120
DRIFT = 0.003
"""Lasting error of the mass fraction that pyrofit assumes, over 10 % of a record."""
SHIFT_K = 1.0
"""Error of the temperature that pyrofit assumes."""
COLUMNS = (
    "twin",
    "kind",
    "seen",
    "noise",
    "E",
    "low",
    "high",
    "verdict",
    "p",
    "describes",
    "holds",
)


def mass(T: FloatArray, rate: float, E: float, at: float, order: float) -> FloatArray:
    """Return the mass fraction of a reaction with k(at) = 0.001 1/s, on a fine grid."""
    fine = np.linspace(T[0] - 2.0, T[-1] + 2.0, 8000)
    k = 1e-3 * np.exp(-E / 8.314462618 * (1.0 / fine - 1.0 / at)) * 60.0 / rate
    x = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1]) * np.diff(fine))])
    left = np.exp(-x) if order == 1.0 else (1.0 + (order - 1.0) * x) ** (1.0 / (1.0 - order))
    return np.interp(T, fine, left)


def records(
    kind: str, E: float, at: float, sd: float, rng: np.random.Generator
) -> tuple[dict[str, pd.DataFrame], int]:
    """Return one record for each rate, and the position of the one that may be off."""
    found, off = {}, int(rng.integers(len(RATES)))
    for k, rate in enumerate(RATES):
        T = np.linspace(at - 150.0, at + 150.0, POINTS)
        parts = (at - 20.0, at + 20.0) if kind == "two" else (at,)
        order = 1.5 if kind == "order" else 1.0
        true_T = T + SHIFT_K * rng.standard_normal()
        clean = np.mean([mass(true_T, rate, E, one, order) for one in parts], axis=0)
        index = np.arange(POINTS)
        scale = LASTING * (POINTS - 1)
        lasting = np.exp(-np.abs(np.subtract.outer(index, index)) / scale)
        drift = DRIFT * np.linalg.cholesky(lasting) @ rng.standard_normal(POINTS)
        value = clean + drift + sd * rng.standard_normal(POINTS)
        if kind in OFF and k == off:
            slope = np.gradient(clean, T)
            total = np.sqrt(sd**2 + DRIFT**2 + (SHIFT_K * slope) ** 2)
            first = rng.integers(POINTS // 3, POINTS // 2)
            third = slice(first, first + POINTS // 3)
            hump = 4.0 * np.sin(np.linspace(0.0, np.pi, POINTS // 3)) ** 2
            value[third] += total[third] * (3.0 if kind == "lasting" else hump)
        time = (T - T[0]) * 60.0 / rate
        columns = {"time_s": time, "temperature_K": T, "mass_fraction": value}
        found[f"tga_{rate:g}K"] = pd.DataFrame(columns)
    return found, off


def row(twin: int) -> dict[str, object]:
    """Draw a twin, fit it, and return what was found."""
    rng = np.random.default_rng([46, twin])
    kind = KINDS[twin % len(KINDS)]
    E, at, sd = rng.uniform(130e3, 240e3), rng.uniform(560.0, 640.0), rng.uniform(3e-4, 3e-3)
    data, off = records(kind, E, at, sd, rng)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        study = pf.new_study("twin", tga=data)
    fit = pf.fit(study, data, starts=6)
    found = fit.table.loc["E_p"]
    low, high = float(found["low"]), float(found["high"])
    return {
        "twin": twin,
        "kind": kind,
        "seen": kind not in OFF or off != HELD_OUT,
        "noise": sd,
        "E": E / 1e3,
        "low": low,
        "high": high,
        "verdict": found["verdict"],
        "p": fit.goodness.p,
        "describes": fit.goodness.describes,
        "holds": low <= E / 1e3 <= high,
    }


def summary(table: pd.DataFrame) -> str:
    """Return the counts by kind, as a table in Markdown."""
    lines = ["| truth | twins | describes the tests | interval holds E |", "|---|--:|--:|--:|"]
    for kind in KINDS:
        of = table[(table["kind"] == kind) & table["seen"]]
        lines.append(f"| {kind} | {len(of)} | {of['describes'].sum()} | {of['holds'].sum()} |")
    return "\n".join(lines)


def main() -> None:
    """Fit the twins that the table does not have yet."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--twins", type=int, default=300)
    given = parser.parse_args()
    done = len(pd.read_csv(given.out)) if given.out.exists() else 0
    for twin in range(done, given.twins):
        with given.out.open("a", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS)
            if twin == 0:
                writer.writeheader()
            writer.writerow(row(twin))
    print(summary(pd.read_csv(given.out)))


if __name__ == "__main__":
    main()
