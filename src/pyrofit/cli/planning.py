"""Command that tells what planned tests are worth."""

import argparse
import sys
from pathlib import Path
from typing import Any

from pyrofit.cli.common import open_study

DRAWS = 50
"""Drawn data sets of the check unless told otherwise: half a minute."""


def add(commands: Any) -> None:
    """Add this command."""
    words = "by how much planned tests would narrow parameters and predictions"
    command = commands.add_parser("worth", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON)")
    command.add_argument(
        "--draws",
        type=_draws,
        default=DRAWS,
        help=f"drawn data sets that check the best three; 0 = no check; default: {DRAWS}",
    )
    command.add_argument(
        "--apparatus",
        choices=("exact", "uncertain"),
        default="exact",
        help="whether flux, thickness, heat losses and temperatures are as described or uncertain "
        "by their standard deviations; default: exact",
    )
    command.add_argument("--cores", type=_cores, default=1, help="processes; default: 1")
    command.add_argument("--results", type=Path, help="results folder; default results/<name>")
    command.add_argument(
        "--digest", help="digest of all inputs of the step; another one is refused"
    )
    command.add_argument("--log", type=Path, help="file that keeps a copy of the output")
    command.set_defaults(step=_worth)


def _draws(text: str) -> int:
    if not text.isdigit() or int(text) == 1 or int(text) > 1000:
        raise argparse.ArgumentTypeError(
            f"'{text}' is no number of drawn data sets; give 2 to 1000, or 0 for no check"
        )
    return int(text)


def _cores(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of cores; give 1 or more")
    return int(text)


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _worth(given: argparse.Namespace) -> None:
    from pyrofit.results import worth
    from pyrofit.show.worth.sentences import sentences
    from pyrofit.show.worth_page import draw_and_write
    from pyrofit.stages.worth import worth_of_tests

    study, results = open_study(given, worth.slice_of)
    worth_of_tests(study, results, _tell, given.draws, given.cores, given.apparatus)
    draw_and_write(study, results)
    for line in sentences(study, results):
        print(line)
