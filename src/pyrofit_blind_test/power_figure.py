"""The figure of the power by effect."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

from pyrofit.show import style
from pyrofit.show.drawn import DrawStyle
from pyrofit_blind_test.power import power_of_diagnosis

LOOKS = {"half": "half named", "nine_tenths": "nine tenths named"}
"""Words of each share."""


def power_by_effect(twins: pd.DataFrame) -> Canvas:
    """Draw the detectabilities from which shares of each effect are named, with 95 % intervals."""
    table = power_of_diagnosis(twins)
    rows = np.arange(len(table))
    canvas, (ax,) = style.panels(1, 1, style.ONE_COLUMN + 25.0, 30.0 + 5.0 * max(len(table), 1))
    for i, share in enumerate(LOOKS if len(table) else ()):
        middle = table[share].to_numpy(float)
        ends = np.vstack([middle - table[f"{share}_low"], table[f"{share}_high"] - middle])
        ax.errorbar(middle, rows + 0.2 * (i - 0.5), xerr=ends, **_look(i), elinewidth=0.9)
    ax.set_xscale("log")
    ax.set_xlim(0.3, 800.0)
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
    ax.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_yticks(rows, [f"{row.of} (n = {row.twins})" for row in table.itertuples()])
    ax.set_ylim(max(len(table), 1) - 0.5, -0.5)
    ax.set_xlabel("detectability [standard deviations of the noise]")
    entries = [style.line(words, **_look(i)) for i, words in enumerate(LOOKS.values())]
    style.legend_below(canvas, entries)
    return canvas


def _look(i: int) -> DrawStyle:
    marker = ("o", "s")[i]
    return {"color": style.colour(i), "marker": marker, "markersize": 4, "linestyle": "none"}
