"""What a table is, apart from the numbers in it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results


@dataclass(frozen=True)
class Table:
    """A table: when a study has it, how it is made from results, and how it is read."""

    applies: Callable[[Study], bool]
    make: Callable[[Study, Results], pd.DataFrame]
    title: str
    note: str = ""
    headings: Mapping[str, str] = field(default_factory=dict)
    group_by: str | None = None
    paper: str = ""
    """Table of the paper that it reproduces, such as 'Table 4'."""
    upright: str | None = None
    """Column whose values become the headings where the table is read: few rows, many columns."""
