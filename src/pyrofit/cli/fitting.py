"""Commands that compute: measurements, kinetics, inverse modelling, predictions, comparisons."""

import argparse
import sys
from functools import partial
from typing import Any

from pyrofit.cli.common import add_step, open_study, tell
from pyrofit.errors import StudyError
from pyrofit.estimate.optimisers import OPTIMISERS


def add(commands: Any) -> None:
    """Add these commands."""
    add_step(commands, "prepare", "read the measurements into tidy tables", _prepare)
    timed = add_step(
        commands,
        "trial",
        "run external programs once; estimate the duration",
        _trial,
    )
    timed.add_argument("--cores", type=int, default=1, help="cores of the campaign; default: 1")
    add_step(commands, "kinetics", "fit the kinetics to TGA", _kinetics)
    imp = add_step(commands, "imp", "run repetitions of the inverse modelling", _imp)
    imp.add_argument("--cost", required=True, help="cost function of the study")
    imp.add_argument(
        "--repetition",
        type=int,
        required=True,
        nargs="+",
        help="their numbers; several run side by side",
    )
    for name, optimiser in OPTIMISERS.items():
        step = partial(_optimise, name)
        text = f"run {optimiser.words} on one cost"
        starts = add_step(commands, optimiser.command, text, step)
        starts.add_argument("--cost", required=True, help="cost function of the study")
    descent = add_step(commands, "descent", "run least squares from SCE-UA's best set", _descent)
    descent.add_argument("--cost", required=True, help="cost function of the study")
    add_step(commands, "collect", "gather all repetitions", _collect)
    known = add_step(commands, "identify", "find which parameters the data determine", _identify)
    known.add_argument("--stage", choices=("kinetics", "imp"), default="imp", help="default: imp")
    text = "find the activation energy over conversion, without a model"
    add_step(commands, "isoconversional", text, _isoconversional)
    add_step(
        commands,
        "predict",
        "simulate estimates and best sets at all predicted experiments",
        _predict,
    )
    add_step(commands, "compare", "score all sets of all optimisers by all costs", _compare)


def _prepare(given: argparse.Namespace) -> None:
    from pyrofit.stages import measurements

    for line in measurements.prepare(*open_study(given)):
        print(f"mass closure: {line}", file=sys.stderr)


def _trial(given: argparse.Namespace) -> None:
    from pyrofit.stages import trial

    study, results = open_study(given)
    for line in trial.trial(study, results, given.cores):
        print(line, file=sys.stderr)


def _kinetics(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit

    fit.fit_kinetics(*open_study(given))


def _imp(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit

    study, results = open_study(given)
    wrong = [n for n in given.repetition if not 0 <= n < study.imp.repetitions]
    if wrong:
        raise StudyError(
            f"repetition {wrong[0]}: study '{study.name}' has repetitions 0 to "
            f"{study.imp.repetitions - 1}; raise imp.repetitions for more"
        )
    fit.repeat(study, results, given.cost, given.repetition)


def _optimise(optimiser: str, given: argparse.Namespace) -> None:
    from pyrofit.stages import fit

    study, results = open_study(given)
    fit.optimise(study, results, given.cost, optimiser)


def _descent(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit

    study, results = open_study(given)
    fit.descent(study, results, given.cost)


def _collect(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit

    fit.collect(*open_study(given))


def _identify(given: argparse.Namespace) -> None:
    from pyrofit.stages import identify

    if given.stage == "kinetics":
        identify.identify_kinetics(*open_study(given))
    else:
        identify.identify_imp(*open_study(given))


def _isoconversional(given: argparse.Namespace) -> None:
    from pyrofit.stages import isoconversional, measurements

    study, results = open_study(given)
    if given.by_hand:  # by hand, without the workflow that has read the measurements
        measurements.prepare(study, results)
    isoconversional.analyse_masses(study, results, tell)


def _predict(given: argparse.Namespace) -> None:
    from pyrofit.stages import predict

    predict.predict_sets(*open_study(given))


def _compare(given: argparse.Namespace) -> None:
    from pyrofit.stages import compare

    compare.compare(*open_study(given))
