"""Command of the choice of a reaction scheme."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_step, open_study, tell


def add(commands: Any) -> None:
    """Add this command."""
    command = add_step(commands, "scheme", "choose the reaction scheme from TGA", _scheme)
    command.add_argument(
        "--write", type=Path, metavar="FILE", help="write the study with the chosen scheme there"
    )


def _scheme(given: argparse.Namespace) -> None:
    from pyrofit.results import dependencies
    from pyrofit.results import scheme as results_of
    from pyrofit.show.scheme_page import draw_and_write
    from pyrofit.stages import measurements, scheme

    study, results = open_study(given, dependencies.scheme)
    if given.digest is None:  # by hand, without the workflow that has read the measurements
        measurements.prepare(study, results)
    found = scheme.choose(study, results, tell)
    draw_and_write(study, results)
    print(results_of.read(study, results).words)
    path = results.scheme(results_of.EXTENDED)
    if given.write is not None:
        path = given.write
        scheme.write_study(study, results, found, path)
    tell(f"{path}: the study with the chosen scheme")
