"""A page that needs nothing else: what was measured, sections, and what all of it rests on."""

from collections.abc import Mapping, Sequence
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from pyrofit.config import Study, digest
from pyrofit.data.fetch import COMMIT
from pyrofit.files import Results
from pyrofit.model.experiment import Signal
from pyrofit.provenance import environment
from pyrofit.report.content import Section
from pyrofit.stages import outcomes
from pyrofit.stages.closure import closure_lines
from pyrofit.tables.describe import title_of


def page_of(
    study: Study,
    results: Results,
    title: str,
    summary: Sequence[str],
    sections: Sequence[Section],
) -> str:
    """Return a page as HTML: sentences of the summary, the data, sections, provenance.

    Raises
    ------
    DataError
        The measurements have not been read.
    """
    measured = outcomes.measured(study, results)
    series = _series(study, measured)
    templates = Environment(
        loader=PackageLoader("pyrofit.report", "."),
        autoescape=select_autoescape(("html", "html.j2")),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return templates.get_template("report.html.j2").render(
        study=study,
        title=title,
        summary=summary,
        series=series,
        closure=[_titled(study, line) for line in closure_lines(study, measured["signals"])],
        sources=sorted({row["source"] for row in series}),
        sections=sections,
        origin=provenance(study, measured),
        description=study.model_dump_json(indent=1, exclude_defaults=True),
    )


def provenance(study: Study, measured: dict[str, Any]) -> dict[str, Any]:
    """Return what the results rest on; the same for the same study, data and environment."""
    return {
        "study": study.name,
        "config_digest": digest(study.model_dump(mode="json")),
        "seed": study.seed,
        "synthetic_data": study.is_synthetic,
        "macfp_commit": COMMIT if study.needs_macfp else "",
        **environment(),
        "data": {
            f"{name}/{signal}": {"source": about["source"], "sha256": about["sha256"]}
            for name, signals in measured["signals"].items()
            for signal, about in signals.items()
        },
    }


def _series(study: Study, measured: dict[str, Any]) -> list[dict[str, Any]]:
    return [
        {
            "experiment": title_of(study, name),
            "signal": signal.replace("_", " ").replace("mlr", "mass loss rate"),
            "points": about["points"],
            "source": about["source"],
            "uncertainty": about.get("uncertainty", _noise(study, name, signal)),
            "notes": about.get("notes", []),
        }
        for name, signals in measured["signals"].items()
        for signal, about in signals.items()
    ]


def _noise(study: Study, experiment: str, signal: str) -> str:
    signals: Mapping[str, Signal] = study.experiments[experiment].signals
    return "standard deviation of the noise" if signals[signal].noise.sd > 0.0 else ""


def _titled(study: Study, line: str) -> str:
    """Put titles in place of the experiments' names at the start of a line."""
    head, colon, rest = line.partition(": ")
    names = [title_of(study, n) if n in study.experiments else n for n in head.split(" and ")]
    return " and ".join(names) + colon + rest
