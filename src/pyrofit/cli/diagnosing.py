"""Commands of the diagnosis."""

import argparse
import sys
from typing import Any

from pyrofit.cli.common import add_step, cores, open_study


def add(commands: Any) -> None:
    """Add these commands."""
    lacks = add_step(commands, "diagnose", "find which effect the model lacks", _diagnose)
    words = "draw and write the page of the diagnosis"
    page = add_step(commands, "diagnosis-page", words, _diagnosis_page)
    for step in (lacks, page):
        step.add_argument("--cores", type=cores, default=1, help="processes; default: 1")


def _diagnose(given: argparse.Namespace) -> None:
    from pyrofit.stages import diagnose, measurements

    study, results = open_study(given)
    if given.by_hand:  # by hand, without the workflow that has read the measurements
        measurements.prepare(study, results)
    diagnose.diagnose_study(study, results, lambda text: print(text, file=sys.stderr), given.cores)
    if given.by_hand:
        _diagnosis_page(given)


def _diagnosis_page(given: argparse.Namespace) -> None:
    from pyrofit.show.diagnosis_page import draw_all, write_page

    study, results = open_study(given)
    draw_all(results, study, given.cores)
    write_page(study, results)
