"""Commands that show the results: tables, figures, the report, an archive."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_step, open_study


def add(commands: Any) -> None:
    """Add these commands."""
    shown = add_step(commands, "show", "write tables and figures", _show)
    which = shown.add_mutually_exclusive_group(required=True)
    which.add_argument("--subject", help="section of the report whose tables and figures to write")
    which.add_argument("--name", nargs="+", help="names of tables and figures")
    add_step(commands, "report", "write report.html and provenance.json", _report)
    archive = add_step(
        commands, "archive", "put all of a study in one file, to be run again", _archive
    )
    archive.add_argument(
        "--given", type=Path, nargs="+", help="study files; default: that of --study"
    )


def _show(given: argparse.Namespace) -> None:
    from pyrofit.show.sections import make_named, make_subject

    study, results = open_study(given)
    if given.subject is not None:
        make_subject(given.subject, study, results)
    for name in given.name or ():
        make_named(name, study, results)


def _report(given: argparse.Namespace) -> None:
    from pyrofit.show.report import write_report

    write_report(*open_study(given))


def _archive(given: argparse.Namespace) -> None:
    from pyrofit.archive import write_archive

    study, results = open_study(given)
    print(write_archive(study, results, given.given or [given.study], Path()))
