"""Command that scores the stored sets of a finished study again under any cost."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell
from pyrofit.errors import CostError, StudyError

SETS = 3000
"""Sets that are scored unless told otherwise: some seconds."""


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
        "--sets", type=_count, default=SETS, help=f"how many sets, or 'all'; default: {SETS}"
    )
    add_own_options(command, _rescore)


def _count(text: str) -> int | None:
    if text == "all":
        return None
    if not text.isdigit() or int(text) < 2:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of sets; give 2 or more, or 'all'")
    return int(text)


def _rescore(given: argparse.Namespace) -> None:
    from pyrofit.results import rescored
    from pyrofit.show.rescore_page import PAGE
    from pyrofit.stages import rescore

    study, results = open_study(given, rescored.slice_of)
    try:
        rescore.rescore(study, results, tell, given.costs, given.sets, given.cores)
    except (CostError, StudyError) as error:
        raise type(error)(f"{given.study}: {error}") from None
    show(PAGE, study, results)
