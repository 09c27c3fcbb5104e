"""The report of a study: one page that needs nothing else, and the provenance beside it."""

from typing import Any

from pyrofit.config import Study
from pyrofit.discovery import added, loaded
from pyrofit.results import diagnosis, recorded
from pyrofit.results.files import Results, write_json, write_text
from pyrofit.show import (
    diagnosis_page,
    programs_page,
)
from pyrofit.show.answer import ANSWER
from pyrofit.show.answer.summary import summary
from pyrofit.show.facts import Facts, facts_of
from pyrofit.show.names import titled
from pyrofit.show.page import page_of, provenance
from pyrofit.show.parts import Part, Picture, Shown, picture, table_part
from pyrofit.show.section import Section
from pyrofit.show.sections import SECTIONS, TABLES
from pyrofit.show.step_page import sections_of
from pyrofit.show.table import Frames, read_table


def write_report(study: Study, results: Results) -> None:
    """Write ``report.html``, from the written tables and drawn figures, and ``provenance.json``.

    Raises
    ------
    DataError
        A result is missing.
    """
    measured = recorded.measured(study, results)
    tables = tables_of(study, results)
    facts = facts_of(study, results, tables)
    answer = (
        _pictures(ANSWER, study, results, facts),
        table_part(study, TABLES["answer"], tables["answer"]),
    )
    shown = [one for part in SECTIONS if (one := _shown(part, study, results, facts))]
    shown += sections_of("report", study, results)
    shown += [page.section(study, results) for page in _pages() if page.exists(results)]
    made = provenance(study, measured)
    if programs_page.exists(study, results):
        shown.append(programs_page.section(study, results))
        made["programs"] = programs_page.origin(results)
    lacks = ""
    if diagnosis_page.exists(results):
        found = diagnosis.read(study, results)
        lacks = found.verdict.words
        shown.append(diagnosis_page.section(study, results, found))
        shown += sections_of("diagnosis", study, results)
    said = summary(study, facts)
    text = page_of(study, measured, study.title or study.name, said, shown, *answer, lacks)
    write_json(results.root / "provenance.json", made)
    write_text(results.root / "report.html", text)


def _pages() -> list[Any]:
    """Return the modules of other packages that add a section: ``exists`` and ``section``."""
    return [loaded(point) for point in added("pages").values()]


def tables_of(study: Study, results: Results) -> Frames:
    """Return all tables that the study has, by name, as they were written."""
    return {n: read_table(results, n) for n, table in TABLES.items() if table.applies(study)}


def _shown(section: Section, study: Study, results: Results, facts: Facts) -> Shown | None:
    """Return a section with the parts that the study has, none where it has no part."""
    parts: list[Part | Picture] = []
    for name in section.items:
        if name in facts.tables:
            parts.append(table_part(study, section.tables[name], facts.tables[name]))
        elif name in section.figures:
            parts += _pictures(section, study, results, facts, name)
    if not parts:
        return None
    said = section.sentences(study, facts)
    return Shown(
        section.anchor, section.heading, section.text, tuple(parts), tuple(said), section.folded
    )


def _pictures(
    section: Section, study: Study, results: Results, facts: Facts, only: str | None = None
) -> list[Picture]:
    """Return the figures of a section that the study has, or the one of a name."""
    names = section.figures_of(study)
    found = []
    for name in names if only is None else [n for n in names if n == only]:
        figure, path = section.figures[name], results.root / "figures" / f"{name}.svg"
        title = titled(study, figure.title, figure.paper)
        verdict = "" if figure.verdict is None else figure.verdict(study, facts)
        found.append(picture(path, name, title, figure.caption, verdict))
    return found
