"""Results of the diagnosis, a step of its own: each file defines a table or a figure."""

from pyrofit.discovery import contents
from pyrofit.show.figure import Figure
from pyrofit.show.table import Table

TABLES: dict[str, Table] = contents(__name__, __path__, "TABLE")
FIGURES: dict[str, Figure] = contents(__name__, __path__, "FIGURE")
