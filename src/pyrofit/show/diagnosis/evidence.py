"""Evidence for each effect of the verdict, besides the fit."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.diagnose.settings import Settings
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_schema import Diagnosis, OfEvidence
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import HELD_OUT, effect_name, prediction_name, setting
from pyrofit.show.table import Table


def evidence(study: Study, results: Results) -> pd.DataFrame:
    """List how the verdict's effects pass the tests of a claim."""
    return evidence_of(study, diagnosis.read(study, results))


def evidence_of(study: Study, found: Diagnosis) -> pd.DataFrame:
    """Return a row for each effect of a verdict, without columns that nothing was tested for."""
    verdict, least = found.verdict, setting(found, "informative_gain", 2.0)
    rows = []
    for effect, tested, terms in zip(
        verdict.effects, verdict.evidence, verdict.other_terms, strict=True
    ):
        nearest = min(terms, key=lambda term: term.above) if terms else None
        rows.append(
            {
                "effect": effect_name(effect),
                "weight": f"{100.0 * tested.weight:.0f} %",
                "predictions": _in_words(study, tested, least) or None,
                "agreement": tested.agreement,
                "correction": nearest.words if nearest else None,
                "above": f"{nearest.above:+.1f}" if nearest else None,
            }
        )
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


def _in_words(study: Study, tested: OfEvidence, least: float) -> str:
    expected = tested.expected
    return "; ".join(
        f"{_predicted(study, name)} {gain:+.1f}{_telling(expected.get(name), least)}"
        for name, gain in tested.predictions.items()
    )


def _telling(expected: float | None, least: float) -> str:
    """Say whether a prediction can tell, from the gain that it promises if the effect is real."""
    if expected is None:
        return ""
    return f" (of {expected:.1f})" if expected >= least else " (cannot tell)"


def _predicted(study: Study, name: str) -> str:
    title = prediction_name(study, name)
    return title if name.startswith(HELD_OUT) else f"{title} from the others"


TABLE = Table(
    place=600,
    make=evidence,
    title="Confidence in the result",
    note="Weight: share of all fitted models, each weighed by its fit and number of parameters, "
    "that have an effect of the group. Log score: its change by the effect, for each test "
    "predicted from the others, and for the held-out tests. In brackets, the change expected "
    "if the effect is real. A test cannot tell if that is too small beside its noise and its "
    f"uncertain flux, h, thickness and clock. Below {Settings().deciding_gain:g} it does not "
    "decide alone. Equal strengths: p of the test that all experiments give the effect the same "
    "strength. Free correction: the best free curve in the place of the effect, and its -2 ln "
    "marginal likelihood relative to the effect.",
    headings={
        "weight": "weight of the group",
        "predictions": "log score of predictions",
        "agreement": "equal strengths, p",
        "correction": "best free correction",
        "above": "-2 ln marginal likelihood",
    },
)
