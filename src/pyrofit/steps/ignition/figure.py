"""Times to ignition against the radiant flux, as straight lines."""

from typing import Any

import numpy as np

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.steps.ignition.record import read
from pyrofit.steps.ignition.times import DEFINITIONS


def draw_fluxes(study: Study, results: Results) -> Canvas:
    """Draw t^(-1/2) of each definition against the flux, with the lines of a thick solid."""
    found = read(study, results)
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 75.0)
    entries = []
    names = [name for name in DEFINITIONS if any(name in test.time_s for test in found.tests)]
    largest = max(test.flux_W_m2 for test in found.tests)
    for i, name in enumerate(names):
        pairs = [
            (test.flux_W_m2, time)
            for test in found.tests
            if (time := test.time_s.get(name)) is not None and time > 0.0
        ]
        look: dict[str, Any] = {"color": style.colour(i), "marker": "osv^"[i], "linestyle": "none"}
        ax.plot([q / 1e3 for q, _ in pairs], [1.0 / np.sqrt(t) for _, t in pairs], **look)
        entries.append(style.line(DEFINITIONS[name], **look))
        (line,) = (of for of in found.series if of.definition == name and of.law == "thick")
        if line.critical_W_m2 is not None and line.response is not None:
            flux = np.array([line.critical_W_m2, max(largest, line.critical_W_m2)])
            slope = np.sqrt(4.0 / np.pi) / line.response
            ax.plot(flux / 1e3, slope * (flux - flux[0]), color=style.colour(i))
    ax.set_xlim(left=0.0)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel("radiant flux [kW/m²]")
    ax.set_ylabel("$t_{ign}^{-1/2}$ [s$^{-1/2}$]")
    style.legend_below(canvas, entries)
    return canvas


FIGURES = {
    "fluxes": Figure(
        place=10,
        make=draw_fluxes,
        title="Times to ignition against the radiant flux",
        caption="Inverse square root of the time to ignition by each definition. A thermally thick "
        "solid gives a straight line; it meets zero at the critical heat flux. A line is missing "
        "where the tests do not determine one.",
    )
}
