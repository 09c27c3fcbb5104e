"""Known values with and without each effect of the verdict."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import effect_name
from pyrofit.show.table import Table


def accord(study: Study, results: Results) -> pd.DataFrame:
    """List known parameters less their known values, in standard deviations."""
    verdict = diagnosis.read(study, results).verdict
    rows = [
        {
            "parameter": name,
            "meaning": study.parameters[name].label if name in study.parameters else "",
            "effect": effect_name(effect),
            "without": without,
            "with": with_effect,
        }
        for effect, tested in zip(verdict.effects, verdict.evidence, strict=True)
        for name, (without, with_effect) in tested.known.items()
    ]
    return pd.DataFrame(rows)


TABLE = Table(
    place=620,
    make=accord,
    title="Accord with known values",
    note="Fitted less known value, in stated standard deviations, of the model without the effect "
    "and with it. An effect that moves a known value more than two of them away must gain enough "
    "with known values held, too.",
    headings={"without": "without the effect", "with": "with it"},
)
