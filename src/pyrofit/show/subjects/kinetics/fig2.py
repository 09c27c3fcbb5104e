"""Fig. 2: the kinetics beside TGA."""

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
    rate_colour,
    rate_of,
    slope,
    with_same_words,
)
from pyrofit.show.units import celsius
from pyrofit.show.verdicts import verdict_on
from pyrofit.solver.outputs import MASS_FRACTION


def fig2(study: Study, results: Results) -> Canvas:
    """Fig. 2: mass and mass loss rate of the TGA runs that were fitted, measured and simulated."""
    curves = kinetics.read_kinetic_curves(study, results, all_rates(study))
    names = rates_in_fit(study)
    canvas, (left, right) = style.panels(2, 2, style.TWO_COLUMNS, 82.0)
    rates = with_same_words(names, lambda name: rate_of(study, name))
    for i, repeats in enumerate(rates.values()):
        for name in repeats:
            measured = mass_series(study, results, name)
            draw_mass_band(left, measured)
            _draw(left, right, measured, rate_colour(i), "-")
        for name in repeats:
            for k, (_, curve) in enumerate(curves_of_sets(study, curves, name)):
                _draw(left, right, curve, rate_colour(i), dash_of(k))
    left.set_ylabel("normalised mass $m/m_0$ [–]")
    right.set_ylabel("mass loss rate / heating rate\n$-\\mathrm{d}(m/m_0)/\\mathrm{d}T$ [1/K]")
    style.letter((left, right), ("normalised mass", "mass loss rate"))
    for ax in (left, right):
        ax.set_xlim(*busy_span(curves[curves["experiment"].isin(names)]))
        ax.set_xlabel("temperature [°C]")
    entries = [style.patch(rate, color=rate_colour(i)) for i, rate in enumerate(rates)]
    lines = [
        style.line(label, color="black", linestyle=dash_of(k))
        for k, label in enumerate(kinetics.labels(study))
    ]
    style.legend_below(canvas, [*entries, *data_entries(study, results, names), *lines])
    return canvas


def _draw(left: Axes, right: Axes, curve: pd.DataFrame, colour: str, dash: object) -> None:
    temperature = curve["temperature_K"].to_numpy(float)
    mass = curve[MASS_FRACTION].to_numpy(float)
    # Measured lines are light, so that dashes on top of them are seen.
    look = {"color": colour, "linestyle": dash}
    look |= {"alpha": 0.45, "linewidth": 1.8} if dash == "-" else {"linewidth": 1.1}
    left.plot(celsius(temperature), mass, **look)  # type: ignore[arg-type]
    grid, rate = slope(temperature, mass)
    right.plot(celsius(grid), rate, **look)  # type: ignore[arg-type]


FIGURE = Figure(
    place=10,
    applies=lambda study: bool(rates_in_fit(study)),
    make=fig2,
    verdict=lambda study, facts: verdict_on(
        study, facts, "kinetics", [(n, mass_signal(study, n)) for n in rates_in_fit(study)]
    ),
    title="Kinetics at the fitted heating rates",
    paper="Figure 2",
    caption="Normalised mass (left) and mass loss rate (right) against temperature at the "
    "heating rates used in the fit, one colour each. Wide, light: data; "
    "dashed: fitted; dotted: sets of the literature, if any. The rate is divided by "
    "the heating rate, so that all are of similar height. It is the slope of a "
    "parabola fitted to each 10 K of the mass, of data and simulations alike. Good "
    "kinetics shift with the heating rate as the data do.",
)
