"""Command that draws from the posterior of a finished study and predicts with it."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell, whole
from pyrofit.defaults import POSTERIOR_SETS, POSTERIOR_STEPS
from pyrofit.errors import StudyError


def add(commands: Any) -> None:
    """Add this command."""
    words = "sample the parameters of a finished study; predict with bands, write an ensemble"
    command = commands.add_parser("posterior", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON)")
    command.add_argument(
        "--sets",
        type=_sets,
        default=POSTERIOR_SETS,
        help=f"sets of the ensemble; default: {POSTERIOR_SETS}",
    )
    command.add_argument(
        "--steps",
        type=_steps,
        default=POSTERIOR_STEPS,
        help=f"steps at most; default: {POSTERIOR_STEPS}",
    )
    add_own_options(command, _posterior)


def _sets(text: str) -> int:
    return whole(text, 1, 9999)


def _steps(text: str) -> int:
    return whole(text, 20, 1_000_000)


def _posterior(given: argparse.Namespace) -> None:
    from pyrofit.results import posterior
    from pyrofit.show.posterior_page import PAGE
    from pyrofit.stages.posterior import sample_posterior

    study, results = open_study(given, posterior.slice_of, given.sets, given.steps)
    try:
        sample_posterior(study, results, tell, given.sets, given.steps, given.cores)
    except StudyError as error:
        raise StudyError(f"{given.study}: {error}") from None
    show(PAGE, study, results)
