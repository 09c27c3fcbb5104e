"""Command for the sensitivity of a study's signals and costs to their inputs."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_own_options, open_study, show, tell
from pyrofit.defaults import BASE_POINTS, WITHIN

RANGES = ("limits", "near", "intervals")


def add(commands: Any) -> None:
    """Add this command."""
    words = "variance-based sensitivity of signals over time and of costs"
    command = commands.add_parser("sensitivity", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON)")
    command.add_argument(
        "--within",
        choices=RANGES,
        default=WITHIN,
        help="estimated parameters vary over their limits, near the estimates, or within the "
        f"intervals of the estimates; default: {WITHIN}",
    )
    command.add_argument(
        "--samples", type=_samples, default=BASE_POINTS, help=f"base points; default: {BASE_POINTS}"
    )
    add_own_options(command, _sensitivity)


def _samples(text: str) -> int:
    count = int(text) if text.isdigit() else 0
    if count < 8 or count & (count - 1):
        raise argparse.ArgumentTypeError(
            f"'{text}': give a power of two from 8, such as 256 or 1024"
        )
    return count


def _sensitivity(given: argparse.Namespace) -> None:
    from pyrofit.results import sensitivity
    from pyrofit.show.sensitivity_page import PAGE
    from pyrofit.stages import sensitivity as stage

    study, results = open_study(given, sensitivity.slice_of, given.within, given.samples)
    stage.sensitivity(study, results, tell, given.within, given.samples, given.cores)
    show(PAGE, study, results)
