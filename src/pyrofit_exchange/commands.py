"""Commands that write and read files of other programs."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_step, open_study, study_with_results, tell


def add(commands: Any) -> None:
    """Add these commands."""
    export = commands.add_parser("export", help="write a fitted material for another program")
    programs = export.add_subparsers(dest="program", required=True, metavar="PROGRAM")
    fds = _program(programs, "fds", "a file to include, and decks that check it", _export_fds)
    fds.add_argument("--fds-version", default="6.7", help="6.7 (default) or 6.8+")
    fds.add_argument("--log", type=Path, help="file that keeps a copy of the output")
    _program(programs, "gpyro", "input files `.data`", _export_other)
    _program(programs, "thermakin", "input files `.cmp` and `.cnd`", _export_other)
    spyro = _program(programs, "spyro", "reference curves for FDS 6.8 and newer", _export_other)
    spyro.add_argument("--curves", choices=("simulated", "measured"), default="simulated")
    imports = commands.add_parser("import", help="read a material of another program")
    sources = imports.add_subparsers(dest="program", required=True, metavar="PROGRAM")
    matl = sources.add_parser("fds", help="MATL lines become the material of a study")
    matl.add_argument("file", type=Path, help="file with MATL, RAMP and SURF lines")
    matl.add_argument("--surf", default="", help="SURF line of the virgin material; default: first")
    matl.add_argument("--fds-version", default="6.8+", help="such as 6.7.4; default: 6.8+")
    matl.add_argument("--out", type=Path, help="YAML file; default: standard output")
    matl.set_defaults(step=_import_fds)
    check = add_step(commands, "fds-check", "run the decks in a real FDS and compare", _check_fds)
    check.add_argument("--set", default="", help="as of `export fds`")
    check.add_argument("--limit", type=float, default=1200.0, help="time limit of a run [s]")


def _program(
    programs: Any, name: str, text: str, step: Callable[[argparse.Namespace], None]
) -> Any:
    """Add a program that a study is written for."""
    parser = programs.add_parser(name, help=text)
    parser.add_argument("study", type=Path, help="study file (YAML or JSON)")
    parser.add_argument(
        "--set", default="", help="estimates (default), a cost's, truth, diagnosis, or a JSON"
    )
    parser.add_argument("--results", type=Path, help="results folder; default results/<name>")
    parser.add_argument("--out", type=Path, help=f"folder; default results/<name>/{name}")
    parser.set_defaults(step=step)
    return parser


def _export_other(given: argparse.Namespace) -> None:
    from pyrofit_exchange import programs
    from pyrofit_exchange.sets import parameter_set

    study, results = study_with_results(given)
    chosen = parameter_set(study, results, given.set, given.study.parent)
    folder = given.out or results.root / given.program
    if given.program == "spyro":
        measured = given.curves == "measured"
        said = programs.export_spyro(study, chosen, results, folder, measured)
    elif given.program == "gpyro":
        said = programs.export_gpyro(study, chosen, folder)
    else:
        said = programs.export_thermakin(study, chosen, folder)
    for line in said:
        print(line)
    print(f"{folder}: set '{chosen.label}' for {given.program}")


def _export_fds(given: argparse.Namespace) -> None:
    from pyrofit_exchange.fds.export import MATERIAL, export
    from pyrofit_exchange.fds.versions import version_of
    from pyrofit_exchange.sets import parameter_set

    version = version_of(given.fds_version)
    study, results = study_with_results(given)
    chosen = parameter_set(study, results, given.set, given.study.parent)
    folder = given.out or results.fds("")
    for line in export(study, chosen, version, folder, []):
        print(line)
    print(f"{folder / MATERIAL}: set '{chosen.label}' for FDS {version.name}, decks beside it")


def _check_fds(given: argparse.Namespace) -> None:
    from pyrofit.external.fds import find_fds
    from pyrofit_exchange import fds_page
    from pyrofit_exchange.fds.check import check_decks
    from pyrofit_exchange.sets import parameter_set

    study, results = open_study(given)
    chosen = parameter_set(study, results, given.set, given.study.parent)
    check_decks(study, chosen, find_fds(), results.fds(""), tell, given.limit)
    fds_page.draw_and_write(study, results)
    print(f"{results.fds('check.md')}: FDS beside pyrofit", file=sys.stderr)


def _import_fds(given: argparse.Namespace) -> None:
    from pyrofit.config import as_yaml
    from pyrofit.results.files import write_text
    from pyrofit_exchange.fds.imported import import_fds
    from pyrofit_exchange.fds.versions import FdsError, version_of

    try:
        text = given.file.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise FdsError(f"{given.file}: cannot be read ({error.strerror})") from None
    version = version_of(given.fds_version)
    found = import_fds(text, str(given.file), version, given.surf)
    comment = "\n".join([f"Material of {given.file.name}, for a study.", *found.remarks])
    content = as_yaml({"material": found.material}, comment)
    for remark in found.remarks:
        print(remark, file=sys.stderr)
    if given.out is None:
        print(content, end="")
    else:
        write_text(given.out, content)
