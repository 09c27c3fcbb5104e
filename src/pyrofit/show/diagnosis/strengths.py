"""Missing effects and their strengths."""

from collections.abc import Callable

import pandas as pd

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import effect_name, leading
from pyrofit.show.table import Table


def strengths_table(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters of the effects that the verdict rests on, with their intervals."""
    found = diagnosis.read(study, results)
    chosen = leading(found)
    profiles = {(p.effect, p.parameter): p for p in found.profiles}
    catalogue = known_effects()
    rows = []
    for effect, free in (chosen.free if chosen else {}).items():
        for name in free:
            assert chosen is not None
            p = chosen.parameters[f"{effect}_{name}"]
            interval = profiles.get((effect, name), p)
            rows.append(
                {
                    "effect": effect_name(effect),
                    "equation": catalogue[effect].equation,
                    "parameter": catalogue[effect].quantities[name].label,
                    "value": p.value,
                    "low": interval.low,
                    "high": interval.high,
                    "low_wide": _wider(min, p.low_wide, interval.low),
                    "high_wide": _wider(max, p.high_wide, interval.high),
                    "unit": p.unit,
                    "without": catalogue[effect].quantities[name].value,
                }
            )
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


def _wider(wider: Callable[[float, float], float], end: float | None, of: float) -> float | None:
    """Return an end of the wide interval, which holds that of the profile."""
    return None if end is None else wider(end, of)


TABLE = Table(
    place=200,
    make=strengths_table,
    title="Missing effects and their strengths",
    note="95 % intervals: of the strengths by profile likelihood, of other parameters linear about "
    "the fit. Wide: the interval over other forms of the effect and over other models that fit as "
    "well; empty where it is the same. Without: the value at which the effect is absent, or the "
    "default of a form parameter.",
    headings={
        "low": "95 % low",
        "high": "95 % high",
        "low_wide": "wide low",
        "high_wide": "wide high",
    },
)
