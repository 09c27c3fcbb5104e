"""Time the functions that other optimisers and samplers call: three TGA records of 450 points.

Run: python benchmarks/objective.py
"""

import time

import numpy as np

import pyrofit as pf

POINTS, CALLS, SETS = 450, 300, 256


def main() -> None:
    """Print the median time of a call, and that of a set of a table."""
    T = np.linspace(400.0, 850.0, POINTS)
    rng, records = np.random.default_rng(0), {}
    for rate in (5.0, 10.0, 20.0):
        mass = 0.05 + 0.95 / (1.0 + np.exp((T - 620.0 - 15.0 * np.log(rate)) / 15.0))
        noisy = mass + rng.normal(0.0, 0.003, POINTS)
        records[f"tga_{rate:g}K"] = np.column_stack([60.0 / rate * (T - T[0]), T, noisy])
    study = pf.new_study("objective", tga=records)
    every = list(records)  # also the rate that a new study holds out
    for name, make in (("residuals", pf.residuals), ("log_likelihood", pf.log_likelihood)):
        function = make(study, records, signals=every)
        middle, span = function.limits.mean(axis=1), np.ptp(function.limits, axis=1)
        X = middle + 0.01 * span * rng.standard_normal((SETS, len(middle)))
        function(X), function(X[0])  # the first call compiles
        times = [timed(function, X[i % SETS]) for i in range(CALLS)]
        print(f"{name}: {np.median(times):.2f} ms a call, {timed(function, X) / SETS:.2f} ms a set")


def timed(function: object, values: np.ndarray) -> float:
    """Return the time of a call [ms]."""
    start = time.perf_counter()
    function(values)  # type: ignore[operator]
    return 1e3 * (time.perf_counter() - start)


if __name__ == "__main__":
    main()
