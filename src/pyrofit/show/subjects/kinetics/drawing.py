"""Mass against temperature, shared by the figures of the kinetics."""

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from pyrofit.analysis.uses import mass_signal
from pyrofit.config import Study
from pyrofit.model.heated import HeatedExperiment
from pyrofit.quantities import known_quantities
from pyrofit.results import recorded
from pyrofit.results.files import Results
from pyrofit.results.kinetics import labels
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Line2D, Patch
from pyrofit.show.names import data_name
from pyrofit.show.units import celsius
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.outputs import MASS_FRACTION

WINDOW_K = 10.0
"""Width of the window over which a slope is taken [K]."""


# In an order that keeps the first three far apart in grey, though measured lines are lighter.
_RATES = ("#000000", "#BB3344", "#56B4E9", "#009E73", "#CC8800", "#CC79A7")


_NOTICEABLE = 0.01


_UNCERTAINTY = known_quantities()[MASS_FRACTION].uncertainty_column


def mass_series(study: Study, results: Results, name: str) -> pd.DataFrame:
    """Return the measured mass of an experiment."""
    return recorded.series(study, results, name, mass_signal(study, name))


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
    return grid, -_slopes(even, window) / step


def _slopes(y: FloatArray, window: int) -> FloatArray:
    """Return the slopes by place of the parabolas that fit each window best, ends included."""
    half = window // 2
    at = np.arange(-half, half + 1.0)
    bent = at**2 - np.mean(at**2)
    near = np.lib.stride_tricks.sliding_window_view(y, window)
    rise = np.sum(near * at, axis=1) / max(float(np.sum(at**2)), 1.0)
    bend = 2.0 * np.sum(near * bent, axis=1) / max(float(np.sum(bent**2)), 1e-9)
    begin = rise[0] + bend[0] * at[:half]
    end = rise[-1] + bend[-1] * at[half + 1 :]
    return np.concatenate([begin, rise, end])


def rate_colour(i: int) -> str:
    """Return the colour of the i-th heating rate."""
    return _RATES[i % len(_RATES)]


def dash_of(k: int) -> object:
    """Return the line style of the k-th set."""
    return ((0, (4, 1.5)), (0, (1, 1.2)), *style.DASHES[2:])[k % 6]


def curves_of_sets(study: Study, curves: pd.DataFrame, name: str) -> list[tuple[str, pd.DataFrame]]:
    """Return label and curve of every set at an experiment."""
    here = curves[curves["experiment"] == name]
    return [(label, here[here["set"] == label]) for label in labels(study)]


def rate_of(study: Study, name: str) -> str:
    """Return the heating rate of an experiment, or its set point, in words."""
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    if experiment.set_point_K is not None:
        return f"held at {experiment.set_point_K:g} K"
    return f"{experiment.heating_rate_K_min:g} K/min"


def with_same_words(names: Sequence[str], words: Callable[[str], str]) -> dict[str, list[str]]:
    """Return the experiments that have the same words, such as a heating rate, in their order."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(words(name), []).append(name)
    return groups


def busy_span(curves: pd.DataFrame) -> tuple[float, float]:
    """Return the temperatures [degrees C] between which the simulated masses change."""
    mass = curves[MASS_FRACTION]
    start = mass.groupby([curves["experiment"], curves["set"]]).transform("first")
    end = mass.groupby([curves["experiment"], curves["set"]]).transform("last")
    busy = (mass < start - _NOTICEABLE) & (mass > end + _NOTICEABLE)
    temperature = celsius(curves["temperature_K"])
    where = temperature[busy] if busy.any() else temperature
    low = max(float(temperature.min()), float(where.min()) - 30.0)
    return low, min(float(temperature.max()), float(where.max()) + 30.0)


def draw_mass_band(ax: Axes, measured: pd.DataFrame) -> None:
    """Shade measured mass ± uncertainty, where one is known."""
    if _UNCERTAINTY in measured:
        mass, width = (measured[c].to_numpy(float) for c in (MASS_FRACTION, _UNCERTAINTY))
        temperature = celsius(measured["temperature_K"])
        low, high = mass - width, mass + width
        ax.fill_between(temperature, low, high, color=style.BAND, linewidth=0.0)


def data_entries(study: Study, results: Results, names: Sequence[str]) -> list[Line2D | Patch]:
    """Return the legend entries of the data, their band only where an uncertainty is known."""
    label = data_name(study, [(name, mass_signal(study, name)) for name in names])
    line = style.line(label, color="0.6", linewidth=2.0)
    known = any(_UNCERTAINTY in mass_series(study, results, n) for n in names)
    return [line, style.patch("stated uncertainty", color=style.BAND)] if known else [line]
