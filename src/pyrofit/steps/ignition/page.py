"""Times to ignition: tables, and a section of the report."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.page import page_of_step
from pyrofit.show.table import Table
from pyrofit.steps.ignition import record
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


_LAWS = {"thick": "thermally thick", "janssens": "Janssens", "thin": "thermally thin"}


def times_table(study: Study, results: Results) -> pd.DataFrame:
    """List the time to ignition of each test by definition."""
    return pd.DataFrame(
        [
            {"experiment": test.experiment, "flux_kW_m2": test.flux_W_m2 / 1e3}
            | {
                f"{name}_s": "no ignition" if time is None else f"{time:.4g}"
                for name, time in test.time_s.items()
            }
            for test in record.read(study, results).tests
        ]
    ).fillna("")


def lines(study: Study, results: Results) -> pd.DataFrame:
    """List the critical heat flux and the thermal response parameter of each line."""
    return pd.DataFrame([_row(of) for of in record.read(study, results).series])


def _row(of: record.OfLine) -> dict[str, object]:
    return {
        "definition": of.definition,
        "relation": _LAWS[of.law],
        "tests": of.tests,
        "critical_kW_m2": _number(of.critical_W_m2),
        "critical_95": _interval(of.critical_within),
        "response_k": _number(of.response),
        "response_95": _interval(of.response_within),
        "ignition_degC": "" if of.ignition_K is None else f"{of.ignition_K - 273.15:.0f}",
        "scatter_percent": "" if of.scatter is None else f"{100.0 * of.scatter:.1f}",
        "remarks": "; ".join(of.remarks),
    }


def _number(value: float | None) -> str:
    return "" if value is None else f"{value / 1e3:.3g}"


def _interval(within: list[float] | None) -> str:
    return "" if within is None else f"{within[0] / 1e3:.3g} to {within[1] / 1e3:.3g}"


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the lines of a thick solid, and on quantities that stay open."""
    found = record.read(study, results)
    said = []
    for of in found.series:
        fitting = [one for one in found.series if one.definition == of.definition and one.scatter]
        if of.law != "thick":
            continue
        words = f"By the {DEFINITIONS[of.definition]}"
        if of.critical_W_m2 is not None and of.response is not None:
            said.append(
                f"{words}, the critical heat flux is {_number(of.critical_W_m2)} kW/m² "
                f"(95 %: {_interval(of.critical_within)}), and the thermal response parameter "
                f"{_number(of.response)} kW s½/m² ({_interval(of.response_within)})."
            )
            best = min(fitting, key=lambda one: one.scatter or 0.0, default=of)
            if best.law != "thick":
                said.append(f"Its times follow the relation of {_LAWS[best.law]} solids closer.")
        said += [f"{words}: {remark}." for remark in of.remarks]
    if found.left_out:
        said.append(f"Without a rate or a flux that is a number: {', '.join(found.left_out)}.")
    return said


PAGE = page_of_step(
    "ignition",
    heading="Ignition",
    text="Times to ignition by the usual definitions, and lines of t^-n over the radiant flux: the "
    "critical heat flux, and the thermal response parameter.",
    tables={
        "times": Table(
            place=60,
            make=times_table,
            title="Times to ignition [s]",
            note="; ".join(f"{name}: {words}" for name, words in DEFINITIONS.items()),
        ),
        "lines": Table(
            place=70,
            make=lines,
            title="Critical heat flux and thermal response",
            note="Intervals of 95 %, that of the critical flux by Fieller's theorem. Response: "
            "thermal response parameter [kW s½/m²] of a thick solid, ρ c L ΔT [kJ/m²] of a thin "
            "one. Scatter: that of the times about the line.",
        ),
    },
    figures=FIGURES,
    sentences=sentences,
)
