"""Heat flow and heat release of heated samples, measured and simulated."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.quantities.base import Quantity
from pyrofit.results import kinetics, recorded
from pyrofit.results.files import Results
from pyrofit.results.kinetics import heats_shown
from pyrofit.show import style
from pyrofit.show.curves import tests_of
from pyrofit.show.drawn import Axes, Canvas, Line2D, Patch
from pyrofit.show.figure import Figure
from pyrofit.show.names import data_name
from pyrofit.show.subjects.kinetics.drawing import dash_of, rate_of
from pyrofit.show.units import celsius, difference, shown
from pyrofit.show.verdicts import verdict_on
from pyrofit.solver.arrays import FloatArray

COLUMNS = 2


def draw_heats(study: Study, results: Results) -> Canvas:
    """Draw each signal other than mass against temperature, one panel each; repeats share one."""
    tests = tests_of(study, heats_shown(study))
    curves = kinetics.heat_curves(study, results)
    canvas, axes = style.panels(len(tests), COLUMNS, style.TWO_COLUMNS, 70.0)
    stated = False
    for ax, repeats in zip(axes, tests, strict=True):
        for name, signal in repeats:
            quantity = study.experiments[name].quantity(signal)
            measured = recorded.series(study, results, name, signal)
            stated |= quantity.uncertainty_column in measured
            _draw_measured(ax, measured, quantity, len(repeats))
            ax.set_ylabel(quantity.label)
        for name, signal in repeats:
            here = curves[(curves["experiment"] == name) & (curves["signal"] == signal)]
            for k, label in enumerate(kinetics.labels(study)):
                curve = here[here["set"] == label]
                quantity = study.experiments[name].quantity(signal)
                _draw(ax, curve, shown(quantity, curve["value"]), k)
        ax.set_xlabel("temperature [°C]")
    style.letter(axes, [_heading(study, *repeats[0]) for repeats in tests])
    style.legend_below(canvas, _entries(study, stated))
    return canvas


def _draw_measured(ax: Axes, measured: pd.DataFrame, quantity: Quantity, repeats: int) -> None:
    temperature = celsius(measured["temperature_K"])
    values = shown(quantity, measured[quantity.column])
    if quantity.uncertainty_column in measured:
        width = difference(quantity, measured[quantity.uncertainty_column])
        low, high = values - width, values + width
        ax.fill_between(temperature, low, high, color=style.BAND, linewidth=0.0)
    ax.plot(temperature, values, color="0.6", linewidth=2.0 if repeats == 1 else 0.8)


def _draw(ax: Axes, curve: pd.DataFrame, values: FloatArray, k: int) -> None:
    look = {"color": style.colour(k), "linestyle": dash_of(k)}
    ax.plot(celsius(curve["temperature_K"]), values, **look)  # type: ignore[arg-type]


def _heading(study: Study, name: str, signal: str) -> str:
    """Return heating rate and signal, and whether it is fitted."""
    assert study.kinetics is not None
    fitted = any((t.experiment, t.signal) == (name, signal) for t in study.kinetics.cost)
    repeat = study.experiments[name].repeat
    test = repeat.test if repeat else name
    return f"{rate_of(study, name)}, {test}" + (", in fit" if fitted else "")


def _entries(study: Study, stated: bool) -> list[Line2D | Patch]:
    entries: list[Line2D | Patch] = [
        style.line(data_name(study, heats_shown(study)), color="0.6", linewidth=2.0)
    ]
    if stated:
        entries.append(style.patch("stated uncertainty", color=style.BAND))
    return entries + [
        style.line(label, color=style.colour(k), linestyle=dash_of(k))
        for k, label in enumerate(kinetics.labels(study))
    ]


FIGURE = Figure(
    place=40,
    applies=lambda study: bool(heats_shown(study)),
    make=draw_heats,
    verdict=lambda study, facts: verdict_on(study, facts, "kinetics", heats_shown(study)),
    title="Heat flow and heat release of heated samples",
    caption="Heat flow (DSC, positive where heat is taken up) or heat release rate (MCC) per "
    "initial mass against temperature. Grey: data with their uncertainty; dashed and "
    "dotted: the fit and sets of the literature. The simulated heat flow includes the "
    "baseline. Panels without 'in fit' are predictions.",
)
