"""Tables and figures of the preview. No page shows them: they come before any result."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.page import page_of_step
from pyrofit.steps.preview import record
from pyrofit.steps.preview.figures import draw_experiments, read_bands
from pyrofit.steps.preview.sentences import sentences
from pyrofit.steps.preview.tables import TABLES


def _figures(study: Study, results: Results) -> None:
    """Write a figure of each experiment; the folder is there in any case, as the workflow wants."""
    results.of_step("preview", "figures").mkdir(parents=True, exist_ok=True)
    draw_experiments(study, read_bands(results), record.read(results), results, "preview/figures")


PAGE = page_of_step(
    "preview",
    heading="Data against limits",
    text="The data before the band of curves that the limits allow.",
    tables=TABLES,
    figures={},
    sentences=sentences,
    finish=_figures,
)
