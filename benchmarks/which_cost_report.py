"""Tables and figure of docs/which_cost.md, from the results of `which_cost.py`."""

from pathlib import Path

import numpy as np
import pandas as pd
from page import table
from which_cost_numbers import (
    CASE,
    REFERENCE,
    WEAK,
    bootstrapped,
    estimates,
    gathered,
    middle,
    ratios,
)

from pyrofit.results.files import Results, write_text
from pyrofit.show.style import (
    TWO_COLUMNS,
    colour,
    legend_below,
    letter,
    line,
    panels,
    save,
    style,
)
from pyrofit_blind_test.rates import rate_interval

GROUPS = {
    "white": "white noise",
    "measured": "noise as measured",
    "lasting": "lasting noise",
    "outliers": "outliers",
    "known": "k_r known",
    "wrong": "wrong model",
}
"""Groups of twins, in words."""
SHOWN = {
    "right model": ("white", "measured", "lasting"),
    "outliers": ("outliers",),
    "wrong model": ("wrong",),
}
"""Groups of twins that are compared, and their parts."""
NOISES = ("white", "measured", "lasting")
"""Groups that differ in their noise alone."""
MARKERS = ("o", "s", "D")


def _percent(values: tuple[float, float, float]) -> str:
    return (
        "-"
        if np.isnan(values[0])
        else "{:.1f} ({:.1f} to {:.1f})".format(*np.multiply(100, values))
    )


def _times(values: tuple[float, float, float]) -> str:
    return "-" if np.isnan(values[0]) else "{:.2f} ({:.2f} to {:.2f})".format(*values)


def errors(best: pd.DataFrame, column: str) -> str:
    """Return a table of the geometric mean of an error by cost and group [%]."""
    groups = {**SHOWN, GROUPS["known"]: ("known",)}
    rows = []
    for cost in best["cost"].unique():
        of = best[best["cost"] == cost]
        cells = [
            of.loc[of["group"].isin(g), column].dropna().to_numpy(float) for g in groups.values()
        ]
        rows.append([f"`{cost}`", *(_percent(bootstrapped(c)) for c in cells)])
    return table(["cost", *groups], rows)


def by_noise(best: pd.DataFrame) -> str:
    """Return a table of mean errors by kind of noise: parameters, rate at 60 kW/m2 [%]."""
    found = best[best["group"].isin(NOISES)].groupby(["cost", "group"], sort=False)
    means = found[["error", "unseen_mlr"]].agg(lambda of: 100 * middle(of.to_numpy(float)))
    rows = []
    for cost in best["cost"].unique():
        cells = [means.loc[(cost, noise)] for noise in NOISES]
        rows.append([f"`{cost}`", *(f"{c['error']:.1f}, {c['unseen_mlr']:.1f}" for c in cells)])
    return table(["cost", *(GROUPS[noise] for noise in NOISES)], rows)


def against(best: pd.DataFrame, column: str) -> str:
    """Return a table of the ratio of an error to that of the reference."""
    rows = []
    for cost in best["cost"].unique():
        cells = [ratios(best, column, groups, cost) for groups in SHOWN.values()]
        worse = [f"{np.count_nonzero(c > 1.0)} of {c.size}" for c in cells]
        both = zip(cells, worse, strict=True)
        if cost != REFERENCE:
            rows.append([f"`{cost}`", *(f"{_times(bootstrapped(c))}, {w}" for c, w in both)])
    return table(["cost", *SHOWN], rows)


def robustness(best: pd.DataFrame) -> str:
    """Return a table of errors with outliers over those of the same truth without."""
    rows = []
    for cost in best["cost"].unique():
        cells = []
        for column in ("error", "unseen_mlr"):
            with_them, without = (
                best[(best["group"] == g) & (best["cost"] == cost)].set_index("number")[column]
                for g in ("outliers", "measured")
            )
            cells.append(_times(bootstrapped((with_them / without).dropna().to_numpy(float))))
        rows.append([f"`{cost}`", *cells])
    return table(["cost", "parameters", "rate at 60 kW/m²"], rows)


