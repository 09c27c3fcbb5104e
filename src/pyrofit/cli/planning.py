"""Command for the worth of planned tests."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell

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
    add_own_options(command, _worth)


def _draws(text: str) -> int:
    if not text.isdigit() or int(text) == 1 or int(text) > 1000:
        raise argparse.ArgumentTypeError(
            f"'{text}' is no number of drawn data sets; give 2 to 1000, or 0 for no check"
        )
    return int(text)


def _worth(given: argparse.Namespace) -> None:
    from pyrofit.results import worth
    from pyrofit.show.worth_page import PAGE
    from pyrofit.stages.worth import worth_of_tests

    study, results = open_study(given, worth.slice_of)
    worth_of_tests(study, results, tell, given.draws, given.cores, given.apparatus)
    show(PAGE, study, results)
