"""Missing effects and their strengths."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import effect_name, leading
from pyrofit.show.table import Table, always


def strengths(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters of the effects that the verdict rests on, with their intervals."""
    chosen = leading(diagnosis.read(study, results))
    catalogue = known_effects()
    rows = []
    for effect, free in (chosen["free"] if chosen else {}).items():
        for name in free:
            p = chosen["parameters"][f"{effect}_{name}"] if chosen else {}
            rows.append(
                {
                    "effect": effect_name(effect),
                    "equation": catalogue[effect].equation,
                    "parameter": catalogue[effect].quantities[name].label,
                    "value": p["value"],
                    "low": p["low"],
                    "high": p["high"],
                    "low_wide": p["low_wide"],
                    "high_wide": p["high_wide"],
                    "unit": p["unit"],
                    "without": catalogue[effect].quantities[name].value,
                }
            )
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


TABLE = Table(
    place=30,
    applies=always,
    make=strengths,
    title="Missing effects and their strengths",
    note="95 % intervals, linear about the fit; those of the profiles may differ. Wide: the "
    "interval over other forms of the effect and over other models that fit as well; empty where "
    "it is the same. Without: the value at which the effect is absent, or the usual value of a "
    "form parameter.",
    headings={
        "low": "95 % low",
        "high": "95 % high",
        "low_wide": "wide low",
        "high_wide": "wide high",
    },
)
