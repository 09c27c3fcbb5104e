"""Activation energies over conversion, with their errors."""

import pandas as pd

from pyrofit.analysis.isoconversional.records import applies
from pyrofit.config import Study
from pyrofit.results import isoconversional
from pyrofit.results.files import Results
from pyrofit.show.subjects.isoconversional.names import METHODS
from pyrofit.show.table import Table

_KEYS = [key for method in METHODS for key in (method, f"{method}_error")]
_MODEL = "model_vyazovkin"


def isoconversional_energies(study: Study, results: Results) -> pd.DataFrame:
    """List E of each method with its error, and that of the fitted model, by conversion.

    Returns
    -------
    pandas.DataFrame
        One row per level of conversion; energies in kJ/mol, none where too few records tell one.
    """
    table = isoconversional.energies(results)
    frame = table[["conversion"]].assign(**{"temperature [°C]": table["temperature_K"] - 273.15})
    for key in [*_KEYS, _MODEL]:
        if f"{key}_kJ_mol" in table:
            column = table[f"{key}_kJ_mol"].astype(object)
            frame[f"{key} [kJ/mol]"] = column.where(column.notna(), None)
    return frame


TABLE = Table(
    place=20,
    applies=applies,
    make=isoconversional_energies,
    title="Activation energies over conversion",
    note="± is half of a 95 % interval. It rests on the scatter of the points and on the "
    "temperature between records: by repeats, else 0.5 K. It is wider where the rates depart from "
    "one activation energy. The temperature is the mean over the records. KAS is for constant "
    "heating rates. Sources: Vyazovkin et al. 2011, doi 10.1016/j.tca.2011.03.034.",
    headings={
        **METHODS,
        **{f"{method}_error": f"± {words}" for method, words in METHODS.items()},
        _MODEL: "fitted model (Vyazovkin)",
    },
)