def searches(ends: pd.DataFrame) -> str:
    """Return a table of how many searches find the least cost, and of the calls spent for each."""
    rows = []
    twins = ends[ends["kind"] != "measured"]
    for cost in ends["cost"].unique():
        cells = []
        for optimiser in ("least squares", "CMA-ES", "SCE-UA"):
            of = twins[(twins["cost"] == cost) & (twins["optimiser"] == optimiser)]
            hits, runs = int(of["found"].sum()), len(of)
            spent = f", {of['calls'].sum() / hits:.0f}" if hits else ""
            if optimiser == "SCE-UA" and hits:
                spent += f", {of.loc[of['found'], 'calls_to_it'].median():.0f}"
            cells.append(f"{hits}/{runs}{spent}" if runs else "-")
        rows.append([f"`{cost}`", *cells])
    return table(["cost", "least squares", "CMA-ES", "SCE-UA"], rows)


def _counted(inside: pd.Series) -> str:
    hits, of = int(inside.sum()), len(inside)
    if not of:
        return "-"
    low, high = rate_interval(hits, of)
    return f"{hits}/{of}, {hits / of:.0%} ({low:.0%} to {high:.0%})"


def coverage(intervals: pd.DataFrame) -> str:
    """Return a table of how many 95 % intervals hold the truth."""
    held = intervals.assign(inside=(intervals["low"] <= 0.0) & (intervals["high"] >= 0.0))
    held["width"] = intervals["high"] - intervals["low"]
    held = held[held["parameter"] != WEAK]
    rows = []
    for cost in held["cost"].unique():
        of = held[held["cost"] == cost]
        cells = [_counted(of.loc[of["group"] == g, "inside"]) for g in GROUPS]
        rows.append([f"`{cost}`", *cells, f"{100 * of['width'].median():.1f}"])
    return table(["interval", *GROUPS.values(), "median width [%]"], rows)


def spans(ends: pd.DataFrame) -> str:
    """Return a table of how many spans of the repetitions of SCE-UA hold the truth."""
    of = ends[(ends["optimiser"] == "SCE-UA") & (ends["kind"] != "measured")]
    of = of.dropna(axis="columns", how="all")
    columns = [c for c in of if c.startswith("x_")]
    rows = []
    for cost in of["cost"].unique():
        grouped = of[of["cost"] == cost].groupby(CASE)[columns]
        low, high, sd = grouped.min(), grouped.max(), grouped.std()
        inside = (low <= 0.0) & (high >= 0.0)
        seen = [c for c in columns if c != f"x_{WEAK}"]
        wrong = inside.index.get_level_values("kind") == "wrong"
        rows.append(
            [
                f"`{cost}`",
                _counted(inside.loc[~wrong, seen].stack()),
                _counted(inside.loc[wrong, seen].stack()),
                f"{100 * (high - low)[seen].stack().median():.2f}",
                f"{100 * sd[seen].stack().median():.2f}",
                f"{100 * (high - low)[f'x_{WEAK}'].median():.0f}",
            ]
        )
    head = ["cost", "right model", "wrong model", "median span [%]", "median sd [%]"]
    return table([*head, f"span of {WEAK} [%]"], rows)


def measured(best: pd.DataFrame) -> str:
    """Return a table of the errors at the flux that was not fitted, of measured data [%]."""
    of = best[best["kind"] == "measured"]
    cases = list(of.groupby(CASE, sort=False).groups)
    rows = []
    for cost in of["cost"].unique():
        found = of[of["cost"] == cost].set_index(CASE)
        pairs = [found.loc[case] for case in cases]
        texts = [
            f"{100 * p['fitted_mlr']:.1f}, {100 * p['unseen_mlr']:.1f}, "
            f"{100 * p['unseen_back_temperature']:.1f}"
            for p in pairs
        ]
        rows.append([f"`{cost}`", *texts])
    names = [f"`{name}` {f} → {85 - f} kW/m²" for _, name, f in cases]
    return table(["cost", *names], rows)


