"""Stability of a diagnosis: tables and figure, and a section of the report."""

import textwrap
from collections import Counter

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.diagnosis_schema import OfVerdict
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.diagnosis.words import effect_name
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.page import page_of_step
from pyrofit.show.table import Row, Table
from pyrofit.show.text import listed, several
from pyrofit.steps.stability.facts import Stability, claimed_by, read, unit_of
from pyrofit.steps.stability.record import OfDraw, write_gathered

COLUMNS = (
    "effect",
    "measured",
    "claimed_percent",
    "final_percent",
    "strength",
    "lowest",
    "highest",
    "unit",
)
OF_DRAWS = ("data", "kind", "confirmed", "claimed", "final", "chi2", "reasons")


def effects_table(study: Study, results: Results) -> pd.DataFrame:
    """List the effects that are found, those of the measured data first."""
    found = read(study, results)
    count = len(found.draws)
    rows: list[Row] = []
    for effect in found.effects:
        strengths = found.strengths(effect)
        rows.append(
            {
                "effect": effect_name(effect),
                "measured": "claimed" if effect in found.claimed else "–",
                "claimed_percent": 100.0 * found.times_claimed(effect) / count,
                "final_percent": 100.0 * found.times_final(effect) / count,
                "strength": found.measured_strength(effect),
                "lowest": min(strengths, default=None),
                "highest": max(strengths, default=None),
                "unit": unit_of(effect),
            }
        )
    return pd.DataFrame(rows, columns=list(COLUMNS))


def draws(study: Study, results: Results) -> pd.DataFrame:
    """List the verdict on the measured data and on each disturbed data set."""
    found = read(study, results)
    verdict = found.measured.verdict
    rows = [_row("as measured", verdict, found.claimed)]
    for draw in found.draws:
        row = _row(f"draw {draw.draw}", draw, claimed_by(draw))
        rows.append({**row, "final": _listed(draw.final), "chi2": draw.chi2})
    return pd.DataFrame(rows, columns=list(OF_DRAWS))


def _row(data: str, verdict: OfVerdict | OfDraw, claimed: list[str]) -> Row:
    confirmed = "yes" if verdict.confirmed else "no"
    return {
        "data": data,
        "kind": verdict.kind,
        "confirmed": confirmed,
        "claimed": _listed(claimed),
        "reasons": "" if claimed else "; ".join(verdict.reasons),
    }


def _listed(effects: list[str]) -> str:
    return ", ".join(effects) or "–"


TABLES = {
    "effects": Table(
        place=60,
        make=effects_table,
        title="Effects found in disturbed data",
        note="Claimed: share of the disturbed data sets whose verdict claims the effect. In the "
        "model: share whose search ends with a model that has it. The tests of a claim may reject "
        "it afterwards. Strengths are those of these models.",
        headings={
            "measured": "measured data",
            "claimed_percent": "claimed [%]",
            "final_percent": "in the model [%]",
            "strength": "strength, measured data",
            "lowest": "lowest strength",
            "highest": "highest strength",
        },
    ),
    "draws": Table(
        place=70,
        make=draws,
        title="Verdict on each disturbed data set",
        note="Claimed: effects in the verdict. Model: those of the model that the search ended "
        "with, and its chi-square.",
        headings={
            "kind": "verdict",
            "final": "model",
            "chi2": "chi-square",
            "reasons": "why nothing is claimed",
        },
    ),
}


MOST = 16
"""Effects that the figure shows; the table has all."""
WRAP = 44
"""Letters of a line beside the bars."""


