"""The command line: what the workflow's rules call, usable by hand."""

import argparse
import contextlib
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from pyrofit.errors import PyrofitError, StudyError, suggest
from pyrofit.logs import Tee, open_log

Step = Callable[[argparse.Namespace], None]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; return 0, or 2 with a message where the user can repair something."""
    # Threads of linear algebra would get in the way of the workflow's jobs, and change last bits:
    # Snakemake asks for as many as a job has cores.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    given = _parser().parse_args(arguments)
    if getattr(given, "log", None) is None:
        return _run(given)
    try:
        log = open_log(given.log)
    except OSError as error:
        print(
            f"error: {given.log}: cannot be written ({error.strerror}); make room or name "
            "another file with --log. Everything finished before is kept.",
            file=sys.stderr,
        )
        return 2
    usual = sys.stderr
    sys.stderr = Tee(usual, log)
    try:
        return _run(given)
    finally:
        sys.stderr = usual
        # Where the disk is full, closing fails once more.
        with contextlib.suppress(OSError):
            log.close()


def _run(given: argparse.Namespace) -> int:
    try:
        given.step(given)
    except PyrofitError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted; run again to go on, finished parts are kept", file=sys.stderr)
        return 130
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="pyrofit", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    data = commands.add_parser("data", help="the measured files of the MaCFP data base")
    actions = data.add_subparsers(dest="action", required=True, metavar="ACTION")
    fetch = actions.add_parser("fetch", help="download them, by commit and SHA-256")
    fetch.set_defaults(step=_fetch)
    where = actions.add_parser("where", help="print their folder; exit 2 where files are missing")
    where.set_defaults(step=_where)

    init = commands.add_parser("init", help="write a study and a folder for your own material")
    init.add_argument("name", help="name of study and folder: letters, digits and _")
    init.add_argument("--tga", type=Path, nargs="+", default=[], metavar="CSV", help="TGA files")
    init.add_argument(
        "--gasification",
        type=Path,
        nargs="+",
        default=[],
        metavar="CSV",
        help="files with a mass loss rate, a back temperature or both; without any file the "
        "measurements are computed",
    )
    init.set_defaults(step=_init)

    reference = commands.add_parser("reference", help="print the reference of all keys of a study")
    reference.set_defaults(step=_reference)

    check = commands.add_parser("check", help="check a study and its files, run nothing")
    check.add_argument("study", type=Path, help="study file (YAML)")
    check.set_defaults(step=_check)

    _step(commands, "prepare", "read the measurements into tidy tables", _prepare)
    _step(commands, "kinetics", "fit the kinetics to TGA", _kinetics)
    imp = _step(commands, "imp", "run one repetition of the inverse modelling", _imp)
    imp.add_argument("--cost", required=True, help="cost function of the study")
    imp.add_argument("--repetition", type=int, required=True, help="number of the repetition")
    squares = _step(commands, "least-squares", "run least squares on one cost", _least_squares)
    squares.add_argument("--cost", required=True, help="cost function of the study")
    cma_es = _step(commands, "cma-es", "run CMA-ES on one cost", _cma_es)
    cma_es.add_argument("--cost", required=True, help="cost function of the study")
    descent = _step(commands, "descent", "run least squares from SCE-UA's best set", _descent)
    descent.add_argument("--cost", required=True, help="cost function of the study")
    _step(commands, "collect", "gather all repetitions", _collect)
    known = _step(commands, "identify", "find which parameters the data determine", _identify)
    known.add_argument("--stage", choices=("kinetics", "imp"), default="imp", help="default: imp")
    _step(commands, "predict", "simulate the best sets at all predicted experiments", _predict)
    _step(commands, "compare", "score all sets of all optimisers by all costs", _compare)
    twins = _step(commands, "robustness", "compare the costs on twins of known truth", _robustness)
    twins.add_argument("--cost", help="cost function to fit them with; without: gather all")
    table = _step(commands, "table", "write one table", _table)
    table.add_argument("--name", required=True, help="name of the table")
    figure = _step(commands, "figure", "draw one figure", _figure)
    figure.add_argument("--name", required=True, help="name of the figure")
    lacks = _step(commands, "diagnose", "find which effect the model lacks", _diagnose)
    lacks.add_argument("--cores", type=_cores, default=1, help="processes; default: 1")
    _step(commands, "diagnosis-page", "draw and write the page of the diagnosis", _diagnosis_page)
    hidden = commands.add_parser("hidden-effects", help="run the blind test of the diagnosis")
    hidden.add_argument("--setting", type=Path, default=Path("config/hidden_effects.yaml"))
    hidden.add_argument("--plan", required=True, help="plan of the setting")
    hidden.add_argument("--chunk", type=int, help="job to run; without: gather all jobs")
    hidden.add_argument("--log", type=Path, help="file that keeps what is printed")
    hidden.set_defaults(step=_hidden_effects)
    _step(commands, "report", "write report.html and provenance.json", _report)
    archive = _step(
        commands, "archive", "put all of a study in one file, to be run again", _archive
    )
    archive.add_argument(
        "--given", type=Path, nargs="+", help="study files; default: that of --study"
    )
    return parser


def _step(commands: Any, name: str, text: str, step: Step) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(name, help=text)
    parser.add_argument("--study", type=Path, required=True, help="study file (YAML or JSON)")
    parser.add_argument("--results", type=Path, help="results folder; default results/<name>")
    parser.add_argument("--digest", help="expected digest of what the step depends on")
    parser.add_argument("--log", type=Path, help="file that keeps what is printed")
    parser.set_defaults(step=step)
    return parser


def _cores(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of cores; give 1 or more")
    return int(text)


def _open(given: argparse.Namespace, slice_of: Callable[..., Any], *arguments: Any) -> Any:
    """Return study and results; refuse a study that differs from what the caller described."""
    from pyrofit.config import digest, read_study
    from pyrofit.files import Results

    study = read_study(given.study)
    cost = getattr(given, "cost", None)
    if cost is not None and cost not in study.imp.costs:
        raise StudyError(
            f"{given.study}: study '{study.name}' has no cost '{cost}'. "
            + suggest(cost, study.imp.costs)
        )
    if given.digest is not None and digest(slice_of(study, *arguments)) != given.digest:
        raise StudyError(f"{given.study}: the study changed while the workflow ran; run it again")
    return study, Results(given.results or Path("results") / study.name)


def _fetch(given: argparse.Namespace) -> None:
    from pyrofit.data.fetch import fetch, store

    files = fetch()
    print(f"{len(files)} measured files, checksums verified, in {store()}")


def _where(given: argparse.Namespace) -> None:
    from pyrofit.data.fetch import missing, store
    from pyrofit.errors import DataError

    folder = store()
    absent = missing(folder)
    if absent:
        raise DataError(
            f"{folder}: {len(absent)} measured files are missing, the first is {absent[0]}; "
            "get them with `make data`, or set PYROFIT_DATA_DIR to a copy of the data base"
        )
    print(folder)


def _init(given: argparse.Namespace) -> None:
    from pyrofit.start.write import init

    study, lines = init(given.name, given.tga, given.gasification, Path())
    for line in lines:
        print(line)
    print(f"{study}: written. Change what is marked CHANGE.")
    try:
        _check(argparse.Namespace(study=study))
    except PyrofitError as error:
        print(f"Still to do, as `pyrofit check` says:\n{error}")


def _reference(given: argparse.Namespace) -> None:
    from pyrofit.start.reference import reference_page

    print(reference_page(), end="")


def _check(given: argparse.Namespace) -> None:
    from pyrofit.config import read_study
    from pyrofit.stages.reading import check_measurements

    study = read_study(given.study)
    read = check_measurements(study, str(given.study))
    runs = study.imp.repetitions * len(study.imp.costs)
    print(
        f"{given.study}: study '{study.name}' is valid; {read} measured series read; "
        f"{runs} repetitions in all"
    )


def _prepare(given: argparse.Namespace) -> None:
    from pyrofit.stages import measurements, slices

    for line in measurements.prepare(*_open(given, slices.data)):
        print(f"mass closure: {line}", file=sys.stderr)


def _kinetics(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit, slices

    fit.fit_kinetics(*_open(given, slices.kinetics))


def _imp(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit, slices

    study, results = _open(given, slices.imp, given.cost, "sceua")
    if not 0 <= given.repetition < study.imp.repetitions:
        raise StudyError(
            f"repetition {given.repetition}: study '{study.name}' has repetitions 0 to "
            f"{study.imp.repetitions - 1}; raise imp.repetitions for more"
        )
    fit.repeat(study, results, given.cost, given.repetition)


def _least_squares(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit, slices

    study, results = _open(given, slices.imp, given.cost, "least_squares")
    fit.least_squares(study, results, given.cost)


def _cma_es(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit, slices

    study, results = _open(given, slices.imp, given.cost, "cmaes")
    fit.cma_es(study, results, given.cost)


def _descent(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit, slices

    study, results = _open(given, slices.imp, given.cost, "least_squares")
    fit.descent(study, results, given.cost)


def _collect(given: argparse.Namespace) -> None:
    from pyrofit.stages import fit, slices

    fit.collect(*_open(given, slices.collect))


def _identify(given: argparse.Namespace) -> None:
    from pyrofit.stages import identify, slices

    if given.stage == "kinetics":
        identify.identify_kinetics(*_open(given, slices.kinetics))
    else:
        identify.identify_imp(*_open(given, slices.identify))


def _diagnose(given: argparse.Namespace) -> None:
    from pyrofit.stages import diagnose, measurements, slices

    study, results = _open(given, slices.diagnose)
    if given.digest is None:  # by hand, without the workflow that has read the measurements
        measurements.prepare(study, results)
    diagnose.diagnose(study, results, lambda text: print(text, file=sys.stderr), given.cores)
    if given.digest is None:
        _diagnosis_page(given)


def _diagnosis_page(given: argparse.Namespace) -> None:
    from pyrofit.figures.diagnosis import draw_all
    from pyrofit.report.diagnosis import write_page
    from pyrofit.stages import slices

    study, results = _open(given, slices.presentation)
    draw_all(results, study)
    write_page(study, results)


def _predict(given: argparse.Namespace) -> None:
    from pyrofit.stages import predict, slices

    predict.predict(*_open(given, slices.validation))


def _compare(given: argparse.Namespace) -> None:
    from pyrofit.stages import compare, slices

    compare.compare(*_open(given, slices.compare))


def _robustness(given: argparse.Namespace) -> None:
    from pyrofit.stages import robustness, slices

    if given.cost is not None:
        study, results = _open(given, slices.robustness, given.cost)
        robustness.robustness(study, results, given.cost)
        return
    from pyrofit.figures.robustness import draw_robustness
    from pyrofit.report.comparison import robustness as said
    from pyrofit.tables.robustness import write_robustness

    study, results = _open(given, slices.presentation)
    write_robustness(study, results)
    draw_robustness(study, results)
    for line in said(study, results):
        print(line, file=sys.stderr)


def _table(given: argparse.Namespace) -> None:
    from pyrofit.stages import slices
    from pyrofit.tables import make_table

    make_table(given.name, *_open(given, slices.presentation))


def _figure(given: argparse.Namespace) -> None:
    from pyrofit.figures import make_figure
    from pyrofit.stages import slices

    make_figure(given.name, *_open(given, slices.presentation))


def _report(given: argparse.Namespace) -> None:
    from pyrofit.report import write_report
    from pyrofit.stages import slices

    write_report(*_open(given, slices.presentation))


def _archive(given: argparse.Namespace) -> None:
    from pyrofit.archive import write_archive
    from pyrofit.stages import slices

    study, results = _open(given, slices.presentation)
    print(write_archive(study, results, given.given or [given.study], Path()))


def _hidden_effects(given: argparse.Namespace) -> None:
    from pyrofit.hidden.places import FOLDER, Places
    from pyrofit.hidden.setting import read_setting

    setting, places = read_setting(given.setting), Places(FOLDER / given.plan)
    if given.chunk is None:
        from pyrofit.report.hidden_effects import write_hidden_effects

        write_hidden_effects(setting, given.plan, places)
    else:
        from pyrofit.diagnose.diagnosis import diagnose
        from pyrofit.hidden.run import run_chunk

        run_chunk(setting, given.plan, given.chunk, places, diagnose)
