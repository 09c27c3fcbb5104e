"""Stability of a diagnosis: tables and figure, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results import stability
from pyrofit.results.files import Results
from pyrofit.show.parts import Shown
from pyrofit.show.stability.figures import FIGURES
from pyrofit.show.stability.sentences import sentences
from pyrofit.show.stability.tables import TABLES
from pyrofit.show.step_page import StepPage

PAGE = StepPage(
    folder="stability",
    heading="Stability of the diagnosis",
    text="How often data changed by a small part of their noise lead to the same effects.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
    tables_shown=tuple(TABLES),
    figures_shown=tuple(FIGURES),
)


def sections(study: Study, results: Results) -> list[Shown]:
    """Return the section, or none where tables and figure are not up to date."""
    return [PAGE.section(study, results)] if stability.version(study, results) else []
