"""A report and its parts, for the tests of pages."""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from shown_studies import fake

from pyrofit.config import Study
from pyrofit.results.files import Results, write_text
from pyrofit.show.report import write_report
from pyrofit.show.sections import FIGURES, SUBJECTS
from pyrofit.show.table import Frames

LOADS = {"src", "href", "srcset", "data", "poster", "action"}


class Page(HTMLParser):
    """Collects what a page loads, its anchors, its headings and its words."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loads: list[str] = []
        self.ids: list[str] = []
        self.tags: list[str] = []
        self.words = ""
        self.feed(re.sub(r"(<style>|<script>).*?(</style>|</script>)", r"\1\2", text, flags=re.S))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        for name, value in attrs:
            if name in LOADS:
                self.loads.append(value or "")
            if name == "id":
                self.ids.append(value or "")

    def handle_data(self, data: str) -> None:
        self.words += data


def write_tables(study: Study, results: Results) -> None:
    """Write all tables of a study, as the workflow does before the report."""
    for page in SUBJECTS.values():
        for name in page.tables_of(study):
            page.write_table(name, study, results)


def tables_of(study: Study, results: Results) -> Frames:
    """Return all tables of the report, as they were written."""
    pages = SUBJECTS.values()
    return {n: frame for page in pages for n, frame in page.frames(study, results).items()}


def written(root: Path, given: dict[str, Any] | None = None) -> tuple[Page, str]:
    """Write a report with a rectangle for each figure."""
    study, results = fake(root, given)
    for name, figure in FIGURES.items():
        if figure.applies(study):
            write_text(root / "figures" / f"{name}.svg", '<svg width="240.95pt"><rect/></svg>')
    write_tables(study, results)
    write_report(study, results)
    text = (root / "report.html").read_text().replace("\xa0", " ")
    return Page(text), text
