"""Mass, its slope and the residuals before and after the choice of a scheme."""

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.show.subjects.kinetics.drawing import rate_of, slope
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.scheme import record

LOOKS: dict[str, DrawStyle] = {
    "before": {"color": style.COLOURS[1], "linestyle": style.DASHES[1], "linewidth": 1.0},
    "after": {"color": style.COLOURS[0], "linestyle": "-", "linewidth": 1.0},
    "predicted": {"color": style.COLOURS[2], "linestyle": style.DASHES[3], "linewidth": 1.1},
}
_LABELS = {
    "before": "scheme of the study",
    "after": "chosen scheme",
    "predicted": "chosen scheme, rate left out",
}
_MEASURED: DrawStyle = {"color": style.MEASURED, "linewidth": 0.8}


def draw_schemes(study: Study, results: Results) -> Canvas:
    """Draw one row of panels for each record."""
    curves = record.read_scheme_curves(results)
    names = sorted(
        curves["experiment"].unique(),
        key=lambda n: study.experiments[n].heating_rate_K_min,  # type: ignore[union-attr]
    )
    canvas, axes = style.panels(3 * len(names), 3, style.TWO_COLUMNS, 38.0)
    titles = []
    for i, name in enumerate(names):
        here = curves[curves["experiment"] == name]
        _draw(axes[3 * i : 3 * i + 3], here)
        held = "" if bool(here["calibrated"].iloc[0]) else ", not fitted"
        titles += [f"{rate_of(study, name)}{held}", "slope", "residual"]
    style.letter(axes, titles)
    for ax in axes[-3:]:
        ax.set_xlabel("temperature [°C]")
    entries = [style.line("measured", **_MEASURED)]
    entries += [style.line(_LABELS[name], **look) for name, look in LOOKS.items()]
    style.legend_below(canvas, entries)
    return canvas


def _draw(axes: list[Axes], curve: pd.DataFrame) -> None:
    mass, rate, left = axes
    temperature = curve["temperature_K"].to_numpy(float)
    at = style.axis_celsius(temperature)
    measured = curve["measured"].to_numpy(float)
    mass.plot(at, measured, **_MEASURED)
    _draw_slope(rate, temperature, measured, _MEASURED)
    style.zero_line(left)
    for name, look in LOOKS.items():
        simulated = curve[name].to_numpy(float)
        mass.plot(at, simulated, **look)
        _draw_slope(rate, temperature, simulated, look)
        left.plot(at, simulated - measured, **look)
    busy = np.flatnonzero((measured < 0.995) & (measured > 0.005))
    ends = (busy[0], busy[-1]) if busy.size else (0, -1)
    for ax in axes:
        ax.set_xlim(at[ends[0]] - 20.0, at[ends[1]] + 20.0)
    mass.set_ylabel("$m/m_0$ [–]")
    rate.set_ylabel("−d$(m/m_0)$/d$T$ [1/K]")
    left.set_ylabel("sim. − meas. [–]")


def _draw_slope(ax: Axes, temperature: FloatArray, mass: FloatArray, look: DrawStyle) -> None:
    grid, rate = slope(temperature, mass)
    ax.plot(style.axis_celsius(grid), rate, **look)


FIGURE = Figure(
    place=10,
    make=draw_schemes,
    title="Reaction scheme of the study and the chosen one",
    caption="At every heating rate, the slowest at the top: mass over initial mass (left), "
    "its slope over temperature (middle), simulated minus measured mass (right). "
    "Black: measured; red, dashed: the scheme of the study, fitted alike. Blue: the "
    "chosen scheme; ochre, dotted: prediction of the chosen scheme, fitted without "
    "this heating rate. Rates marked 'not fitted' are predicted by every curve.",
)
