"""Command that scores the stored sets of a finished study again under any cost."""

import argparse
import sys
from pathlib import Path
from typing import Any

from pyrofit.cli.common import open_study
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
    command.add_argument("--cores", type=_cores, default=1, help="processes; default: 1")
    command.add_argument("--results", type=Path, help="results folder; default results/<name>")
    command.add_argument(
        "--digest", help="digest of all inputs of the step; another one is refused"
    )
    command.add_argument("--log", type=Path, help="file that keeps a copy of the output")
    command.set_defaults(step=_rescore)


def _count(text: str) -> int | None:
    if text == "all":
        return None
    if not text.isdigit() or int(text) < 2:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of sets; give 2 or more, or 'all'")
    return int(text)


def _cores(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of cores; give 1 or more")
    return int(text)


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _rescore(given: argparse.Namespace) -> None:
    from pyrofit.results import rescored
    from pyrofit.show.rescore.sentences import sentences
    from pyrofit.show.rescore_page import draw_and_write
    from pyrofit.stages import rescore

    study, results = open_study(given, rescored.slice_of)
    try:
        rescore.rescore(study, results, _tell, given.costs, given.sets, given.cores)
    except (CostError, StudyError) as error:
        raise type(error)(f"{given.study}: {error}") from None
    draw_and_write(study, results)
    for line in sentences(study, results):
        print(line)
