"""The report of a study: one page that needs nothing else, and the provenance beside it."""

from pyrofit.config import Study
from pyrofit.report import diagnosis
from pyrofit.report.answer import advice
from pyrofit.report.content import sections, table_part, tables_of
from pyrofit.report.page import page_of, provenance
from pyrofit.report.summary import summary
from pyrofit.results import recorded
from pyrofit.results.files import Results, write_json, write_text
from pyrofit.tables import TABLES


def write_report(study: Study, results: Results) -> None:
    """Write ``report.html``, from tables and the drawn figures, and ``provenance.json``.

    Raises
    ------
    DataError
        A result is missing.
    """
    origin = provenance(study, recorded.summary(study, results))
    tables = tables_of(study, results)
    said = summary(study, tables)
    answer = table_part(study, TABLES["answer"], tables["answer"], advice(study, tables))
    shown = sections(study, results, tables)
    # The diagnosis is a step of its own, which a study may go without.
    lacks = ""
    if diagnosis.exists(results):
        lacks = diagnosis.headline(study, results)
        shown.append(diagnosis.section(study, results))
    text = page_of(study, results, study.title or study.name, said, shown, answer, lacks)
    write_json(results.root / "provenance.json", origin)
    write_text(results.root / "report.html", text)
