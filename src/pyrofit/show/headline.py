"""What a run has found, in a sentence for the terminal, and where its pages lie."""

import contextlib
from collections.abc import Iterator

from pyrofit.config import Study
from pyrofit.errors import PyrofitError
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.answer.chosen import chosen_set
from pyrofit.show.names import all_scored


def ending(study: Study, results: Results, since: float) -> Iterator[str]:
    """Yield the last lines of a run that started at a time: its pages, with what they tell."""
    for name, tell, page in (
        ("Report", headline, results.root / "report.html"),
        ("Diagnosis", verdict, results.diagnosis("report.html")),
    ):
        if page.exists():
            if page.stat().st_mtime >= since:
                with contextlib.suppress(PyrofitError):  # a study of kinetics alone has no such set
                    yield tell(study, results)
            yield f"{name}: {page}"


def headline(study: Study, results: Results) -> str:
    """Return which set predicts held-out tests best, and how well; which set fits best without.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    chosen = chosen_set(study, results)
    name = f"the best set of {chosen.cost_function} ({chosen.found_by})"
    if chosen.held_out:
        return f"Held-out tests: {name} predicts {all_scored(chosen.of(chosen.held_out))}."
    return f"Of all sets, {name} fits best. No test was held out."


def verdict(study: Study, results: Results) -> str:
    """Return the verdict of the diagnosis in words.

    Raises
    ------
    DataError
        The diagnosis is missing or broken.
    """
    return str(diagnosis.read(study, results)["verdict"]["words"])
