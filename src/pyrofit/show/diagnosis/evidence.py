"""Evidence for each effect of the verdict, besides the fit."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import HELD_OUT, Found, effect_name, prediction_name
from pyrofit.show.table import Table, always


def evidence(study: Study, results: Results) -> pd.DataFrame:
    """List how the verdict's effects pass the tests of a claim."""
    return evidence_of(study, diagnosis.read(study, results))


def evidence_of(study: Study, found: Found) -> pd.DataFrame:
    """Return a row for each effect of a verdict, without columns that nothing was tested for."""
    verdict = found["verdict"]
    rows = []
    for effect, tested, terms in zip(
        verdict["effects"], verdict["evidence"], verdict["other_terms"], strict=True
    ):
        nearest = min(terms, key=lambda term: float(term["above"])) if terms else None
        rows.append(
            {
                "effect": effect_name(effect),
                "predictions": _in_words(study, tested["predictions"]) or None,
                "agreement": np.nan if tested["agreement"] is None else tested["agreement"],
                "correction": nearest["words"] if nearest else None,
                "above": f"{nearest['above']:+.1f}" if nearest else None,
            }
        )
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


def _in_words(study: Study, gains: Mapping[str, float]) -> str:
    return "; ".join(f"{_predicted(study, name)} {gain:+.1f}" for name, gain in gains.items())


def _predicted(study: Study, name: str) -> str:
    title = prediction_name(study, name)
    return title if name.startswith(HELD_OUT) else f"{title} from the others"


TABLE = Table(
    place=55,
    applies=always,
    make=evidence,
    title="Confidence in the result",
    note="Log score: its change by the effect, for each test predicted from the others, and for "
    "the held-out tests. Equal strengths: p of the test that all experiments give the effect the "
    "same strength. Free correction: the best free curve in the place of the effect, and its "
    "-2 ln marginal likelihood relative to the effect.",
    headings={
        "predictions": "log score of predictions",
        "agreement": "equal strengths, p",
        "correction": "best free correction",
        "above": "-2 ln marginal likelihood",
    },
)
