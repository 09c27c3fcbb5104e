"""Shared code of the steps of a study: their options, and the opening of its results."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pyrofit.errors import StudyError, suggest

Step = Callable[[argparse.Namespace], int | None]
MOST_CORES = 1024


def add_step(commands: Any, name: str, text: str, step: Step) -> argparse.ArgumentParser:
    """Add a command that takes a study, and return its parser for further options."""
    said = f"{text[0].upper()}{text[1:]}. Snakemake usually runs this step."
    parser: argparse.ArgumentParser = commands.add_parser(name, help=text, description=said)
    parser.add_argument("--study", type=Path, required=True, help="study file (YAML or JSON)")
    parser.add_argument("--results", type=Path, help="results folder; default results/<name>")
    parser.add_argument("--log", type=Path, help="file that keeps a copy of the output")
    parser.set_defaults(step=step)
    return parser


def add_own_options(command: argparse.ArgumentParser, step: Step) -> None:
    """Add the options of a step that runs apart from the others, behind its own."""
    command.add_argument("--cores", type=cores, default=1, help="processes; default: 1")
    command.add_argument("--results", type=Path, help="results folder; default results/<name>")
    command.add_argument("--log", type=Path, help="file that keeps a copy of the output")
    command.set_defaults(step=step)


def cores(text: str) -> int:
    """Return a number of processes from its text."""
    return whole_number(text, 1, MOST_CORES)


def whole_number(text: str, least: int, most: int, more: str = "") -> int:
    """Return a whole number from its text; ``more`` tells what else may be given."""
    if not text.isdigit() or not least <= int(text) <= most:
        raise argparse.ArgumentTypeError(
            f"'{text}': give a whole number from {least} to {most}{more}"
        )
    return int(text)


def tell(text: str) -> None:
    """Tell progress on standard error."""
    print(text, file=sys.stderr, flush=True)


def show(page: Any, study: Any, results: Any) -> None:
    """Write tables and figures of a step's page, and print its sentences."""
    page.draw_and_write(study, results)
    for line in page.sentences(study, results):
        print(line)


def find_study(given: argparse.Namespace) -> Any:
    """Return the study of a command.

    Rules give the file of inputs that they were planned with. It names the study of the run, which
    is then ``given.study``; otherwise the command is called ``by_hand``.
    """
    from pyrofit.config import read_study
    from pyrofit.running.plan import named_study

    planned = named_study(given.study)
    given.by_hand = planned is None
    given.study = planned or given.study
    return read_study(given.study)


def study_with_results(given: argparse.Namespace) -> Any:
    """Return study and results of a command that only reads them."""
    from pyrofit.results.files import Results

    study = find_study(given)
    return study, Results(given.results or Path("results") / study.name)


def open_study(
    given: argparse.Namespace, change: Callable[[Any], Any] = lambda study: study
) -> Any:
    """Return study and results.

    ``change`` puts options of the command line into the study. Until the command ends, no other
    run of the study may start.
    """
    from pyrofit.config.expand.programs import externals, keeping_runs
    from pyrofit.external.scratch import sweep_scratch
    from pyrofit.running.lock import job

    study, results = study_with_results(given)
    cost = getattr(given, "cost", None)
    if cost is not None and cost not in study.imp.costs:
        raise StudyError(
            f"{given.study}: study '{study.name}' has no cost '{cost}'. "
            + suggest(cost, study.imp.costs)
        )
    study = change(study)
    given.until_end.enter_context(job(results.root))
    if externals(study):
        sweep_scratch()
        study = keeping_runs(study, results.root / "programs")
    return study, results
