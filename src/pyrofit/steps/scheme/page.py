"""The choice of a reaction scheme: tables and figure, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.page import page_of_step
from pyrofit.show.parts import Passage, study_to_run
from pyrofit.steps.scheme import record
from pyrofit.steps.scheme.figure import FIGURE
from pyrofit.steps.scheme.tables import PARAMETERS, SCHEMES


def _sentences(study: Study, results: Results) -> list[str]:
    found = record.read(study, results)
    return [found.words, found.rule]


def _extended(study: Study, results: Results) -> list[Passage]:
    path = results.of_step("scheme", record.read(study, results).extended_study)
    return [study_to_run("chosen scheme", "chosen scheme at its fitted values", path)]


PAGE = page_of_step(
    "scheme",
    heading="Reaction scheme",
    text="The scheme that predicts heating rates left out of its fit.",
    tables={"schemes": SCHEMES, "parameters": PARAMETERS},
    figures={"scheme": FIGURE},
    sentences=_sentences,
    prefix="",
    more=_extended,
)
