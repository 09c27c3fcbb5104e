"""Commands that show what was found: tables, figures, the report, an archive."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_step, open_study


def add(commands: Any) -> None:
    """Add these commands."""
    table = add_step(commands, "table", "write one table", _table)
    table.add_argument("--name", required=True, help="name of the table")
    figure = add_step(commands, "figure", "draw one figure", _figure)
    figure.add_argument("--name", required=True, help="name of the figure")
    add_step(commands, "report", "write report.html and provenance.json", _report)
    archive = add_step(
        commands, "archive", "put all of a study in one file, to be run again", _archive
    )
    archive.add_argument(
        "--given", type=Path, nargs="+", help="study files; default: that of --study"
    )


def _table(given: argparse.Namespace) -> None:
    from pyrofit.results import dependencies
    from pyrofit.show.sections import make_table

    make_table(given.name, *open_study(given, dependencies.presentation))


def _figure(given: argparse.Namespace) -> None:
    from pyrofit.results import dependencies
    from pyrofit.show.sections import make_figure

    make_figure(given.name, *open_study(given, dependencies.presentation))


def _report(given: argparse.Namespace) -> None:
    from pyrofit.results import dependencies
    from pyrofit.show.report import write_report

    write_report(*open_study(given, dependencies.presentation))


def _archive(given: argparse.Namespace) -> None:
    from pyrofit.archive import write_archive
    from pyrofit.results import dependencies

    study, results = open_study(given, dependencies.presentation)
    print(write_archive(study, results, given.given or [given.study], Path()))
