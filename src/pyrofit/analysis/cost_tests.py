"""Whether the cost functions differ: tests over the repetitions of every search."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from pyrofit.analysis import groups
from pyrofit.analysis.uses import SCEUA, title_of, use_of
from pyrofit.config import Study
from pyrofit.results import searches
from pyrofit.results.comparison import read_all_scores
from pyrofit.results.files import Results
from pyrofit.results.identification import estimates
from pyrofit.solver.arrays import FloatArray

SIGNIFICANT = 0.05


NEAR = 0.01
"""A search has converged where its cost is within this share of its final one."""


def cost_tests(study: Study, results: Results) -> pd.DataFrame:
    """Test whether the cost functions differ, in where the repetitions end and how they scatter.

    Places are compared by Kruskal and Wallis's test, scatter by Brown and Forsythe's, each with
    Holm's correction for the number of quantities. Pairs are compared by Mann and Whitney's test
    with Holm's correction for the number of pairs.

    Returns
    -------
    pandas.DataFrame
        One row per quantity: the estimated parameters, the metrics of all repetitions' sets, how
        long the searches take. Medians by cost function; their largest difference, for parameters
        also in per cent of the search range and of the 95 % interval that the data leave.
    """
    rows = []
    tested = list(_samples(study, results))
    for about, samples in tested:
        rows.append({**about, **_medians(samples), **_difference(study, about, samples, results)})
    frame = pd.DataFrame(rows)
    enough = [groups.enough(list(samples.values())) for _, samples in tested]
    if all(enough):
        values = [list(samples.values()) for _, samples in tested]
        places = [groups.location(v) for v in values]
        frame["p_place"] = groups.holm([p for p, _ in places])
        frame["effect"] = [size for _, size in places]
        frame["pairs"] = [
            _pairs(samples) if p <= SIGNIFICANT else ""
            for p, (_, samples) in zip(frame["p_place"], tested, strict=True)
        ]
        frame["scatter_ratio"] = [_scatter_ratio(v) for v in values]
        frame["p_scatter"] = groups.holm([groups.spread_test(v) for v in values])
        frame["verdict"] = [
            _verdict(p, s) for p, s in zip(frame["p_place"], frame["p_scatter"], strict=True)
        ]
    else:
        frame["verdict"] = f"not tested: fewer than {groups.FEWEST} repetitions"
    return frame


def _samples(
    study: Study, results: Results
) -> Iterator[tuple[dict[str, str], dict[str, FloatArray]]]:
    """Yield the quantities, and the values of all repetitions by cost function."""
    costs = list(study.imp.costs)
    summary = searches.best_of_repetitions(study, results)
    for name in study.imp.estimate:
        parameter = study.parameters[name]
        about = {"kind": "parameters", "quantity": name, "unit": parameter.unit}
        yield about, _by_cost(costs, summary, summary[name] / parameter.factor)
    found = read_all_scores(results)
    found = found[found["found_by"] == SCEUA]
    for name in study.validation.experiments:
        experiment = study.experiments[name]
        for signal in experiment.signals:
            metric, quantity = experiment.metric(signal), experiment.quantity(signal)
            here = found[(found["place"] == name) & (found["measure"] == metric)]
            use = {use_of(study, cost, name, signal) for cost in costs}
            said = f"{metric}, {title_of(study, name)} ({', '.join(sorted(use))})"
            about = {
                "kind": "prediction",
                "quantity": said,
                "unit": "-" if quantity.relative else quantity.unit,
            }
            yield about, _by_cost(costs, here, here["value"].astype(float))
    speed = convergence_effort(study, results)
    for column, said in (("generations", "generations"), ("calls", "model calls")):
        about = {"kind": "search", "quantity": f"{said} to within 1 % of the end", "unit": "-"}
        yield about, _by_cost(costs, speed, speed[column])


def _by_cost(costs: list[str], frame: pd.DataFrame, values: pd.Series) -> dict[str, FloatArray]:
    return {cost: values[frame["cost_function"] == cost].dropna().to_numpy(float) for cost in costs}


def convergence_effort(study: Study, results: Results) -> pd.DataFrame:
    """Return after how many generations and model calls each search was near its final cost."""
    frame = searches.running_minima(study, results)
    rows = []
    for (cost, number), run in frame.groupby(["cost_function", "repetition"], sort=False):
        run = run.sort_values("generation", kind="stable")
        near = run[run["best_cost"] <= (1.0 + NEAR) * run["best_cost"].iloc[-1]].iloc[0]
        rows.append(
            {
                "cost_function": cost,
                "repetition": number,
                "generations": int(near["generation"]),
                "calls": int(near["calls"]),
            }
        )
    return pd.DataFrame(rows)


def _medians(samples: dict[str, FloatArray]) -> dict[str, float | None]:
    return {f"median {c}": float(np.median(v)) if v.size else None for c, v in samples.items()}


def _difference(
    study: Study, about: dict[str, str], samples: dict[str, FloatArray], results: Results
) -> dict[str, float | None]:
    medians = [float(np.median(v)) for v in samples.values() if v.size]
    apart = max(medians) - min(medians) if medians else None
    row: dict[str, float | None] = {"difference": apart, "of_limits": None, "of_interval": None}
    if about["kind"] == "parameters" and apart is not None:
        parameter = study.parameters[about["quantity"]]
        lower, upper = (bound / parameter.factor for bound in parameter.bounds_si)
        widths = estimates(study, results)["width"].to_dict()
        width = float(widths[about["quantity"]]) * (upper - lower)
        row["of_limits"] = 100.0 * apart / (upper - lower)
        row["of_interval"] = 100.0 * apart / width if width > 0.0 else None
    return row


def _pairs(samples: dict[str, FloatArray]) -> str:
    """Return the pairs that differ, with Cliff's delta."""
    names = list(samples)
    pairs = [(a, b) for i, a in enumerate(names) for b in names[i + 1 :]]
    found = [groups.pair(samples[a], samples[b]) for a, b in pairs]
    corrected = groups.holm([p for p, _ in found])
    return "; ".join(
        f"{a}–{b} {delta:+.2f}".replace("-", "−")
        for (a, b), (_, delta), p in zip(pairs, found, corrected, strict=True)
        if p <= SIGNIFICANT
    )


def _scatter_ratio(values: list[FloatArray]) -> float | None:
    """Return the largest over the smallest mean distance from the median."""
    sizes = [float(np.mean(np.abs(v - np.median(v)))) for v in values]
    return max(sizes) / min(sizes) if min(sizes) > 0.0 else None


def _verdict(place: float, scatter: float) -> str:
    words = ["place"] * (place <= SIGNIFICANT) + ["scatter"] * (scatter <= SIGNIFICANT)
    return f"differ in {' and '.join(words)}" if words else "no difference shown"
