"""The kinetics at all heating rates."""

from collections.abc import Sequence

import pandas as pd

from pyrofit.analysis.uses import all_rates, mass_signal, rates_in_fit
from pyrofit.config import Study
from pyrofit.results import kinetics
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.subjects.kinetics.drawing import (
    busy_span,
    curves_of_sets,
    dash_of,
    data_entries,
    draw_mass_band,
    mass_series,
    rate_of,
    with_same_words,
)
from pyrofit.show.units import celsius
from pyrofit.show.verdicts import verdict_on
from pyrofit.solver.outputs import MASS_FRACTION


def kinetics_all_rates(study: Study, results: Results) -> Canvas:
    """Draw mass against temperature at every heating rate, one panel each; repeats share one."""
    curves = kinetics.read_kinetic_curves(study, results, all_rates(study))
    names = all_rates(study)
    used = set(rates_in_fit(study))
    panels = with_same_words(names, lambda n: _title(study, n) + (", in fit" if n in used else ""))
    height = 52.0 if len(panels) > 3 else 70.0
    canvas, axes = style.panels(len(panels), 4, style.TWO_COLUMNS, height, sharex=True, sharey=True)
    for ax, repeats in zip(axes, panels.values(), strict=True):
        for name in repeats:
            measured = mass_series(study, results, name)
            draw_mass_band(ax, measured)
            temperature = celsius(measured["temperature_K"])
            look = {"color": "0.6", "linewidth": 2.0 if len(repeats) == 1 else 1.0}
            ax.plot(temperature, measured[MASS_FRACTION], **look)  # type: ignore[arg-type]
        for name in repeats:
            _draw_sets(ax, curves_of_sets(study, curves, name))
        ax.set_xlim(*busy_span(curves))
    style.letter(axes, list(panels))
    for i, ax in enumerate(axes):
        if i % 4 == 0:
            ax.set_ylabel("normalised mass $m/m_0$ [–]")
        if i + 4 >= len(axes):  # the last of its column
            ax.tick_params(labelbottom=True)
            ax.set_xlabel("temperature [°C]")
    lines = [
        style.line(label, color=style.colour(k), linestyle=dash_of(k))
        for k, label in enumerate(kinetics.labels(study))
    ]
    style.legend_below(canvas, [*data_entries(study, results, names), *lines])
    return canvas


def _draw_sets(ax: Axes, sets: Sequence[tuple[str, pd.DataFrame]]) -> None:
    for k, (_, curve) in enumerate(sets):
        temperature = celsius(curve["temperature_K"])
        ax.plot(temperature, curve[MASS_FRACTION], color=style.colour(k), linestyle=dash_of(k))


def _title(study: Study, name: str) -> str:
    """Return the heating rate, with the laboratory if the study has several."""
    laboratories = {study.experiments[n].laboratory for n in all_rates(study)}
    own = study.experiments[name].laboratory
    return (
        f"{own}, {rate_of(study, name)}" if len(laboratories) > 1 and own else rate_of(study, name)
    )


FIGURE = Figure(
    place=30,
    applies=lambda study: bool(all_rates(study)),
    make=kinetics_all_rates,
    verdict=lambda study, facts: verdict_on(
        study, facts, "kinetics", [(n, mass_signal(study, n)) for n in all_rates(study)]
    ),
    title="Kinetics at all heating rates",
    caption="Mass against temperature at the fitted and compared heating rates. Panels without "
    "'in fit' are predictions: a set that only fits where it was fitted fails there.",
)
