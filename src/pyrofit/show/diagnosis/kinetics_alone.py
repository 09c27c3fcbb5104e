"""Kinetics of the small samples beside those of all signals."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.table import Table

FAR = 3.0
"""Difference in standard deviations that is told."""


def kinetics_alone_table(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters that small samples tell, in the units of the study."""
    rows = []
    for row in diagnosis.read(study, results).kinetics_alone:
        name = row.parameter
        given = study.parameters.get(name)
        factor = given.factor if given else 1.0
        rows.append(
            {
                "parameter": name,
                "meaning": given.label if given else "",
                "unit": given.unit if given else "",
                "alone": row.alone / factor,
                "sd": row.sd / factor,
                "all": row.all / factor,
                "difference": row.difference,
                "remark": "conflict" if abs(row.difference) > FAR else "",
            }
        )
    return pd.DataFrame(rows)


TABLE = Table(
    place=630,
    make=kinetics_alone_table,
    title="Kinetics of the small samples",
    note="The final model fitted to TGA, DSC and MCC alone, and to all signals. The difference is "
    "in standard deviations of the first fit. A conflict means that the slab asks for other "
    "kinetics: an effect on the slab is missing, or the samples differ.",
    headings={"alone": "small samples alone", "sd": "its sd", "all": "all signals"},
)
