"""Command that tells what signals and costs of a study depend on."""

import argparse
import sys
from pathlib import Path
from typing import Any

from pyrofit.cli.common import open_study

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
    command.add_argument("--cores", type=_cores, default=1, help="processes; default: 1")
    command.add_argument("--results", type=Path, help="results folder; default results/<name>")
    command.add_argument(
        "--digest", help="digest of all inputs of the step; another one is refused"
    )
    command.add_argument("--log", type=Path, help="file that keeps a copy of the output")
    command.set_defaults(step=_sensitivity)


def _samples(text: str) -> int:
    count = int(text) if text.isdigit() else 0
    if count < 8 or count & (count - 1):
        raise argparse.ArgumentTypeError(
            f"'{text}' is no number of base points; give a power of two, such as 256 or 1024"
        )
    return count


def _cores(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of cores; give 1 or more")
    return int(text)


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _sensitivity(given: argparse.Namespace) -> None:
    from pyrofit.results import sensitivity
    from pyrofit.show.sensitivity.sentences import sentences
    from pyrofit.show.sensitivity_page import draw_and_write
    from pyrofit.stages import sensitivity as stage

    study, results = open_study(given, sensitivity.slice_of)
    stage.sensitivity(study, results, _tell, given.within, given.samples, given.cores)
    draw_and_write(study, results)
    for line in sentences(study, results):
        print(line)
