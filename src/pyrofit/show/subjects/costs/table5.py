"""Table 5: symbols and units."""

from collections.abc import Iterable

import pandas as pd

from pyrofit.config import Study
from pyrofit.model.base import numbers
from pyrofit.show.table import Row, Table

# PAPER: Table 5 prints kJ/kg for E and m/K for k; Table 3 has kJ/kmol, and k is in W/(m K).
_SYMBOLS: tuple[tuple[str, str, str, str, str], ...] = (
    ("E", "activation energy", "kJ/kmol", "J/mol", "E_J_mol"),
    ("ρ", "density", "kg/m3", "kg/m3", "density_kg_m3"),
    ("ε", "emissivity", "-", "-", "emissivity"),
    ("Δh", "heat of reaction", "kJ/kg", "J/kg", "heat_of_reaction_J_kg"),
    ("MLR", "mass loss rate", "kg/(s m2)", "kg/(m2 s)", ""),
    ("A", "pre-exponential factor", "1/s", "1/s", "A_1_s"),
    ("T", "temperature", "°C", "K", "reference_temperature_K"),
    ("k", "thermal conductivity", "W/(m K)", "W/(m K)", "conductivity_W_mK"),
    ("t", "time", "s", "s", ""),
    ("c_p", "specific heat capacity", "kJ/(kg K)", "J/(kg K)", "specific_heat_J_kgK"),
    ("σ", "standard deviation", "as the data", "as the data", ""),
    ("n", "reaction order", "-", "-", "order"),
)
"""Table 5 by row: symbol, quantity, the paper's unit put right, SI unit, key of a study."""


_OF_A_PROPERTY = ("value", "of", "step")
"""Keys below that of a property whose number is the property itself."""


def table5(study: Study, results: object) -> pd.DataFrame:
    """Table 5: symbols and units, and which parameters of the study stand for each.

    Returns
    -------
    pandas.DataFrame
        One row per symbol of the paper, its order kept; then one for each parameter of the study
        that stands for none of these. ``paper_unit`` is the paper's, put right.
    """
    keys = _keys_of_parameters(study)
    rows = []
    for symbol, quantity, paper_unit, si_unit, key in _SYMBOLS:
        here = [name for name in study.parameters if key in keys[name]]
        rows.append(_row(symbol, quantity, paper_unit, si_unit, here, study))
    known = {key for *_, key in _SYMBOLS}
    for name, parameter in study.parameters.items():
        if not keys[name] & known:
            rows.append(_row(name, parameter.label, "", "", [name], study))
    return pd.DataFrame(rows)


def _row(
    symbol: str, quantity: str, paper: str, si: str, names: Iterable[str], study: Study
) -> Row:
    return {
        "symbol": symbol,
        "quantity": quantity,
        "paper_unit": paper,
        "si_unit": si,
        "parameters": ", ".join(f"{name} [{study.parameters[name].unit}]" for name in names),
    }


def _keys_of_parameters(study: Study) -> dict[str, set[str]]:
    """Return the keys of material and experiments that each parameter stands at."""
    found: dict[str, set[str]] = {name: set() for name in study.parameters}
    for part in (study.material, *study.experiments.values()):
        for place, value, _ in numbers(part):
            if isinstance(value, str):
                *_, key = (
                    key
                    for key in place.split(".")
                    if not key.isdigit() and key not in _OF_A_PROPERTY
                )
                found[value].add(key)
    return found


TABLE = Table(
    place=20,
    applies=lambda study: study.published is not None,
    make=table5,
    title="Symbols and units",
    paper="Table 5",
    note="Lauer et al. 2020 print kJ/kg for E and m/K for k, two misprints. This table has "
    "kJ/kmol, as in their Table 3, and W/(m K). kJ/kmol is the same number as J/mol. "
    "The code and its files of results are in SI units; a parameter is given and "
    "shown in the unit behind its name. Where T stands for A, it is the temperature "
    "at which the rate constant has a given value.",
    headings={
        "paper_unit": "unit in Lauer et al. (2020), corrected",
        "si_unit": "SI unit",
        "parameters": "parameters of this study [unit]",
    },
)
