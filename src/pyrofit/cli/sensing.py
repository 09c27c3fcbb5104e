"""Command for the sensitivity of a study's signals and costs to their inputs."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell

SAMPLES = 1024
"""Base points unless told otherwise: some ten seconds."""
WITHIN = ("limits", "near", "intervals")


def add(commands: Any) -> None:
    """Add this command."""
    words = "variance-based sensitivity of signals over time and of costs"
    command = commands.add_parser("sensitivity", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON)")
    command.add_argument(
        "--within",
        choices=WITHIN,
        default=WITHIN[0],
        help="estimated parameters vary over their limits, near the estimates, or within the "
        "intervals of the estimates; default: limits",
    )
    command.add_argument(
        "--samples", type=_samples, default=SAMPLES, help=f"base points; default: {SAMPLES}"
    )
    add_own_options(command, _sensitivity)


def _samples(text: str) -> int:
    count = int(text) if text.isdigit() else 0
    if count < 8 or count & (count - 1):
        raise argparse.ArgumentTypeError(
            f"'{text}' is no number of base points; give a power of two, such as 256 or 1024"
        )
    return count


def _sensitivity(given: argparse.Namespace) -> None:
    from pyrofit.results import sensitivity
    from pyrofit.show.sensitivity_page import PAGE
    from pyrofit.stages import sensitivity as stage

    study, results = open_study(given, sensitivity.slice_of)
    stage.sensitivity(study, results, tell, given.within, given.samples, given.cores)
    show(PAGE, study, results)
