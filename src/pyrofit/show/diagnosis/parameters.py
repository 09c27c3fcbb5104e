"""Parameters of the model, without and with the effects found."""

import numpy as np
import pandas as pd

from pyrofit.config import Study, diagnosed_material, parameters_in
from pyrofit.config.resolve import calibrated
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import leading
from pyrofit.show.table import Table


def parameters_table(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters that fitted tests use, without and with the effects of the verdict."""
    found = diagnosis.read(study, results)
    after = found.extended.parameters if leading(found) else {}
    used = parameters_in(diagnosed_material(study), *calibrated(study).values())
    rows = [
        {
            "parameter": name,
            "meaning": study.parameters[name].label if name in study.parameters else "",
            "unit": p.unit,
            "base": p.value,
            "base_low": p.low,
            "base_high": p.high,
            "at_limit": "yes" if p.at_limit else "",
            **{
                key: getattr(after[name], of) if name in after else np.nan
                for key, of in _AFTER.items()
            },
            "extended_at_limit": "yes" if name in after and after[name].at_limit else "",
        }
        for name, p in found.base.parameters.items()
        if name in used
    ]
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


_AFTER = {"extended": "value", "extended_low": "low", "extended_high": "high"}


TABLE = Table(
    place=700,
    make=parameters_table,
    title="Parameters of the model",
    note="95 % intervals, each model taken as right. A parameter at a limit may compensate for a "
    "missing effect. Parameters of held-out tests alone are not listed.",
    headings={
        "base_low": "95 % low",
        "base_high": "95 % high",
        "at_limit": "at a limit",
        "extended_at_limit": "at a limit ",
        "extended": "with effects",
        "extended_low": "95 % low ",
        "extended_high": "95 % high ",
    },
)