def draw_shares(study: Study, results: Results) -> Canvas:
    """Draw the shares of the draws whose verdict names an effect, or whose model has it."""
    found = read(study, results)
    shown = found.effects[:MOST]
    count = len(found.draws)
    claimed = np.array([100.0 * found.times_claimed(e) / count for e in shown])
    final = np.array([100.0 * found.times_final(e) / count for e in shown])
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 28.0 + 7.0 * max(len(shown), 1))
    at = np.arange(len(shown), dtype=float)
    ax.barh(at, final, height=0.62, color=style.COLOURS[5])
    ax.barh(at, claimed, height=0.34, color=style.COLOURS[0])
    labels = [textwrap.fill(effect_name(effect), WRAP) for effect in shown]
    ax.set_yticks(at, labels, fontsize=6.5)
    for label, effect in zip(ax.get_yticklabels(), shown, strict=True):
        if effect in found.claimed:
            label.set_fontweight("bold")
    ax.set_ylim(max(len(shown), 1) - 0.5, -0.5)
    if not shown:
        ax.text(50.0, 0.0, "no effect is found in any data set", ha="center", va="center")
    ax.set_xlim(0.0, 100.0)
    ax.set_xlabel(f"share of {count} disturbed data sets [%]")
    entries = [
        style.patch("verdict claims it", color=style.COLOURS[0]),
        style.patch("the model of the search has it", color=style.COLOURS[5]),
    ]
    style.legend_below(canvas, entries)
    return canvas


FIGURES = {
    "stability": Figure(
        place=10,
        make=draw_shares,
        title="How often disturbed data lead to each effect",
        caption="Share of the disturbed data sets whose verdict claims an effect (dark), and whose "
        "search ends with a model that has it (light). The tests of a claim may reject it "
        f"afterwards. Bold: claimed from the measured data. The figure shows {MOST} effects at "
        "most, the table all.",
    ),
}


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the stability of a diagnosis."""
    found = read(study, results)
    return [
        _of_draws(found),
        _of_verdicts(found),
        *_of_searches(found),
        *_of_claimed(found),
        *_of_others(found),
    ]


def _of_draws(found: Stability) -> str:
    part = 100.0 * found.draws[0].disturbance
    return (
        f"Random noise with {part:g} % of the estimated standard deviation was added to the data, "
        f"and the diagnosis repeated: {several(len(found.draws), 'time')}."
    )


def _of_verdicts(found: Stability) -> str:
    kinds = Counter(draw.kind for draw in found.draws)
    shown = listed([f"'{kind}' ({n})" for kind, n in kinds.most_common()])
    kind = found.measured.verdict.kind
    verdicts = f"Verdict on the measured data: '{kind}'. Verdicts on the disturbed data: {shown}. "
    if not any([found.claimed, *map(claimed_by, found.draws)]):
        return f"{verdicts}No data set leads to a claimed effect."
    same = sum(set(claimed_by(draw)) == set(found.claimed) for draw in found.draws)
    return f"{verdicts}The same effects are claimed from {_of(same, found)} disturbed data sets."


def _of(times: int, found: Stability) -> str:
    return f"{times} of {len(found.draws)}"


def _of_searches(found: Stability) -> list[str]:
    """Tell which effects every search finds, whatever the tests of a claim say of them."""
    every = [e for e in found.effects if found.times_final(e) == len(found.draws)]
    return [f"Every search ends with {listed(list(map(effect_name, every)))}."] if every else []


def _of_claimed(found: Stability) -> list[str]:
    """Tell how often the effects of the measured data are claimed again."""
    times = {effect: found.times_claimed(effect) for effect in found.claimed}
    every = [effect_name(e) for e, n in times.items() if n == len(found.draws)]
    rest = [f"{effect_name(e)} ({_of(n, found)})" for e, n in times.items() if n < len(found.draws)]
    said = [f"Named from all data sets: {listed(every)}."] if every else []
    if rest:
        said.append(
            f"Not claimed from every disturbed data set: {listed(rest)}. Such a claim is not firm."
        )
    return said


def _of_others(found: Stability) -> list[str]:
    """Tell which effects only disturbed data name."""
    others = [e for e in found.effects if e not in found.claimed and found.times_claimed(e)]
    shares = [f"{effect_name(e)} ({_of(found.times_claimed(e), found)})" for e in others]
    return [f"Named from disturbed data only: {listed(shares)}."] if others else []


PAGE = page_of_step(
    "stability",
    heading="Stability of the diagnosis",
    text="How often data changed by a small part of their noise lead to the same effects.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
    finish=write_gathered,
)
