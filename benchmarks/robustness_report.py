"""Results of the random sets, as a section of docs/benchmarks.md."""

from collections import Counter
from typing import Any

import numpy as np
from boxes import BATCH, DURATION_S, SEED, Case, described
from page import filed, table

from pyrofit.model.accuracy import Accuracy
from pyrofit.simulate import simulate_gasification, simulate_gasifications
from pyrofit.solver.curves import Curves, Request

FAILURES = ("unfinished", "not_a_number")
FOREMOST = 4
"""Number of parameters that are named as causes of the worst sets."""


def summed(state: dict[str, Any]) -> Counter[str]:
    """Return the counts of all boxes together."""
    total: Counter[str] = Counter()
    for case in state["cases"].values():
        total.update(case["counts"])
    total["hung batches"] = len(state["hung"])
    return +total


def corner(rows: list[dict[str, Any]]) -> str:
    """Return where in their boxes sets lie: mean places, 0 to 1, far from the middle."""
    places: dict[str, list[float]] = {}
    for row in rows:
        case = Case(*row["case"].split(" / "))
        for name, (low, high) in described(case)[2].items():
            places.setdefault(name, []).append((row["values"][name] - low) / (high - low))
    far = {
        name: float(np.mean(at))
        for name, at in places.items()
        if len(at) >= 0.1 * len(rows) and abs(np.mean(at) - 0.5) > 0.15
    }
    order = sorted(far.items(), key=lambda item: -abs(item[1] - 0.5))
    return ", ".join(f"{name} {at:.2f}" for name, at in order) or "no corner"


def relieved(rows: list[dict[str, Any]], key: str) -> str:
    """Return which parameters lower a number most, each moved to the middle of its limits alone."""
    ratios: dict[str, list[float]] = {}
    for row in rows:
        case = Case(*row["case"].split(" / "))
        experiment, material, limits = described(case)
        asked = {
            "mlr": Request(np.array([1.0])),
            "back_temperature": Request(np.array([DURATION_S[case.experiment]])),
        }
        values = {name: np.full(len(limits) + 1, value) for name, value in row["values"].items()}
        for k, (name, (low, high)) in enumerate(limits.items()):
            values[name][k + 1] = 0.5 * (low + high)
        first, *others = simulate_gasifications(
            experiment, material, values, asked, sets=len(limits) + 1
        )
        for name, run in zip(limits, others, strict=True):
            if first.status.finished and run.status.finished:
                ratio = _number(run, key) / max(_number(first, key), 1e-300)
                ratios.setdefault(name, []).append(ratio)
    often = {n: float(np.median(r)) for n, r in ratios.items() if len(r) >= 0.1 * len(rows)}
    most = sorted(often.items(), key=lambda item: item[1])[:FOREMOST]
    return ", ".join(f"{name} × {ratio:.2f}" for name, ratio in most)


def _number(run: Curves, key: str) -> float:
    return float(run.cells * run.steps if key == "cell_steps" else getattr(run, key))


def refined(rows: list[dict[str, Any]]) -> str:
    """Return how the largest energy errors change with twice the cells and half the steps."""
    found = []
    for row in rows:
        case = Case(*row["case"].split(" / "))
        experiment, material, _ = described(case)
        asked = {"mass": Request(np.array([DURATION_S[case.experiment]]))}
        pair = [
            simulate_gasification(experiment, material, row["values"], asked, accuracy).energy_error
            for accuracy in (Accuracy(), Accuracy().refined())
        ]
        found.append((*pair, pair[0] / pair[1]))
    coarse, fine, ratio = np.array(found).T
    return (
        f"The {len(rows)} sets with the largest energy errors were simulated again with twice the "
        f"cells and half the steps. The largest error falls from {coarse.max():.2g} to "
        f"{fine.max():.2g}. Each error falls by a factor of {np.median(ratio):.1f} (median; "
        f"smallest factor {ratio.min():.1f})."
    )


def page(state: dict[str, Any]) -> str:
    """Return the section of docs/benchmarks.md."""
    sets = sum(case["sets"] for case in state["cases"].values())
    seconds = sum(case["seconds"] for case in state["cases"].values())
    counts = [(name.lower(), f"{n:,}") for name, n in sorted(summed(state).items())]
    rows = []
    for key, found in state["worst"].items():
        if found:
            of = Counter(row["case"] for row in found).most_common(2)
            most = f"{found[0][key]:.3g}"
            where = "; ".join(f"{name} ({n})" for name, n in of)
            words = key.replace("_", " ")
            lowered = "" if key in FAILURES else relieved(found, key)
            rows.append((words, most, len(found), where, corner(found), lowered))
    boxes = len(state["cases"])
    head = ("by", "worst", "sets", "mostly of", "mean place", "lowered by")
    worst = filed("robustness_worst", "A table", head, rows)
    return "\n\n".join(
        [
            f"{sets:,} sets were drawn from {boxes} boxes. A box has the limits of "
            "`config/paper.yaml` (Table 3 kinetics, or kinetics within their limits) or of "
            "`config/pmma.yaml`, at 25 or 60 kW/m². It has no effect or one effect of the "
            "catalogue, within its limits. "
            f"Seed {SEED}, default accuracy, batches of {BATCH}; {seconds:.0f} s of run time on "
            "a busy machine. Every other round asks for all signals, so that runs go on after "
            "burn-out. The energy error is heat stored and used minus heat through the surfaces, "
            "over the heat that crossed the surfaces. The heat through the surfaces is "
            "integrated with the weights of the time stepping formula.",
            "*ok*: the sample has burnt out. *unburnt*: reactant was left at the end.",
            table(("how it ended", "sets"), counts),
            f"{worst} lists the worst sets, at most a hundred of each kind. *Mean place* is the "
            "place in the box (0 lower, 1 upper limit) of parameters far from the middle. For the "
            "last column, one parameter alone is moved to the middle of its limits. It gives the "
            "median factor for the parameters that lower the number most. The worst of many sets "
            "improve with any change, so only the order of the parameters is meaningful.",
            refined(state["worst"]["energy_error"]),
            "Command: `python benchmarks/robustness.py FOLDER --sets 1000000`, then `--page`.",
        ]
    )
