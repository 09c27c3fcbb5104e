"""The catalogue of effects as a table."""

import pandas as pd

from pyrofit.api.studies import Source, read_study
from pyrofit.config import candidate_effects
from pyrofit.config.resolve import obstacle
from pyrofit.effects import known_effects


def effects(study: Source | None = None) -> pd.DataFrame:
    """Return the effects that a model may lack, by name.

    Columns: title, group, family, equation, strength (name of its parameter), unit, null,
    typical, lower, upper, needs.

    Parameters
    ----------
    study
        With a study, the columns ``candidate`` and ``obstacle`` say which effects its diagnosis
        tries, and why it does not try the others.

    Examples
    --------
    >>> import pyrofit as pf
    >>> pf.effects().loc["back_loss", "group"]
    'back loss'
    """
    rows = []
    for name, effect in known_effects().items():
        strength, quantity = next(iter(effect.strength.items()))
        rows.append(
            {
                "effect": name,
                "title": effect.title,
                "group": effect.group,
                "family": effect.family,
                "equation": effect.equation,
                "strength": strength,
                "unit": quantity.unit,
                "null": quantity.value,
                "typical": quantity.typical,
                "lower": quantity.lower,
                "upper": quantity.upper,
                "needs": effect.needs.words,
            }
        )
    table = pd.DataFrame(rows).set_index("effect")
    if study is not None:
        of = read_study(study)
        candidates = candidate_effects(of)
        table["candidate"] = [name in candidates for name in table.index]
        table["obstacle"] = [
            "" if name in candidates else obstacle(of, name) or "diagnosis.effects does not list it"
            for name in table.index
        ]
    return table
