"""How far estimates are from the truth, in sentences."""

import pandas as pd

from pyrofit.analysis.recovery import KINETICS
from pyrofit.analysis.uses import SCEUA
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.show.facts import Facts

FOUND_BY = {"sceua": SCEUA, **{key: by.words for key, by in OPTIMISERS.items()}}
"""Optimisers in words, by the beginning of their columns."""


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the sentences of the section."""
    return errors_of_sets(facts.tables["truth"])


def errors_of_sets(table: pd.DataFrame) -> list[str]:
    """Return a sentence on the best sets of each optimiser, and one on the kinetics.

    Parameters
    ----------
    table
        The table 'truth'.

    Examples
    --------
    >>> columns = {f"{by}_error_limits_percent": [-12.0, 0.5] for by in FOUND_BY}
    >>> frame = pd.DataFrame({"fit": "RMSE", "parameter": ["k", "rho"], **columns})
    >>> errors_of_sets(frame)[1].split(": ")[1]
    '12 % in k, at most 0.5 % in the others (RMSE).'
    """
    costs = table[table["fit"] != KINETICS]
    said = [
        f"Errors of the best sets of {name}, largest per fit, in per cent of the search range: "
        + "; ".join(f"{_worst(part, by)} ({fit})" for fit, part in costs.groupby("fit", sort=False))
        + "."
        for by, name in _found_by(costs).items()
    ]
    kinetics = table[table["fit"] == KINETICS]
    if len(kinetics):
        found = _found_by(kinetics)
        off = "; ".join(f"{_worst(kinetics, by)} ({name})" for by, name in found.items())
        said.append(f"The kinetics are off by: {off}.")
    return said


def _found_by(part: pd.DataFrame) -> dict[str, str]:
    """Return the optimisers that some fits have errors of."""
    errors = {by: part.get(f"{by}_error_limits_percent") for by in FOUND_BY}
    return {
        by: name
        for by, name in FOUND_BY.items()
        if (column := errors[by]) is not None and column.notna().any()
    }


def _worst(part: pd.DataFrame, by: str) -> str:
    """Say the largest error of a set, and that of the others."""
    errors = (
        part.set_index("parameter")[f"{by}_error_limits_percent"].abs().sort_values(kind="stable")
    )
    *others, largest = [f"{x:.2g} %" for x in errors]
    rest = f", at most {others[-1]} in the others" if others else ""
    return f"{largest} in {errors.index[-1]}{rest}"
