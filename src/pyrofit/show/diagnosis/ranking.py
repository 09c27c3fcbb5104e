"""Candidates, drawn."""

import textwrap
from collections.abc import Sequence
from typing import Any

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.numerics import functions
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.diagnosis.effects import LIMIT
from pyrofit.show.diagnosis.words import CLAIMS, ranked, remark_on_candidate
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure

MOST = 20
"""Candidates that a figure shows."""


WRAP = 42
"""Letters of a line beside the candidates."""


_BASE: DrawStyle = {"color": style.COLOURS[1], "linewidth": 1.2}


_KEPT: DrawStyle = {"marker": "o", "linestyle": "none", "color": style.COLOURS[0]}


_REJECTED: DrawStyle = {**_KEPT, "markerfacecolor": "white"}


def ranking(study: Study, results: Results) -> Canvas:
    """Draw the penalised chi-square of the candidates above that of the best."""
    found = diagnosis.read(study, results)
    labels, reasons = _texts(found, ranked(found, MOST))
    lines = max(text.count("\n") + 1 for text in (*labels, *reasons))
    height = max(5.2, 0.8 + 2.6 * lines)
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 26.0 + height * len(labels))
    draw_ranking(ax, found)
    style.legend_below(canvas, ranking_entries(found))
    return canvas


def _texts(found: Diagnosis, shown: Sequence[OfCandidate]) -> tuple[list[str], list[str]]:
    """Return the names of candidates, and the remarks on them."""
    labels = [textwrap.fill(_label(candidate), WRAP) for candidate in shown]
    return labels, [_reason(found, candidate) for candidate in shown]


def draw_ranking(ax: Axes, found: Diagnosis) -> None:
    """Draw the candidates of a diagnosis, the best first."""
    shown = ranked(found, MOST)
    labels, reasons = _texts(found, shown)
    lowest = shown[0].penalised
    limit = found.ambiguity
    base, points = found.base.chi2 - lowest, float(found.base.points)
    needed = base - (found.needed - functions.log(points))
    ax.set_xscale("symlog", linthresh=1.0, linscale=0.5)
    right = 1.8 * max(base, *(c.penalised - lowest for c in shown), limit)
    ax.axvspan(needed, right, color=style.BAND, linewidth=0.0)
    ax.axvline(limit, **LIMIT)
    ax.axvline(base, **_BASE)
    for i, candidate in enumerate(shown):
        look = _REJECTED if candidate.rejected else _KEPT
        ax.plot([candidate.penalised - lowest], [i], **look, markersize=4.5)
        place: DrawStyle = {
            "va": "center",
            "ha": "left",
            "transform": ax.get_yaxis_transform(),
        }
        ax.text(1.015, i, reasons[i], fontsize=6.5, **place)
    ax.set_yticks(range(len(shown)), labels, fontsize=6.5)
    ax.set_ylim(len(shown) - 0.4, -0.6)
    ax.set_xlim(min(-0.3, 1.3 * needed), right)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("penalised χ² above that of the best candidate [–]")


def ranking_entries(found: Diagnosis) -> list[Any]:
    """Return the entries of the legend."""
    limit = found.ambiguity
    kept = "in the verdict" if found.verdict.kind in CLAIMS else "not rejected"
    return [
        style.line(kept, **_KEPT, markersize=4.5),
        style.line("rejected", **_REJECTED, markersize=4.5),
        style.line(f"not distinguished (< {limit:g})", **LIMIT),
        style.line("base model", **_BASE),
        style.patch("gain too small for a claim", color=style.BAND),
    ]


def _reason(found: Diagnosis, candidate: OfCandidate) -> str:
    """Return the remark on a candidate, in two lines at most."""
    said = textwrap.shorten(remark_on_candidate(found, candidate), 2 * WRAP - 6, placeholder=" …")
    return textwrap.fill(said, WRAP, break_on_hyphens=False)


def _label(candidate: OfCandidate) -> str:
    """Name a candidate: its effects, and the form parameters that were free."""
    parts = []
    for effect in candidate.effects:
        known = known_effects()[effect]
        forms = [known.quantities[n].symbol for n in candidate.free.get(effect, ())[1:]]
        parts.append(f"{known.title} ({', '.join(forms)})" if forms else known.title)
    return " + ".join(parts)


FIGURE = Figure(
    place=260,
    applies=lambda found: bool(found.candidates),
    make=ranking,
    title="Candidates, the best first",
    caption="Chi-square with log(points) for each parameter of an effect, above that of the "
    "best candidate; linear below 1, logarithmic beyond. The fit alone does not "
    "distinguish candidates left of the dashed line from the best one. In the grey "
    "area one effect gains too little to be claimed. In brackets: symbols of the form "
    "parameters that were fitted, too. Of fits with the same effects, the best is shown. "
    f"At most {MOST} are shown, the model of the verdict among them.",
)
