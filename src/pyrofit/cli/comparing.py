"""Command that compares a finished study with further tests and with other predictions."""

import argparse
from pathlib import Path
from typing import Any


def add(commands: Any) -> None:
    """Add this command."""
    words = "compare predictions of a study with further tests, and with those of others"
    command = commands.add_parser("compare-with", help=words, description=words)
    command.add_argument("study", type=Path, help="study file (YAML or JSON), also extended.yaml")
    command.add_argument("tests", type=Path, help="YAML file of the further tests")
    command.add_argument(
        "--predictions",
        type=Path,
        nargs="+",
        default=[],
        metavar="PATH",
        help="predictions of others in MaCFP's form: files, or folders of them",
    )
    command.add_argument(
        "--set", default="", help="estimates (default), a cost's, truth, diagnosis, or a JSON"
    )
    command.add_argument("--results", type=Path, help="results folder; default results/<name>")
    command.add_argument("--out", type=Path, help="default results/<name>/compare_with")
    command.set_defaults(step=_compare)


def _compare(given: argparse.Namespace) -> None:
    from pyrofit.compare_with.compute import compare_with
    from pyrofit.compare_with.page import summary, write
    from pyrofit.config import read_study
    from pyrofit.results.files import Results

    study = read_study(given.study)
    results = Results(given.results or Path("results") / study.name)
    found = compare_with(
        study, results, given.tests, given.predictions, given.set, given.study.parent
    )
    print(summary(found.scores).round(3).to_string(index=False))
    print(write(found, given.out or results.root / "compare_with"))
