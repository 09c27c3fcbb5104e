"""The report of a study: one page that needs nothing else, and the provenance beside it."""

from collections.abc import Mapping
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from pyrofit.config import Study, digest
from pyrofit.data.fetch import COMMIT
from pyrofit.files import Results, write_json, write_text
from pyrofit.model.experiment import Signal
from pyrofit.provenance import environment
from pyrofit.report.content import sections, tables_of
from pyrofit.report.determined import verdicts
from pyrofit.report.summary import summary
from pyrofit.report.truth import sentences
from pyrofit.stages import outcomes
from pyrofit.stages.closure import closure_lines
from pyrofit.tables.describe import title_of


def write_report(study: Study, results: Results) -> None:
    """Write ``report.html``, from tables and the drawn figures, and ``provenance.json``.

    Raises
    ------
    DataError
        A result is missing.
    """
    measured = outcomes.measured(study, results)
    origin = provenance(study, measured)
    tables = tables_of(study, results)
    templates = Environment(
        loader=PackageLoader("pyrofit.report", "."),
        autoescape=select_autoescape(("html", "html.j2")),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    page = templates.get_template("report.html.j2").render(
        study=study,
        title=study.title or study.name,
        summary=summary(study, tables)
        + [verdicts(tables)]
        + (sentences(tables["truth"])[:1] if "truth" in tables else []),
        series=_series(study, measured),
        closure=[_titled(study, line) for line in closure_lines(study, measured["signals"])],
        sources=sorted({row["source"] for row in _series(study, measured)}),
        sections=sections(study, results, tables),
        origin=origin,
        description=study.model_dump_json(indent=1, exclude_defaults=True),
    )
    write_json(results.root / "provenance.json", origin)
    write_text(results.root / "report.html", page)


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
