"""Robustness of the cost functions: table and figure, and a section of the report."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis import groups
from pyrofit.analysis.cost_tests import SIGNIFICANT
from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.page import page_of_step
from pyrofit.show.table import Row, Table
from pyrofit.show.text import listed
from pyrofit.steps.robustness.twins import NOISE, OUTLIERS, RECOVERED, errors_of_twins, recovered


def robustness_table(study: Study, results: Results) -> pd.DataFrame:
    """List the errors by disturbance and cost function.

    Returns
    -------
    pandas.DataFrame
        One row per kind, level and cost function. Its columns are medians over the draws of the
        error of all parameters and of the prediction. The error of each parameter is a root mean
        square in per cent of its limits. The p is Kruskal and Wallis's for errors of the cost
        functions at the same place, Holm-corrected for the number of levels.
    """
    frame = errors_of_twins(study, results)
    names = list(study.imp.estimate)
    rows: list[Row] = []
    for (kind, level, cost), part in frame.groupby(["kind", "level", "cost_function"], sort=False):
        predicted = part["prediction_error"].astype(float)
        rows.append(
            {
                "added": _words(kind, level),
                "cost_function": cost,
                "twins": len(part),
                "error_percent": float(part["error"].median()),
                "prediction_percent": 100.0 * float(predicted.median()),
                **{
                    f"{n} [% of search range]": float(np.sqrt(np.mean(part[n] ** 2))) for n in names
                },
            }
        )
    table = pd.DataFrame(rows)
    order = list(dict.fromkeys(table["added"]))
    table = table.iloc[np.argsort(table["added"].map(order.index), kind="stable")]
    return table.merge(_tests(frame), on="added", how="left")


def _tests(frame: pd.DataFrame) -> pd.DataFrame:
    """Return p of each level, empty with too few twins."""
    words, found = [], []
    for (kind, level), part in frame.groupby(["kind", "level"], sort=False):
        samples = [p["error"].to_numpy(float) for _, p in part.groupby("cost_function")]
        words.append(_words(kind, level))
        found.append(groups.location(samples)[0] if groups.enough(samples) else None)
    known = [p for p in found if p is not None]
    corrected = iter(groups.holm(known))
    p = [None if p is None else next(corrected) for p in found]
    return pd.DataFrame({"added": words, "p": p})


def _words(kind: Any, level: Any) -> str:
    """Return the words for a disturbance.

    >>> _words("noise", 3.0), _words("outliers", 0.05)
    ('noise × 3', 'outliers, 5 % of the points')
    """
    return f"noise × {level:g}" if kind == NOISE else f"outliers, {100.0 * level:g} % of the points"


TABLE = Table(
    place=60,
    make=robustness_table,
    title="Robustness of the cost functions on twins of known truth",
    note="Twins: curves of the model itself with white noise. Its standard deviation is "
    "that of the measurement times the number given. Some twins have outliers as "
    "well, up or down by a share of the signal's range. Fitted by least squares from "
    "random starts. Error: root mean square over the parameters, in per cent of their "
    "limits, median over the twins. Left out are parameters that no cost function "
    f"recovers within {RECOVERED:g} % at the least noise. Prediction: CV(RMSE) of the "
    "mass loss rate at the held-out experiments against the truth. p: Kruskal and "
    "Wallis's test of equal errors of the cost functions, Holm-corrected.",
    headings={
        "cost_function": "cost function",
        "error_percent": "error [% of search range]",
        "prediction_percent": "prediction [%]",
    },
    group_by="added",
)


_ASIDE = 0.14
"""Distance of the cost functions' marks at one level, in levels."""


_LABELS = {NOISE: "noise, multiple of the measurement's", OUTLIERS: "outliers [% of points]"}


_MARKERS = "oDs^vp"


