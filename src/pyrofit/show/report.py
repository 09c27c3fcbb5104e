"""The report of a study: one page that needs nothing else, and the provenance beside it."""

from pyrofit.config import Study
from pyrofit.discovery import added, loaded
from pyrofit.results import diagnosis, recorded
from pyrofit.results.files import Results, write_json, write_text
from pyrofit.show import diagnosis_page, programs_page
from pyrofit.show.facts import facts_of
from pyrofit.show.html import page_of, provenance
from pyrofit.show.page import pages_of_steps
from pyrofit.show.sections import SUBJECTS
from pyrofit.show.subjects.answer.summary import summary


def write_report(study: Study, results: Results) -> None:
    """Write ``report.html``, from the written tables and drawn figures, and ``provenance.json``.

    Raises
    ------
    DataError
        A result is missing.
    """
    measured = recorded.measured(study, results)
    frames = {name: page.frames(study, results) for name, page in SUBJECTS.items()}
    facts = facts_of(study, results, {n: f for of in frames.values() for n, f in of.items()})
    answer, *shown = [
        page.section(study, results, facts, frames[name]) for name, page in SUBJECTS.items()
    ]
    apart = [*(loaded(point) for point in added("pages").values()), programs_page.PAGE]
    shown += [
        page.section(study, results)
        for page in (
            *pages_of_steps("report", study, results),
            *(page for page in apart if page.exists(study, results)),
        )
    ]
    made = provenance(study, measured)
    if programs_page.was_tried(study, results):
        made["programs"] = programs_page.origin_of_runs(results)
    lacks = ""
    if diagnosis_page.is_drawn(study, results):
        found = diagnosis.read(study, results)
        lacks = found.verdict.words
        shown.append(diagnosis_page.page_of_diagnosis(study, found).section(study, results, found))
        shown += [
            page.section(study, results) for page in pages_of_steps("diagnosis", study, results)
        ]
    said = summary(study, facts)
    title = study.title or study.name
    text = page_of(study, measured, title, said, shown, answer, lacks)
    write_json(results.root / "provenance.json", made)
    write_text(results.root / "report.html", text)
