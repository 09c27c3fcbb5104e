"""Fig. 2: the kinetics beside TGA."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from scipy.signal import savgol_filter

from pyrofit.config import Study
from pyrofit.figures import style
from pyrofit.quantities import known_quantities
from pyrofit.results import kinetics, recorded
from pyrofit.results.files import Results
from pyrofit.solver.arrays import FloatArray
from pyrofit.tables.describe import all_rates, data_name, rates_in_fit

WINDOW_K = 10.0
"""Width of the window over which a slope is taken [K]."""
FITTED = "fitted"
# In an order that keeps the first three far apart in grey, though measured lines are lighter.
_RATES = ("#000000", "#BB3344", "#56B4E9", "#009E73", "#CC8800", "#CC79A7")
_NOTICEABLE = 0.01
_UNCERTAINTY = known_quantities()["mass_fraction"].uncertainty_column


def slope(temperature_K: FloatArray, mass_fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return -d(m/m0)/dT [1/K], the slope of a parabola fitted to each 10 K of a curve.

    Savitzky and Golay (1964, doi 10.1021/ac60214a047) on an even grid of temperature. Divided by
    the heating rate like this, curves of all heating rates are of similar height.

    >>> T, rate = slope(np.arange(300.0, 340.0, 2.0), 1.0 - 0.01 * np.arange(0.0, 40.0, 2.0))
    >>> bool(np.allclose(rate, 0.01))
    True
    """
    rising, first = np.unique(temperature_K, return_index=True)
    grid = np.linspace(rising[0], rising[-1], rising.size)
    step = float(grid[1] - grid[0])
    window = min(max(5, 2 * int(0.5 * WINDOW_K / step) + 1), (rising.size - 1) // 2 * 2 + 1)
    even = np.interp(grid, rising, mass_fraction[first])
    return grid, -savgol_filter(even, window, min(2, window - 1), deriv=1, delta=step)


def fig2(study: Study, results: Results) -> Canvas:
    """Fig. 2: mass and mass loss rate of the TGA runs that were fitted, measured and simulated."""
    curves = kinetics.curves(study, results, all_rates(study))
    names = rates_in_fit(study)
    canvas, (left, right) = style.panels(2, 2, style.TWO_COLUMNS, 82.0)
    for i, name in enumerate(names):
        measured = recorded.series(study, results, name, "mass_fraction")
        _band(left, measured)
        _draw(left, right, measured, _colour(i), "-")
        for k, (_, curve) in enumerate(_sets(study, curves, name)):
            _draw(left, right, curve, _colour(i), _dash(k))
    left.set_ylabel("normalised mass $m/m_0$ [–]")
    right.set_ylabel("mass loss rate / heating rate\n$-\\mathrm{d}(m/m_0)/\\mathrm{d}T$ [1/K]")
    style.letter((left, right), ("mass", "mass loss rate"))
    for ax in (left, right):
        ax.set_xlim(*_span(curves[curves["experiment"].isin(names)]))
        ax.set_xlabel("temperature [°C]")
    rates = [style.patch(_rate(study, name), color=_colour(i)) for i, name in enumerate(names)]
    lines = [
        style.line(label, color="black", linestyle=_dash(k))
        for k, label in enumerate(_labels(study))
    ]
    style.legend_below(canvas, [*rates, *_data_entries(study, results, names), *lines])
    return canvas


def _draw(left: Axes, right: Axes, curve: pd.DataFrame, colour: str, dash: object) -> None:
    temperature = curve["temperature_K"].to_numpy(float)
    mass = curve["mass_fraction"].to_numpy(float)
    # Measured lines are light, so that dashes on top of them are seen.
    look = {"color": colour, "linestyle": dash}
    look |= {"alpha": 0.45, "linewidth": 1.8} if dash == "-" else {"linewidth": 1.1}
    left.plot(style.celsius(temperature), mass, **look)  # type: ignore[arg-type]
    grid, rate = slope(temperature, mass)
    right.plot(style.celsius(grid), rate, **look)  # type: ignore[arg-type]


def _colour(i: int) -> str:
    return _RATES[i % len(_RATES)]


def _dash(k: int) -> object:
    return ((0, (4, 1.5)), (0, (1, 1.2)), *style.DASHES[2:])[k % 6]


def _labels(study: Study) -> list[str]:
    assert study.kinetics is not None
    return [FITTED, *study.kinetics.sets]


def _sets(study: Study, curves: pd.DataFrame, name: str) -> list[tuple[str, pd.DataFrame]]:
    here = curves[curves["experiment"] == name]
    return [(label, here[here["set"] == label]) for label in _labels(study)]


def _rate(study: Study, name: str) -> str:
    return f"{study.experiments[name].heating_rate_K_min:g} K/min"  # type: ignore[union-attr]


def _span(curves: pd.DataFrame) -> tuple[float, float]:
    """Return the temperatures [degrees C] between which the simulated masses change."""
    mass = curves["mass_fraction"]
    start = mass.groupby([curves["experiment"], curves["set"]]).transform("first")
    end = mass.groupby([curves["experiment"], curves["set"]]).transform("last")
    busy = (mass < start - _NOTICEABLE) & (mass > end + _NOTICEABLE)
    temperature = style.celsius(curves["temperature_K"])
    where = temperature[busy] if busy.any() else temperature
    low = max(float(temperature.min()), float(where.min()) - 30.0)
    return low, min(float(temperature.max()), float(where.max()) + 30.0)


def kinetics_all_rates(study: Study, results: Results) -> Canvas:
    """Draw mass against temperature at every heating rate, one panel each."""
    curves = kinetics.curves(study, results, all_rates(study))
    names = all_rates(study)
    used = set(rates_in_fit(study))
    height = 52.0 if len(names) > 3 else 70.0
    canvas, axes = style.panels(len(names), 4, style.TWO_COLUMNS, height, sharex=True, sharey=True)
    for ax, name in zip(axes, names, strict=True):
        measured = recorded.series(study, results, name, "mass_fraction")
        _band(ax, measured)
        ax.plot(
            style.celsius(measured["temperature_K"]),
            measured["mass_fraction"],
            color="0.6",
            linewidth=2.0,
        )
        for k, (_, curve) in enumerate(_sets(study, curves, name)):
            temperature = style.celsius(curve["temperature_K"])
            ax.plot(temperature, curve["mass_fraction"], color=style.colour(k), linestyle=_dash(k))
        ax.set_xlim(*_span(curves))
    style.letter(axes, [_rate(study, n) + (", in fit" if n in used else "") for n in names])
    for i, ax in enumerate(axes):
        if i % 4 == 0:
            ax.set_ylabel("normalised mass $m/m_0$ [–]")
        if i + 4 >= len(axes):  # the last of its column
            ax.tick_params(labelbottom=True)
            ax.set_xlabel("temperature [°C]")
    lines = [
        style.line(label, color=style.colour(k), linestyle=_dash(k))
        for k, label in enumerate(_labels(study))
    ]
    style.legend_below(canvas, [*_data_entries(study, results, names), *lines])
    return canvas


def _band(ax: Axes, measured: pd.DataFrame) -> None:
    """Shade measured mass ± uncertainty, where one is known."""
    if _UNCERTAINTY in measured:
        mass, width = (measured[c].to_numpy(float) for c in ("mass_fraction", _UNCERTAINTY))
        temperature = style.celsius(measured["temperature_K"])
        low, high = mass - width, mass + width
        ax.fill_between(temperature, low, high, color=style.BAND, linewidth=0.0)


def _data_entries(study: Study, results: Results, names: Sequence[str]) -> list[Line2D | Patch]:
    """Return the legend entries of the data, their band only where an uncertainty is known."""
    label = data_name(study, [(name, "mass_fraction") for name in names])
    line = style.line(label, color="0.6", linewidth=2.0)
    known = any(_UNCERTAINTY in recorded.series(study, results, n, "mass_fraction") for n in names)
    return [line, style.patch("uncertainty", color=style.BAND)] if known else [line]