def draw_robustness(study: Study, results: Results) -> Canvas:
    """Draw the errors of parameters and predictions against noise and outliers."""
    frame = errors_of_twins(study, results)
    frame["prediction"] = 100.0 * frame["prediction_error"].astype(float)
    held_out = bool(frame["prediction"].notna().any())
    shown = [("error", "error of the recovered\nparameters [% of search range]")]
    shown += [("prediction", "error of the prediction\n[CV(RMSE), %]")] if held_out else []
    canvas, axes = style.panels(2 * len(shown), 2, style.TWO_COLUMNS, 55.0)
    style.letter(axes, ["noise", "outliers"] * len(shown))
    for row, (column, label) in enumerate(shown):
        for side, kind in enumerate((NOISE, OUTLIERS)):
            ax = axes[2 * row + side]
            _draw(ax, study, frame[frame["kind"] == kind], column)
            ax.set_xlabel(_LABELS[kind])
        axes[2 * row].set_ylabel(label)
    looks = style.cost_styles(study)
    entries: list[Any] = [
        style.line(cost, color=look["color"], marker=_MARKERS[i % 6], markersize=4.0)
        for i, (cost, look) in enumerate(looks.items())
    ]
    entries.append(style.line("one twin", color="0.5", linestyle="none", marker="."))
    style.legend_below(canvas, entries)
    canvas.suptitle("Twins of known truth (synthetic data)")
    return canvas


def _draw(ax: Axes, study: Study, frame: pd.DataFrame, column: str) -> None:
    levels = sorted(frame["level"].unique())
    costs = style.cost_styles(study)
    for i, (cost, look) in enumerate(costs.items()):
        here = frame[frame["cost_function"] == cost]
        at = np.arange(len(levels)) + _ASIDE * (i - 0.5 * (len(costs) - 1))
        values = [here.loc[here["level"] == level, column].to_numpy(float) for level in levels]
        for x, twins in zip(at, values, strict=True):
            dots = {"linestyle": "none", "marker": ".", "markersize": 3.0, "alpha": 0.5}
            ax.plot(np.full(twins.size, x), twins, color=look["color"], **dots)  # type: ignore[arg-type]
        medians = [float(np.median(twins)) for twins in values]
        ax.plot(at, medians, color=look["color"], marker=_MARKERS[i % 6], markersize=4.0)
    scale = 1.0 if (frame["kind"] == NOISE).all() else 100.0
    ax.set_xticks(range(len(levels)), [f"{scale * level:g}" for level in levels])
    ax.set_xlim(-0.5, len(levels) - 0.5)
    ax.set_ylim(bottom=0.0)


FIGURE = Figure(
    place=10,
    make=draw_robustness,
    title="Twins of known truth",
    caption="Errors of the fits against how much noise (left) and how many outliers (right) "
    "the twins have; dots: one twin each, lines: their median. A cost function whose "
    "line stays low is robust. Lines within each other's dots do not differ.",
)


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the twins of known truth."""
    table = read_csv(results.of_step("robustness", "table.csv"))
    found = errors_of_twins(study, results)
    kept = recovered(study, found)
    lost = [name for name in study.imp.estimate if name not in kept]
    said = []
    for added, rows in table.groupby("added", sort=False):
        sizes = rows.set_index("cost_function")["error_percent"]
        text = ", ".join(f"{cost} {size:.2g} %" for cost, size in sizes.items())
        p = rows["p"].iloc[0]
        said.append(f"{added}: {text}" + (f", {_apart(p)}" if pd.notna(p) else ""))
    left = f" without {listed(lost)}, which no cost function recovers" if lost else ""
    return [f"Median error of the parameters in per cent of their limits{left}. {'; '.join(said)}."]


def _apart(p: float) -> str:
    return f"{'they differ' if p <= SIGNIFICANT else 'no difference shown'} (p = {p:.2g})"


PAGE = page_of_step(
    "robustness",
    heading="Robustness of the cost functions",
    text="Fits of all cost functions to curves of the model itself, with noise and outliers.",
    tables={"table": TABLE},
    figures={"robustness": FIGURE},
    sentences=sentences,
    prefix="",
)
