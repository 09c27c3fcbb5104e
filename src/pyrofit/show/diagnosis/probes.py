"""Free corrections that would absorb the misfit."""

import textwrap

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_schema import Diagnosis, OfProbe
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.table import Table
from pyrofit.show.units import celsius


def probes_table(study: Study, results: Results) -> pd.DataFrame:
    """List which free correction inside the model would absorb the misfit, the best first."""
    found = diagnosis.read(study, results).probes
    rows = [{"probe": p.what, "absorbed_percent": 100.0 * p.absorbed} for p in found]
    return pd.DataFrame(rows, columns=["probe", "absorbed_percent"])


_SHOWN = {"W/m2": ("kW/m²", 1e-3), "J/(m2 K)": ("J/(m² K)", 1.0), "-": ("–", 1.0)}
"""Unit that is shown, and the factor to it, where another one is shown."""


_LEAST = 0.005
"""Share of the excess that a correction must absorb to be drawn."""


def _absorbing(found: Diagnosis) -> list[OfProbe]:
    return [p for p in found.probes if p.shape and p.absorbed >= _LEAST]


def draw_probes(study: Study, results: Results) -> Canvas:
    """Draw the free corrections that were put into the model."""
    found = _absorbing(diagnosis.read(study, results))
    canvas, axes = style.panels(len(found), 2, style.TWO_COLUMNS, 55.0)
    titles = [f"{p.what}: absorbs {100.0 * p.absorbed:.0f} %" for p in found]
    style.letter(axes, [textwrap.fill(title, 40) for title in titles])
    for ax, probe in zip(axes, found, strict=True):
        x, y = np.array(probe.shape, dtype=float).reshape(-1, 2).T
        unit, factor = _SHOWN.get(probe.unit, (probe.unit, 1.0))
        # Without a unit it is a factor, else a change.
        ax.axhline(1.0 if probe.unit == "-" else 0.0, color="0.3", linewidth=0.5)
        over_time = probe.probe == "flux"
        ax.plot(x if over_time else celsius(x), factor * y, color=style.COLOURS[0])
        ax.set_xlabel("time [s]" if over_time else "temperature [°C]")
        what = "factor on the" if probe.unit == "-" else "change of the"
        ax.set_ylabel(f"{what} {probe.probe.replace('_', ' ')}\n[{unit}]")
    return canvas


TABLE = Table(
    place=400,
    make=probes_table,
    title="Free corrections that absorb the misfit",
    note="Each is a free curve in one place of the model, added to the model with the effects "
    "found. Absorbed: share of the excess chi-square that it removes. It tells where a missing "
    "effect acts, not its name.",
    headings={"absorbed_percent": "absorbed [%]"},
)


FIGURE = Figure(
    place=410,
    applies=lambda found: bool(_absorbing(found)),
    make=draw_probes,
    title="Free corrections that absorb the misfit",
    caption="Free curves, each put into the model in one place and fitted with all "
    "parameters. The share of the excess chi-square that each absorbs is given; those that "
    "absorb nothing are not drawn. Grey lines: no correction.",
)
