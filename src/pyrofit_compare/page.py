"""Table, page and figures of a comparison, written into a folder."""

import math
from pathlib import Path

import pandas as pd

from pyrofit.results.files import write_bytes, write_csv
from pyrofit.show.style import style
from pyrofit.show.units import shown
from pyrofit_compare.apparatus import Apparatus
from pyrofit_compare.compute import OURS, REPEATS, ComparedWith, Key
from pyrofit_compare.given import group_of

PAGE, TABLE, SUMMARY = "comparison.md", "scores.csv", "summary.csv"


def write(found: ComparedWith, folder: Path) -> Path:
    """Write scores, their summary, a page and a figure for each signal; return the page."""
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(folder / TABLE, found.scores)
    write_csv(folder / SUMMARY, mean_errors(found.scores))
    figures = {key: f"{key[0]}_{key[1]}.png" for key in found.means}
    for key, name in figures.items():
        _draw(found, key, folder / name)
    write_bytes(folder / PAGE, "\n".join(_lines(found, figures)).encode())
    return folder / PAGE


def mean_errors(scores: pd.DataFrame) -> pd.DataFrame:
    """Return the mean error of each predictor, and that of this study at the same times.

    Columns: who, cases, mean_nrms, this_study, and repeats: means over the same cases. Sorted by
    the ratio of the first two means.
    """
    scored = scores[scores["nrms"].notna()]
    floor = scored[scored["who"] == REPEATS].set_index(["test", "signal"])["nrms"]
    rows = []
    for who, part in scored[scored["who"] != REPEATS].groupby("who", sort=True):
        cases = pd.MultiIndex.from_frame(part[["test", "signal"]])
        means = part[["nrms", "this_study"]].mean()
        known = floor.reindex(cases).mean()
        rows.append((who, len(part), means["nrms"], means["this_study"], known))
    columns = ["who", "cases", "mean_nrms", "this_study", "repeats"]
    table = pd.DataFrame(rows, columns=columns)
    order = (table["mean_nrms"] / table["this_study"]).sort_values(kind="stable").index
    return table.loc[order].reset_index(drop=True)


def _lines(found: ComparedWith, figures: dict[Key, str]) -> list[str]:
    scores = found.scores
    lines = [
        f"# Study {found.study.name} against further tests",
        "",
        f"Parameter set: {found.label}. An error is the rms of the mean measured curve less the "
        "mean predicted one, divided by the range of the mean measured curve. The scatter of "
        "repeats is the rms of the standard deviation of one repeat over the same range. Errors "
        "count the times that a prediction covers; this study stands beside it at those times.",
        "",
        "| who | cases | mean error | this study, same times | scatter of repeats |",
        "|---|---|---|---|---|",
    ]
    for row in mean_errors(scores).to_dict("records"):
        cells = [_shown(row[k]) for k in ("mean_nrms", "this_study", "repeats")]
        lines.append(f"| {row['who']} | {row['cases']} | {' | '.join(cells)} |")
    if scores["who"].isin([OURS, REPEATS]).all():
        lines += ["", "No prediction of others has the flux and the thickness of a test."]
    else:
        lines += [
            "",
            "Predictions of others hold for the apparatus that they assume. Ideal cases have no "
            "convection and an insulated back: their errors include that difference.",
        ]
    lines += _apparatus(found.apparatus)
    if found.assumed:
        lines += ["", "## Assumed and to know", "", *[f"- {line}" for line in found.assumed]]
    if found.left:
        lines += ["", "## Left out", "", *[f"- {line}" for line in found.left]]
    for key, figure in figures.items():
        lines += ["", f"## {key[0]}, {key[1]}", ""]
        lines += ["| who | error | this study, same times | part of the times |"]
        lines += ["|---|---|---|---|"]
        part = scores[(scores["test"] == key[0]) & (scores["signal"] == key[1])]
        for row in part.sort_values("nrms", kind="stable").to_dict("records"):
            errors = f"{_shown(row['nrms'])} | {_shown(row['this_study'])}"
            lines.append(f"| {row['who']} | {errors} | {row['covered']:.2f} |")
        if found.means[key].repeats == 1:
            lines += ["", "One test alone: the scatter of repeats is not known."]
        lines += ["", f"![{key[0]}, {key[1]}: measured and predicted]({figure})"]
    return [*lines, ""]


def _apparatus(apparatus: Apparatus) -> list[str]:
    """Return the numbers of the apparatus with their intervals, and whether it is described."""
    if apparatus.fit is None:
        return []
    lines = ["", "## Apparatus", "", "These numbers are fitted to the runs on inert bodies.", ""]
    lines += ["| parameter | value | 95 % interval | unit |", "|---|---|---|---|"]
    for name, row in apparatus.fit.table.to_dict("index").items():
        interval = f"{row['low']:.3g} to {row['high']:.3g}"
        lines.append(f"| {name} | {row['value']:.3g} | {interval} | {row['unit']} |")
    return [*lines, "", "Of this fit to the inert runs:", *apparatus.fit.verdict]


def _shown(number: float) -> str:
    return "–" if math.isnan(number) else f"{number:.3f}"


def _draw(found: ComparedWith, key: Key, path: Path) -> None:
    """Draw the mean with a band of the repeats, this study's curve, and thin ones of others."""
    from matplotlib.figure import Figure

    mean = found.means[key]
    name = next(n for n in found.study.experiments if group_of(found.study, n) == key[0])
    quantity = found.study.experiments[name].quantity(key[1])
    with style():
        figure = Figure(figsize=(5.2, 3.6), layout="constrained")
        ax = figure.add_subplot()
        if mean.repeats > 1:
            low, high = mean.value - mean.sd, mean.value + mean.sd
            label = f"repeats ± 1 sd ({mean.repeats})"
            ax.fill_between(
                mean.time_s, shown(quantity, low), shown(quantity, high), color="0.8", label=label
            )
        ax.plot(mean.time_s, shown(quantity, mean.value), color="k", label="measured mean")
        for who, curve in found.curves[key].items():
            own = who == OURS
            width = 1.8 if own else 0.6
            color = "C3" if own else None
            ax.plot(mean.time_s, shown(quantity, curve), lw=width, color=color, label=who)
        ax.set_xlabel("time / s")
        ax.set_ylabel(f"{quantity.title} / {quantity.shown.unit}")
        ax.legend(fontsize="x-small")
        figure.savefig(path, dpi=150, metadata={"Software": None})
