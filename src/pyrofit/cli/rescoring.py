"""Command that scores the stored sets of a finished study again under any cost."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell, whole
from pyrofit.defaults import RESCORED_SETS
from pyrofit.errors import CostError, StudyError

MOST_SETS = 1_000_000_000


def add(commands: Any) -> None:
    """Add this command."""
    words = "score the stored sets of a finished study again under any cost"
    command = commands.add_parser("rescore", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON)")
    command.add_argument(
        "--cost",
        dest="costs",
        nargs="+",
        default=[],
        metavar="NAME",
        help="cost functions of the study, or costs of docs/rescore.md; default: all",
    )
    command.add_argument(
        "--sets",
        type=_count,
        default=RESCORED_SETS,
        help=f"how many sets, or 'all'; default: {RESCORED_SETS}",
    )
    add_own_options(command, _rescore)


def _count(text: str) -> int | None:
    return None if text == "all" else whole(text, 2, MOST_SETS, ", or 'all'")


def _rescore(given: argparse.Namespace) -> None:
    from pyrofit.results import rescored
    from pyrofit.show.rescore_page import PAGE
    from pyrofit.stages import rescore

    study, results = open_study(given, rescored.slice_of, given.costs, given.sets)
    try:
        rescore.rescore(study, results, tell, given.costs, given.sets, given.cores)
    except (CostError, StudyError) as error:
        raise type(error)(f"{given.study}: {error}") from None
    show(PAGE, study, results)
