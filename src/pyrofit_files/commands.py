"""Commands that read measured files before there is a study."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.parser import commands_of


def add(commands: Any) -> None:
    """Add these commands."""
    doctor = commands_of(commands, "data").add_parser(
        "doctor", help="recognise the measured files of a folder and report suspected errors"
    )
    doctor.add_argument("folder", type=Path, help="folder, with its subfolders")
    doctor.add_argument(
        "--json", type=Path, metavar="FILE", help="write the report as JSON as well"
    )
    doctor.add_argument(
        "--form",
        type=Path,
        metavar="FILE",
        help="write a form for a contribution to a data base, in Markdown; exit with 2 at "
        "a fault or an unclassified file",
    )
    doctor.add_argument("--notes", action="store_true", help="list placeholders and the like too")
    doctor.add_argument("--short", action="store_true", help="print the counts alone")
    doctor.set_defaults(step=_doctor)

    look = commands.add_parser(
        "look", help="draw measured files as they are understood, before there is a study"
    )
    look.add_argument("files", type=Path, nargs="+", help="measured files, or folders of them")
    look.add_argument(
        "--output",
        type=Path,
        default=Path("look.png"),
        metavar="FILE",
        help="PNG, SVG or HTML file; default: look.png",
    )
    look.set_defaults(step=_look)


def _doctor(given: argparse.Namespace) -> None:
    import json

    from pyrofit_files.form import check_form, form_of
    from pyrofit_files.report import counts, examine_folder, report_as_json, report_lines

    files = examine_folder(given.folder)
    lines = counts(files) if given.short else report_lines(files, given.folder, given.notes)
    for line in lines:
        print(line)
    if given.json is not None:
        text = json.dumps(report_as_json(files, given.folder), indent=1, ensure_ascii=False)
        given.json.write_text(text + "\n", encoding="utf-8")
    if given.form is not None:
        given.form.write_text(form_of(files, given.folder), encoding="utf-8")
        print(f"form written to {given.form}")
        check_form(files, given.form)


def _look(given: argparse.Namespace) -> None:
    from pyrofit_files.look_picture import write
    from pyrofit_files.looked import look_at

    looked = look_at(given.files)
    for line in looked.lines():
        print(line)
    write(looked, given.output)
    print(f"drawn in {given.output}")
