"""Command that draws from the posterior of a finished study and predicts with it."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell
from pyrofit.errors import StudyError

SETS = 100
STEPS = 3000


def add(commands: Any) -> None:
    """Add this command."""
    words = "sample the parameters of a finished study; predict with bands, write an ensemble"
    command = commands.add_parser("posterior", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON)")
    command.add_argument(
        "--sets", type=_sets, default=SETS, help=f"sets of the ensemble; default: {SETS}"
    )
    command.add_argument(
        "--steps", type=_steps, default=STEPS, help=f"steps at most; default: {STEPS}"
    )
    add_own_options(command, _posterior)


def _sets(text: str) -> int:
    return _number(text, 1, 9999, "sets")


def _steps(text: str) -> int:
    return _number(text, 20, 1_000_000, "steps")


def _number(text: str, least: int, most: int, what: str) -> int:
    if not text.isdigit() or not least <= int(text) <= most:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of {what}; give {least} to {most}")
    return int(text)


def _posterior(given: argparse.Namespace) -> None:
    from pyrofit.results import posterior
    from pyrofit.show.posterior_page import PAGE
    from pyrofit.stages.posterior import sample_posterior

    study, results = open_study(given, posterior.slice_of)
    try:
        sample_posterior(study, results, tell, given.sets, given.steps, given.cores)
    except StudyError as error:
        raise StudyError(f"{given.study}: {error}") from None
    show(PAGE, study, results)