def repeated(ends: pd.DataFrame) -> str:
    """Return a table of prediction errors of SCE-UA's repetitions for measured data [%]."""
    of = ends[(ends["optimiser"] == "SCE-UA") & (ends["kind"] == "measured")]
    rows = []
    for cost in of["cost"].unique():
        errors = 100 * of.loc[of["cost"] == cost, ["unseen_mlr", "unseen_back_temperature"]]
        low, middle_, high = (errors.quantile(q) for q in (0.0, 0.5, 1.0))
        cells = [f"{middle_[c]:.1f} ({low[c]:.1f} to {high[c]:.1f})" for c in errors]
        rows.append([f"`{cost}`", len(errors), *cells])
    return table(["cost", "repetitions", "rate", "back temperature"], rows)


def drawn(best: pd.DataFrame, root: Path) -> None:
    """Write the figure: errors of parameters and predictions by cost, with intervals."""
    costs = list(best["cost"].unique())
    with style():
        canvas, axes = panels(2, 2, TWO_COLUMNS, 95.0, sharey=True)
        for ax, column in zip(axes, ("error", "unseen_mlr"), strict=True):
            for i, groups in enumerate(SHOWN.values()):
                of = best[best["group"].isin(groups)]
                for row, cost in enumerate(costs):
                    values = of.loc[of["cost"] == cost, column].dropna().to_numpy(float)
                    at, low, high = (100 * v for v in bootstrapped(values))
                    y = row + 0.22 * (i - 1)
                    ax.plot([low, high], [y, y], color=colour(i), lw=1.0)
                    ax.plot(at, y, MARKERS[i], color=colour(i), ms=3.5)
            ax.set_xscale("log")
            ax.xaxis.set_major_formatter("{x:g}")
            ax.margins(x=0.05)
        axes[0].set_yticks(range(len(costs)), costs)
        axes[0].invert_yaxis()
        axes[0].set_xlabel("error of parameters [% of the limits' distance]")
        axes[1].set_xlabel("error of the rate at 60 kW/m² [% of its range]")
        letter(axes, ["parameters", "prediction"])
        entries = [
            line(label, color=colour(i), marker=MARKERS[i], ms=3.5) for i, label in enumerate(SHOWN)
        ]
        legend_below(canvas, entries)
        save(canvas, Results(root), "which_cost")


def report(folder: Path) -> None:
    """Write tables.md and figures/which_cost.svg and .png into the folder."""
    ends = gathered(folder, "ends")
    best = estimates(ends)
    twins = best[best["kind"] != "measured"]
    counts = twins.groupby("group").apply(lambda g: g[CASE].drop_duplicates().shape[0])
    sections = {
        "Twins": ", ".join(f"{GROUPS[g]} {counts.get(g, 0)}" for g in GROUPS),
        "Parameters [% of limits]": errors(twins, "error"),
        f"{WEAK} [% of limits]": errors(twins, "weak"),
        "Rate at 60 kW/m² [% of range]": errors(twins, "unseen_mlr"),
        "Back temperature at 60 kW/m² [% of range]": errors(twins, "unseen_back_temperature"),
        "Parameters and rate at 60 kW/m² by noise [%]": by_noise(twins),
        "Rate at 60 kW/m² over chi2's": against(twins, "unseen_mlr"),
        "Parameters over chi2's": against(twins, "error"),
        "Outliers": robustness(twins),
        "Coverage": coverage(gathered(folder, "intervals")),
        "Spans of 25 repetitions": spans(ends),
        "Searches": searches(ends),
        "Measured": measured(best),
        "Measured, SCE-UA": repeated(ends),
        "Seconds": f"{ends.groupby([*CASE, 'cost'])['seconds'].first().sum():.0f}",
    }
    text = "\n\n".join(f"## {title}\n\n{body}" for title, body in sections.items())
    write_text(folder / "tables.md", text + "\n")
    drawn(twins, folder)
