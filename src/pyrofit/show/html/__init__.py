"""A page that needs nothing else: measurements, sections, provenance."""

import re
from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup, escape

from pyrofit.config import Study, digest
from pyrofit.data.fetch import COMMIT
from pyrofit.plugins import plugin_files
from pyrofit.provenance import environment
from pyrofit.results.code_digests import code
from pyrofit.results.recorded import Measured
from pyrofit.show import measured as measurements
from pyrofit.show.parts import Passage, Picture, Question, Section
from pyrofit.show.text import typeset


def page_of(
    study: Study,
    measured: Measured,
    title: str,
    summary: Sequence[Question],
    sections: Sequence[Section | None],
    answer: Section | None = None,
    lacks: str = "",
    use: measurements.Use = measurements.use_in_campaign,
) -> str:
    """Return a page as HTML: questions of the summary, the data, sections, provenance.

    Sections that are none are left out. The table of ``answer`` follows a question that asks for
    it, its pictures end the summary, and ``lacks`` names the missing effects. Each is left out
    where there is none. ``use`` returns the use of each series in words.
    """
    parts = answer.parts if answer else ()
    template = _templates().get_template("report.html.j2")
    return template.render(
        study=study,
        title=title,
        summary=summary,
        series=measurements.rows_of_series(study, measured, use),
        notes=measurements.notes(study, measured.about),
        pictures=[part for part in parts if isinstance(part, Picture)],
        answer=next((part for part in parts if isinstance(part, Passage)), None),
        lacks=lacks,
        costs=list(study.imp.costs),
        closure=measurements.closure(study, measured.about),
        sources=len({a.source for s in measured.about.values() for a in s.values()}),
        sections=[section for section in sections if section],
        origin=provenance(study, measured),
        description=study.model_dump_json(indent=1, exclude_defaults=True),
    )


def _templates() -> Environment:
    templates = Environment(
        loader=PackageLoader("pyrofit.show.html", "."),
        autoescape=select_autoescape(("html", "html.j2")),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters["typeset"] = _typeset
    return templates


def _typeset(text: str) -> Markup:
    r"""Set a text, with commands between backticks as code.

    >>> str(_typeset("`pyrofit run <STUDY>` takes 8 s"))
    '<code>pyrofit run &lt;STUDY&gt;</code> takes 8\xa0s'
    """
    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(typeset(text)))))


def provenance(study: Study, measured: Measured) -> dict[str, Any]:
    """Return the basis of the results; the same for the same study, data and environment."""
    return {
        "study": study.name,
        "config_digest": digest(study.model_dump(mode="json")),
        "seed": study.seed,
        "synthetic_data": study.is_synthetic,
        "macfp_commit": COMMIT if study.needs_macfp else "",
        **environment(),
        "code": code(study),
        "plugins": {
            name: sha256(path.read_bytes()).hexdigest()
            for name, path in plugin_files([Path(folder) for folder in study.plugins]).items()
        },
        "data": {
            f"{name}/{signal}": about.model_dump(include={"source", "sha256"})
            for name, signals in measured.about.items()
            for signal, about in signals.items()
        },
    }
