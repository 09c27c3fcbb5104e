"""FDS beside pyrofit: a table, a figure, and a section of the report."""

import json
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.quantities import known_quantities
from pyrofit.results.files import Results, read_csv
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.page import Page
from pyrofit.show.table import Table
from pyrofit.show.units import celsius, shown

TITLE = "FDS beside pyrofit"
MOST_PANELS = 12


def entries(results: Results) -> list[dict[str, Any]]:
    """Return the results of the decks in FDS, an entry for each signal.

    Raises
    ------
    DataError
        The file is missing or broken.
    """
    path = results.fds("check.json")
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise DataError(f"{path}: cannot be read ({error}); delete it and run again") from None
    if not isinstance(found, list):
        raise DataError(f"{path}: this is no list of entries; delete it and run again")
    return found


def was_run(study: Study, results: Results) -> bool:
    """Whether the decks have been run in FDS."""
    return results.fds("fds.svg").is_file()


def _table(study: Study, results: Results) -> pd.DataFrame:
    rows = [
        {
            "experiment": study.experiments[e["experiment"]].title or e["experiment"],
            "signal": known_quantities()[e["signal"]].title if e["signal"] else "",
            "rms": None if e["rms_over_mean"] is None else 100.0 * e["rms_over_mean"],
            "late_s": e["burnout_s"],
            "verdict": f"failed: {e['error']}" if e["error"] else e["verdict"],
        }
        for e in entries(results)
    ]
    return pd.DataFrame(rows)


TABLE = Table(
    place=10,
    make=_table,
    title=TITLE,
    note="Rates and temperatures until 10 s before burn-out. No verdict where FDS has a term in "
    "another form or not at all.",
    headings={
        "rms": "rms difference over mean [%]",
        "late_s": "burn-out, FDS minus pyrofit [s]",
    },
)


def figure(study: Study, results: Results) -> Canvas:
    """Draw the curves of both, a panel for each experiment and signal."""
    curves = read_csv(results.fds("curves.csv"), {"fds": float, "pyrofit": float})
    groups = list(curves.groupby(["experiment", "signal"], sort=False))[:MOST_PANELS]
    canvas, axes = style.panels(len(groups), 2, style.TWO_COLUMNS, 45.0)
    style.letter(axes, [study.experiments[str(e)].title or str(e) for (e, _), _ in groups])
    for ax, ((_, signal), part) in zip(axes, groups, strict=True):
        _draw(ax, str(signal), part)
    lines = [style.line("pyrofit", color="black")]
    style.legend_below(canvas, [*lines, style.line("FDS", color=style.colour(1), linestyle="--")])
    return canvas


def _about(study: Study, results: Results) -> str:
    first = entries(results)[0]
    return f"FDS {first['fds']}, set '{first['set']}'."


def _draw(ax: Axes, signal: str, part: pd.DataFrame) -> None:
    quantity = known_quantities()[signal]
    timed = "time_s" in part and part["time_s"].notna().all()
    x = part["time_s"] if timed else celsius(part["temperature_K"])
    ax.plot(x, shown(quantity, part["pyrofit"]), color="black")
    ax.plot(x, shown(quantity, part["fds"]), color=style.colour(1), linestyle="--")
    ax.set_xlabel("time [s]" if timed else "temperature [°C]")
    ax.set_ylabel(f"{quantity.title} [{quantity.shown.unit}]")


FIGURE = Figure(
    place=20,
    make=figure,
    title=TITLE,
    caption="The same material and tests in pyrofit (lines) and in FDS (dashed).",
)
PAGE = Page(
    "fds",
    heading="In FDS",
    text="The decks of the export, run in a real FDS, beside the curves of pyrofit.",
    tables={"table": TABLE},
    figures={"fds": FIGURE},
    folders=("fds", "fds"),
    written=False,
    about={0: _about},
    exists=was_run,
)


def draw_and_write(study: Study, results: Results) -> None:
    """Write table and figure to ``fds``; the figure only where FDS has made a curve."""
    results.fds("fds.svg").unlink(missing_ok=True)
    if any(not e["error"] for e in entries(results)):
        PAGE.write_table("table", study, results)
        with style.style():
            style.save(figure(study, results), results, "fds", "fds")
