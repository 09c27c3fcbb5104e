"""Drawings on the Axes of a caller, or on new ones; Matplotlib's own settings hold."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.transforms import offset_copy

from pyrofit.analysis.uses import title_of
from pyrofit.api.arguments import wrong
from pyrofit.api.choices import Key
from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.model.heated import HeatedExperiment
from pyrofit.show import style
from pyrofit.show.curves import draw_band, label_of_axis
from pyrofit.show.text import signed
from pyrofit.show.units import celsius, difference, difference_unit, shown

COLUMNS = 2
"""Panels in a row."""
PANEL = (4.6, 3.2)
"""Width and height of a panel [inch]."""
LONGEST_LABEL = 36
"""Letters of a line of a label."""
_DATA: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": 3.0}
_DATA |= {"color": style.MEASURED, "label": "data"}


def chosen(keys: Sequence[Key], experiment: str | Key | None, signal: str | None) -> Key:
    """Return the one series that a caller means.

    >>> chosen([("a", "mlr"), ("b", "mlr")], "b", None)
    ('b', 'mlr')
    """
    if isinstance(experiment, tuple) and len(experiment) == 2 and signal is None:
        experiment, signal = experiment
    if not isinstance(experiment, str | None) or not isinstance(signal, str | None):
        raise StudyError("experiment and signal are names; give Axes as `ax=`")
    fitting = [key for key in keys if experiment in (None, key[0]) and signal in (None, key[1])]
    if len(fitting) == 1:
        return fitting[0]
    names = [", ".join(key) for key in keys]
    if fitting:
        raise StudyError(f"several series are there: {'; '.join(names)}. Name one of them")
    asked = ", ".join(name for name in (experiment, signal) if name)
    raise StudyError(f"there is no series {asked}. {suggest(asked, names)}")


def axes_of(given: Axes | None) -> Axes:
    """Return the Axes of a caller, by default those of a new figure."""
    if given is None:
        return new_panels(1)[0]
    if not isinstance(given, Axes):
        raise wrong("ax", "Axes of Matplotlib", given)
    return given


def new_panels(count: int) -> list[Axes]:
    """Return the Axes of a new figure with panels in rows of two."""
    import matplotlib.pyplot as plt  # which starts a window system; not where Axes are given

    columns = min(COLUMNS, count)
    rows = -(-count // columns)
    size = (PANEL[0] * columns, PANEL[1] * rows)
    _, grid = plt.subplots(rows, columns, squeeze=False, figsize=size, layout="constrained")
    axes: list[Axes] = list(grid.flat)
    for unused in axes[count:]:
        unused.set_axis_off()
    return axes[:count]


def draw_series(
    ax: Axes, study: Study, key: Key, frame: pd.DataFrame, look: Mapping[str, Any]
) -> None:
    """Draw a series over time, or over the temperature of a heated sample."""
    quantity = study.experiments[key[0]].quantity(key[1])
    ax.plot(_abscissa(ax, study, key, frame), shown(quantity, frame[quantity.column]), **look)
    _labels(ax, study, key)


def draw_comparison(
    ax: Axes, study: Study, key: Key, measured: pd.DataFrame, simulated: pd.DataFrame
) -> None:
    """Draw a measured series with its uncertainty, and the simulated one."""
    quantity = study.experiments[key[0]].quantity(key[1])
    x = _abscissa(ax, study, key, measured)
    draw_band(ax, measured.assign(time_s=x), quantity)
    ax.plot(x, shown(quantity, measured[quantity.column]), **_DATA)
    ax.plot(
        x, shown(quantity, simulated[quantity.column]), color=style.COLOURS[1], label="simulated"
    )
    _labels(ax, study, key)
    ax.legend(frameon=False)


def draw_residuals(
    ax: Axes, study: Study, key: Key, measured: pd.DataFrame, simulated: pd.DataFrame
) -> None:
    """Draw simulated less measured values; grey: the uncertainty of the measurement."""
    quantity = study.experiments[key[0]].quantity(key[1])
    x = _abscissa(ax, study, key, measured)
    draw_band(ax, measured.assign(time_s=x), quantity, about_zero=True)
    off = simulated[quantity.column].to_numpy(float) - measured[quantity.column].to_numpy(float)
    ax.plot(x, difference(quantity, off), color=style.COLOURS[1], linewidth=0.8)
    style.zero_line(ax)
    _labels(ax, study, key)
    words = f"residual of the {study.experiments[key[0]].words(key[1])}"
    words = style.in_lines(words, LONGEST_LABEL)
    ax.set_ylabel(f"{words}\n[{difference_unit(quantity)}]")


def intervals(ax: Axes, table: pd.DataFrame) -> None:
    """Draw estimates with 95 % intervals between the limits of the parameters.

    ``table`` has the columns value, low, high, lower and upper by parameter.
    """
    rows = np.arange(len(table))
    span = table["upper"] - table["lower"]
    x, low, high = ((table[c] - table["lower"]) / span for c in ("value", "low", "high"))
    known = low.notna()
    ax.hlines(rows[known], low[known], high[known], color=style.COLOURS[0], linewidth=2.0)
    ax.plot(x, rows, color=style.COLOURS[0], linestyle="none", marker="o", markersize=4.0)
    ax.set_yticks(rows, list(table.index))
    ax.set_ylim(len(table) - 0.5, -0.5)
    ax.set_xlim(-0.02, 1.02)
    ax.set_xticks([0.0, 0.5, 1.0], ["lower limit", "middle", "upper limit"])
    ax.grid(axis="x", linewidth=0.4)


def draw_correlation(ax: Axes, table: pd.DataFrame) -> None:
    """Draw correlations as a matrix of numbers: blue is negative, red is positive."""
    values = table.to_numpy(float)
    ax.imshow(values, cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    for i, row in enumerate(values):
        for j, value in enumerate(row):
            colour = "white" if abs(value) > 0.6 else "black"
            ax.text(j, i, signed(value), ha="center", va="center", fontsize=7, color=colour)
    ax.set_xticks(range(len(table)), list(table.columns), rotation=45)
    ax.set_yticks(range(len(table)), list(table.index))


def _abscissa(ax: Axes, study: Study, key: Key, frame: pd.DataFrame) -> Any:
    """Return times, or temperatures in °C of a sample with a heating rate; label the axis."""
    experiment = study.experiments[key[0]]
    isothermal = isinstance(experiment, HeatedExperiment) and experiment.is_isothermal
    if "temperature_K" in frame and not isothermal:
        ax.set_xlabel("temperature [°C]")
        return celsius(frame["temperature_K"])
    ax.set_xlabel("time [s]")
    return frame["time_s"].to_numpy(float)


def _labels(ax: Axes, study: Study, key: Key) -> None:
    ax.set_ylabel(label_of_axis(study, *key))
    ax.set_title(title_of(study, key[0]), loc="left")


def draw_diagnosed(ax: Axes, study: Study, key: Key, curves: pd.DataFrame, extended: bool) -> None:
    """Draw a measured series, the base model's curve, and that with the effects found."""
    quantity = study.experiments[key[0]].quantity(key[1])
    frame = curves.dropna(axis="columns", how="all")
    x = _abscissa(ax, study, key, frame)
    ax.plot(x, shown(quantity, frame["measured"]), **_DATA)
    ax.plot(x, shown(quantity, frame["before"]), color=style.colour(1), label="base model")
    if extended:
        look = {"color": style.colour(0), "linestyle": style.dashes(1)}
        ax.plot(x, shown(quantity, frame["after"]), label="with the effects found", **look)
    _labels(ax, study, key)
    ax.legend(frameon=False)


def legend_below_label(ax: Axes, entries: Sequence[Any]) -> None:
    """Put a legend below the label of the abscissa."""
    place = offset_copy(ax.transAxes, ax.get_figure(root=True), y=-34.0, units="points")
    ax.legend(
        handles=entries,
        loc="upper left",
        bbox_to_anchor=(0.0, 0.0),
        bbox_transform=place,
        ncols=3,
        frameon=False,
        fontsize=7,
    )


def wide_axes(rows: int) -> Axes:
    """Return new Axes for some rows of text with remarks to the right."""
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(8.0, 1.4 + 0.3 * min(rows, 20)), layout="constrained")
    return ax
