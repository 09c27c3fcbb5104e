"""The table of strongly correlated estimates."""

import pandas as pd

from pyrofit.analysis.trade_offs import TradeOff, trade_offs
from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results
from pyrofit.show.names import STAGES
from pyrofit.show.table import Table

COLUMNS = ("fit", "parameter", "rise", "unit", "partner", "shift", "partner_unit", "correlation")


def trade_offs_table(study: Study, results: Results) -> pd.DataFrame:
    """List pairs of parameters with strongly correlated estimates, the strongest first."""
    rows = [_row(pair) for pair in trade_offs(study, identification.read(study, results))]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _row(pair: TradeOff) -> tuple[object, ...]:
    fit = STAGES[pair.stage]
    one, other = (pair.name, pair.rise, pair.unit), (pair.partner, pair.shift, pair.partner_unit)
    return fit, *one, *other, pair.correlation


TABLE = Table(
    place=12,
    make=trade_offs_table,
    title="Correlated estimates",
    note="If a parameter is raised by its standard deviation and all others are fitted "
    "anew, the best value of its partner moves by the shift. The simulated "
    "measurements change little. Pairs with a correlation of 0.7 or more, else the "
    "strongest.",
    headings={
        "rise": "raised by",
        "partner": "partner",
        "shift": "its shift",
        "partner_unit": "its unit",
    },
    group_by="fit",
)
