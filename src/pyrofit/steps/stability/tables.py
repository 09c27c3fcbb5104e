"""Effects by how often they are found, and the verdict on each disturbed data set."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.diagnosis_schema import OfVerdict
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import effect_name
from pyrofit.show.table import Row, Table
from pyrofit.steps.stability.facts import claimed_by, read, unit_of
from pyrofit.steps.stability.record import OfDraw

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
