"""The choice of a reaction scheme: tables and figure, and a section of the report."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.parts import Part
from pyrofit.show.step_page import StepPage
from pyrofit.steps.scheme import record
from pyrofit.steps.scheme.figure import FIGURE
from pyrofit.steps.scheme.tables import PARAMETERS, SCHEMES


def _sentences(study: Study, results: Results) -> list[str]:
    found = record.read(study, results)
    return [found.words, found.rule]


def _extended(study: Study, results: Results) -> list[Part]:
    path = results.of_step("scheme", record.read(study, results).extended_study).as_posix()
    return [
        Part(
            "The study with the chosen scheme",
            text=f"{path} is this study with the chosen scheme at its fitted values. It is a "
            "study like any other:",
            command=f"snakemake --cores 2 --configfile {path}",
        )
    ]


PAGE = StepPage(
    folder="scheme",
    heading="Reaction scheme",
    text="The scheme that predicts heating rates left out of its fit.",
    tables={"schemes": SCHEMES, "parameters": PARAMETERS},
    figures={"scheme": FIGURE},
    sentences=_sentences,
    tables_shown=("schemes", "parameters"),
    figures_shown=("scheme",),
    prefix="",
    more=_extended,
)
