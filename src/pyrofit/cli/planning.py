"""Command for the worth of planned tests."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell, whole
from pyrofit.defaults import APPARATUS, DRAWS


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
        default=APPARATUS,
        help="whether flux, thickness, heat losses and temperatures are as described or uncertain "
        f"by their standard deviations; default: {APPARATUS}",
    )
    add_own_options(command, _worth)


def _draws(text: str) -> int:
    return 0 if text == "0" else whole(text, 2, 1000, ", or 0 for no check")


def _worth(given: argparse.Namespace) -> None:
    from pyrofit.results import worth
    from pyrofit.show.worth_page import PAGE
    from pyrofit.stages.worth import worth_of_tests

    study, results = open_study(given, worth.slice_of, given.draws, given.apparatus)
    worth_of_tests(study, results, tell, given.draws, given.cores, given.apparatus)
    show(PAGE, study, results)
