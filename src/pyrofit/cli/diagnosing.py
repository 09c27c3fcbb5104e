"""Commands of the diagnosis, and of its blind test."""

import argparse
import sys
from pathlib import Path
from typing import Any

from pyrofit.cli.common import add_step, cores, open_study
from pyrofit.errors import StudyError


def add(commands: Any) -> None:
    """Add these commands."""
    lacks = add_step(commands, "diagnose", "find which effect the model lacks", _diagnose)
    words = "draw and write the page of the diagnosis"
    page = add_step(commands, "diagnosis-page", words, _diagnosis_page)
    for step in (lacks, page):
        step.add_argument("--cores", type=cores, default=1, help="processes; default: 1")
    blind = commands.add_parser("blind-test", help="run the blind test of the diagnosis")
    blind.add_argument("--setting", type=Path, default=Path("config/blind_test.yaml"))
    blind.add_argument("--plan", required=True, help="plan of the setting")
    blind.add_argument("--chunk", type=int, help="job to run; without: gather all jobs")
    blind.add_argument(
        "--so-far", action="store_true", help="gather the twins that have been diagnosed so far"
    )
    blind.add_argument("--log", type=Path, help="file that keeps a copy of the output")
    blind.set_defaults(step=_blind_test)
    _add_foreign(commands)


def _add_foreign(commands: Any) -> None:
    """Add the commands of the blind test on curves of another code."""
    words = "make the files of the foreign blind test from curves of another code"
    thin = commands.add_parser("foreign-curves", help=words)
    thin.add_argument("source", type=Path, help="folder of the curves in full and their manifest")
    thin.add_argument("target", type=Path, help="folder of the files that are made")
    thin.set_defaults(step=_thin)
    words = "tell how far the curves are from those of pyrofit with the same effects"
    agree = commands.add_parser("foreign-agreement", help=words)
    agree.add_argument("--setting", type=Path, default=Path("config/foreign_truth.yaml"))
    agree.set_defaults(step=_agreement)


def _diagnose(given: argparse.Namespace) -> None:
    from pyrofit.results import dependencies
    from pyrofit.stages import diagnose, measurements

    study, results = open_study(given, dependencies.diagnose)
    if given.digest is None:  # by hand, without the workflow that has read the measurements
        measurements.prepare(study, results)
    diagnose.diagnose(study, results, lambda text: print(text, file=sys.stderr), given.cores)
    if given.digest is None:
        _diagnosis_page(given)


def _diagnosis_page(given: argparse.Namespace) -> None:
    from pyrofit.results import dependencies
    from pyrofit.show.diagnosis_page import draw_all, write_page

    study, results = open_study(given, dependencies.presentation)
    draw_all(results, study, given.cores)
    write_page(study, results)


def _thin(given: argparse.Namespace) -> None:
    from pyrofit.blind_test.thin import thin

    for path in thin(given.source, given.target):
        print(path)


def _agreement(given: argparse.Namespace) -> None:
    from pyrofit.blind_test.agreement import agreement
    from pyrofit.blind_test.setting import read_setting
    from pyrofit.show.text import markdown

    print(markdown(agreement(read_setting(given.setting))), end="")


def _blind_test(given: argparse.Namespace) -> None:
    from pyrofit.blind_test.places import Places, folder_of
    from pyrofit.blind_test.setting import read_setting

    setting = read_setting(given.setting)
    places = Places(folder_of(given.setting, given.plan))
    if given.chunk is not None and given.so_far:
        raise StudyError("--so-far gathers twins and runs no job; leave out --chunk")
    if given.chunk is None:
        from pyrofit.blind_test.page import write_results

        write_results(setting, given.plan, places, given.so_far)
    else:
        from pyrofit.blind_test.run import run_chunk
        from pyrofit.diagnose.diagnosis import diagnose

        run_chunk(setting, given.plan, given.chunk, places, diagnose)
