"""Activation energy over conversion, of the measured masses and of the fitted model."""

from pyrofit.analysis.isoconversional.records import applies
from pyrofit.config import Study
from pyrofit.results import isoconversional
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas, Line2D, Patch
from pyrofit.show.figure import Figure
from pyrofit.show.subjects.isoconversional.names import METHODS, NOTHING

_MODEL = {"color": style.COLOURS[1], "linestyle": style.DASHES[1], "linewidth": 1.4}
_DOTTED = {
    "friedman": {"color": style.COLOURS[2], "marker": "o", "markersize": 2.5, "linewidth": 0.6},
    "kas": {"color": style.COLOURS[3], "marker": "s", "markersize": 2.5, "linewidth": 0.6},
}
_BEST = {"color": style.COLOURS[0], "linewidth": 1.2}


def activation_energy(study: Study, results: Results) -> Canvas:
    """Draw E of three methods, the errors of the most accurate one, and E of the model."""
    table = isoconversional.energies(results)
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 85.0)
    at = table["conversion"]
    best, error = table["vyazovkin_kJ_mol"], table["vyazovkin_error_kJ_mol"]
    ax.fill_between(at, best - error, best + error, color=style.BAND, linewidth=0.0)
    entries: list[Line2D | Patch] = [
        style.patch(f"{METHODS['vyazovkin']}, 95 % interval", color=style.BAND)
    ]
    for method, look in {**_DOTTED, "vyazovkin": _BEST}.items():
        ax.plot(at, table[f"{method}_kJ_mol"], **look)  # type: ignore[arg-type]
        entries.append(style.line(METHODS[method], **look))
    if "model_vyazovkin_kJ_mol" in table:
        ax.plot(at, table["model_vyazovkin_kJ_mol"], **_MODEL)
        entries.append(style.line(f"fitted model, {METHODS['vyazovkin']}", **_MODEL))
    ax.set_xlim(0.0, 1.0)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel("conversion [–]")
    ax.set_ylabel("activation energy [kJ/mol]")
    style.legend_below(canvas, entries)
    return canvas


FIGURE = Figure(
    place=10,
    applies=applies,
    make=activation_energy,
    verdict=lambda study, facts: (facts.isoconversional or [NOTHING])[0],
    title="Activation energy over conversion",
    caption="The conversion is the mass lost over all mass that is lost. Each method compares "
    "the heating rates at equal conversion, and knows no model of the reactions. Red, dashed: "
    "the same analysis of the curves of the fitted model, which a model that describes the "
    "records has inside the band. Where the energy varies, more than one reaction is at work; "
    "KAS, which averages from the first conversion on, then lags behind the others.",
)
