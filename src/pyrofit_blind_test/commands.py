"""Commands of the blind test of the diagnosis."""

import argparse
from pathlib import Path
from typing import Any

from pyrofit.errors import DataError, StudyError


def add(commands: Any) -> None:
    """Add these commands."""
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
    _add_benchmark(commands)


def _add_benchmark(commands: Any) -> None:
    """Add the commands of the benchmark of hidden effects."""
    words = "write, answer and score the benchmark of hidden effects"
    tasks = commands.add_parser("benchmark", help=words).add_subparsers(required=True)
    write = tasks.add_parser("write", help="write data sets with hidden effects for everybody")
    write.add_argument("folder", type=Path, help="folder of the benchmark")
    write.add_argument(
        "--setting",
        type=Path,
        nargs="+",
        default=[Path("config/blind_test.yaml")],
        help="settings of the blind test",
    )
    write.add_argument("--plan", required=True, help="plan of each setting")
    write.add_argument(
        "--so-far", action="store_true", help="only sets that the blind test has diagnosed"
    )
    write.set_defaults(step=_benchmark_write)
    answer = tasks.add_parser("answer", help="answer the data sets by simple baselines")
    answer.add_argument("folder", type=Path, help="folder of the benchmark")
    answer.add_argument(
        "--by",
        nargs="+",
        choices=("none", "sparse", "aic", "bic"),
        default=["none", "sparse", "aic", "bic"],
        help="baselines",
    )
    answer.add_argument("--first", type=int, help="number of sets, the first ones by name")
    answer.set_defaults(step=_benchmark_answer)
    score = tasks.add_parser("score", help="compare answers with the truth")
    score.add_argument("folder", type=Path, help="folder of the benchmark")
    score.add_argument("answers", type=Path, nargs="*", help="answers; by default all there")
    score.add_argument("--common", action="store_true", help="only sets that all have answered")
    score.set_defaults(step=_benchmark_score)


def _benchmark_write(given: argparse.Namespace) -> None:
    from pyrofit_blind_test.benchmark.write import write_benchmark

    write_benchmark(given.folder, given.setting, given.plan, given.so_far, print)


def _benchmark_answer(given: argparse.Namespace) -> None:
    from pyrofit_blind_test.benchmark.baselines import answer_all

    answer_all(given.folder, given.by, given.first, print)


def _benchmark_score(given: argparse.Namespace) -> None:
    from pyrofit_blind_test.benchmark.score import AnswerError, table

    try:
        print(table(given.folder, given.answers, given.common), end="")
    except AnswerError as error:
        raise DataError(str(error)) from None


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


def _thin(given: argparse.Namespace) -> None:
    from pyrofit_blind_test.thin import thin

    for path in thin(given.source, given.target):
        print(path)


def _agreement(given: argparse.Namespace) -> None:
    from pyrofit.show.text import markdown
    from pyrofit_blind_test.agreement import agreement
    from pyrofit_blind_test.setting import read_setting

    print(markdown(agreement(read_setting(given.setting))), end="")


def _blind_test(given: argparse.Namespace) -> None:
    from pyrofit_blind_test.places import Places, folder_of
    from pyrofit_blind_test.setting import read_setting

    setting = read_setting(given.setting)
    places = Places(folder_of(given.setting, given.plan))
    if given.chunk is not None and given.so_far:
        raise StudyError("--so-far gathers twins and runs no job; leave out --chunk")
    if given.chunk is None:
        from pyrofit_blind_test.page import write_results

        write_results(setting, given.plan, places, given.so_far)
    else:
        from pyrofit.diagnose.diagnosis import diagnose
        from pyrofit_blind_test.run import run_chunk

        run_chunk(setting, given.plan, given.chunk, places, diagnose)
