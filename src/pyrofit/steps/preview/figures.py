"""A figure per experiment: the data before the band of all that the limits allow."""

import numpy as np
import pandas as pd

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.results.files import Results, read_csv
from pyrofit.show import style
from pyrofit.show.curves import label_of_axis
from pyrofit.show.drawn import Axes, Canvas, Line2D, Patch
from pyrofit.show.units import shown
from pyrofit.steps.preview.record import BANDS, Preview, Window

ALL, HALF = "0.86", "0.68"
"""Greys of the band of all sets, and of the middle half of them."""
OUTSIDE = style.ESTIMATES
"""Colour of data outside, which have another marker as well."""


def draw_experiments(
    study: Study, bands: pd.DataFrame, found: Preview, results: Results, folder: str
) -> None:
    """Write ``<folder>/<experiment>.svg`` and ``.png`` of every experiment.

    Parameters
    ----------
    study
        The study.
    bands
        Measured values and bands, as `compute.preview` returns them.
    found
        The findings.
    results, folder
        The results and the folder in them.
    """
    for name, of in bands.groupby("experiment", sort=False):
        with style.style():
            style.save(draw_experiment(study, str(name), of, found), results, str(name), folder)


def read_bands(results: Results) -> pd.DataFrame:
    """Return measured values and bands.

    Raises
    ------
    DataError
        They are missing or broken.
    """
    return read_csv(results.of_step("preview", BANDS))


def draw_experiment(study: Study, name: str, bands: pd.DataFrame, found: Preview) -> Canvas:
    """Draw the records of an experiment before the band of all sets.

    Parameters
    ----------
    study, name
        The study, and the name of the experiment.
    bands
        Its measured values and bands, SI units.
    found
        The findings, for the windows outside.
    """
    signals = list(dict.fromkeys(bands["signal"]))
    width = 110.0 if len(signals) == 1 else style.TWO_COLUMNS
    canvas, axes = style.panels(len(signals), 2, width, 66.0)
    for ax, signal in zip(axes, signals, strict=True):
        windows = [w for w in found.windows if (w.experiment, w.signal) == (name, signal)]
        _panel(ax, study, name, signal, bands[bands["signal"] == signal], windows)
    data = "synthetic data" if study.is_synthetic else "measured"
    entries: list[Line2D | Patch] = [
        style.patch(f"all {found.sets} sets within the limits", color=ALL),
        style.patch("middle half of them", color=HALF),
        style.line(data, color=style.MEASURED),
    ]
    if any(w.experiment == name for w in found.windows):
        entries.append(style.line("outside", color=OUTSIDE, linestyle="none", marker="x"))
    style.legend_below(canvas, entries)
    canvas.suptitle(title_of(study, name))
    return canvas


def _panel(
    ax: Axes, study: Study, name: str, signal: str, frame: pd.DataFrame, windows: list[Window]
) -> None:
    quantity = study.experiments[name].quantity(signal)
    at = _abscissa(quantity, frame["at"])
    low, high = (shown(quantity, frame[c]) for c in ("lower", "upper"))
    ax.fill_between(at, low, high, color=ALL, linewidth=0.0)
    low, high = (shown(quantity, frame[c]) for c in ("lower_quarter", "upper_quarter"))
    ax.fill_between(at, low, high, color=HALF, linewidth=0.0)
    value = np.asarray(shown(quantity, frame["value"]))
    ax.plot(at, value, color=style.MEASURED, linewidth=1.0)
    inside = [frame["at"].between(w.begins, w.ends) for w in windows]
    off = np.any(inside, axis=0) if inside else np.zeros(len(frame), dtype=bool)
    ax.plot(at[off], value[off], color=OUTSIDE, linestyle="none", marker="x", markersize=4.0)
    ax.set_xlabel("temperature [°C]" if quantity.against_temperature else "time [s]")
    ax.set_ylabel(label_of_axis(study, name, signal))


def _abscissa(quantity: Quantity, at: pd.Series) -> np.ndarray:
    values = at.to_numpy(float)
    return values - ICE_POINT_K if quantity.against_temperature else values
