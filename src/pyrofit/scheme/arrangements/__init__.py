"""How the reactions of a scheme stand to each other: each file defines one ``ARRANGEMENT``."""

from pyrofit.discovery import contents
from pyrofit.scheme.arrangements.base import Arrangement

ARRANGEMENTS: dict[str, Arrangement] = contents(__name__, __path__, "ARRANGEMENT")
