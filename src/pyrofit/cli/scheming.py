"""Command of the choice of a reaction scheme."""

import argparse
import sys
from typing import Any

from pyrofit.cli.common import add_step, open_study


def add(commands: Any) -> None:
    """Add this command."""
    add_step(commands, "scheme", "choose the reaction scheme from TGA", _scheme)


def _scheme(given: argparse.Namespace) -> None:
    from pyrofit.results import dependencies
    from pyrofit.show.scheme_page import draw_and_write
    from pyrofit.stages import measurements, scheme

    study, results = open_study(given, dependencies.scheme)
    if given.digest is None:  # by hand, without the workflow that has read the measurements
        measurements.prepare(study, results)
    scheme.choose(study, results, lambda text: print(text, file=sys.stderr, flush=True))
    draw_and_write(study, results)
