"""Commands that come before a run: data, a new study, the reference of its keys, a check."""

import argparse
import sys
from pathlib import Path
from typing import Any

from pyrofit.discovery import added, loaded
from pyrofit.errors import ProgramError, PyrofitError, StudyError


def add(commands: Any) -> None:
    """Add these commands."""
    data = commands.add_parser("data", help="the measured files of the MaCFP data base")
    actions = data.add_subparsers(dest="action", required=True, metavar="ACTION")
    fetch = actions.add_parser("fetch", help="download the files; check commit and SHA-256")
    fetch.set_defaults(step=_fetch)
    where = actions.add_parser(
        "where", help="print the folder of the files; exit with 2 if files are missing"
    )
    where.set_defaults(step=_where)

    init = commands.add_parser("init", help="write a study and a folder for your own material")
    init.add_argument("name", help="name of study and folder: letters, digits and _")
    init.late = _add_kinds
    init.set_defaults(step=_init)

    reference = commands.add_parser(
        "reference", help="print a reference page: keys, commands, costs ..."
    )
    reference.add_argument(
        "--of", choices=(*_PAGES, "commands"), default="study", help="default: study"
    )
    reference.set_defaults(step=_reference)

    check = commands.add_parser("check", help="check a study and its files, run no fit")
    check.add_argument("study", type=Path, help="study file (YAML)")
    check.add_argument(
        "--no-plugins", action="store_true", help="refuse a study with plugins, run none of them"
    )
    check.add_argument(
        "--data",
        action="store_true",
        help="compare the data with all that the limits allow, and name likely errors",
    )
    check.add_argument(
        "--figures", type=Path, metavar="FOLDER", help="with --data: write a figure of each test"
    )
    check.set_defaults(step=_check)

    doctor = commands.add_parser("doctor", help="check study and machine before a long run")
    doctor.add_argument(
        "study", type=Path, nargs="?", help="study file; without: the machine alone"
    )
    doctor.add_argument("--results", type=Path, help="results folder; default results/<name>")
    doctor.add_argument("--cores", type=int, help="jobs at once; default: those of the profile")
    doctor.add_argument(
        "--profile", type=Path, metavar="FOLDER", help="Snakemake profile, such as profiles/slurm"
    )
    doctor.set_defaults(step=_doctor)


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


def _add_kinds(init: argparse.ArgumentParser) -> None:
    """Add an option for the files of each kind of experiment."""
    from pyrofit.experiments import OF_FILES, files_of

    init.add_argument("unsorted", nargs="*", help=argparse.SUPPRESS)
    for name in OF_FILES:
        text = files_of(name).help
        init.add_argument(f"--{name}", type=Path, nargs="+", default=[], metavar="CSV", help=text)


def _init(given: argparse.Namespace) -> None:
    from pyrofit.experiments import OF_FILES
    from pyrofit.new_study.write import init

    if given.unsorted:
        kinds = ", ".join(f"--{name}" for name in OF_FILES)
        raise StudyError(
            f"{given.unsorted[0]}: the kind of its test is not given; name one of {kinds} before "
            "the files of each kind. `pyrofit look FILE` tells the kind that a file seems to have."
        )
    study, lines = init(given.name, {kind: getattr(given, kind) for kind in OF_FILES}, Path())
    for line in lines:
        print(line)
    print(f"{study}: written. Change the places marked CHANGE.")
    try:
        _check(argparse.Namespace(study=study, data=False, figures=None))
    except PyrofitError as error:
        print(f"Still to do, as `pyrofit check` says:\n{error}")


def _reference(given: argparse.Namespace) -> None:
    if given.of == "commands":
        from pyrofit.cli.page import commands_page

        print(commands_page(given.program), end="")
    else:
        print(_PAGES[given.of](), end="")


def _study_page() -> str:
    from pyrofit.config.reference import reference_page

    others = [loaded(point)() for point in added("reference").values()]
    return "\n".join([reference_page(), *others])


def _diagnosis_page() -> str:
    from pyrofit.results.schema_page import schema_page

    return schema_page()


def _effects_page() -> str:
    from pyrofit.effects.page import effects_page

    return effects_page()


def _costs_page() -> str:
    from pyrofit.cost.page import costs_page

    return costs_page()


def _quantities_page() -> str:
    from pyrofit.quantities.page import quantities_page

    return quantities_page()


_PAGES = {
    "study": _study_page,
    "diagnosis": _diagnosis_page,
    "effects": _effects_page,
    "costs": _costs_page,
    "quantities": _quantities_page,
}
"""Pages of the documentation by the name that `pyrofit reference --of` takes."""


def _check(given: argparse.Namespace) -> None:
    from pyrofit.analysis.differing_repeats import DIFFERS
    from pyrofit.config import read_study
    from pyrofit.config.check.unusual import unusual_values
    from pyrofit.config.expand.programs import externals
    from pyrofit.data.suspect import LOOK
    from pyrofit.external.filled import executable_of
    from pyrofit.new_study.marks import MARK, marked_lines
    from pyrofit.stages.reading import check_measurements

    _say_plugins(given.study, getattr(given, "no_plugins", False))
    study = read_study(given.study)
    read = check_measurements(study, str(given.study))
    runs = study.imp.repetitions * len(study.imp.costs)
    for name, experiment in externals(study).items():
        try:
            print(f"experiments.{name}: the program is {executable_of(experiment.program)}")
        except ProgramError as error:
            print(f"experiments.{name}: not here: {error}")
    marked = marked_lines(given.study.read_text(encoding="utf-8"))
    sentences = unusual_values(study)
    if marked:
        lines = f"{'lines' if len(marked) > 1 else 'line'} {', '.join(map(str, marked))}"
        sentences.append(f"set the values marked {MARK} and delete this word: {lines}")
    for _, about in read.values():
        notes = about.notes
        sentences += [note for note in notes if DIFFERS in note]
        sentences += [f"{about.source}: {n}" for n in notes if n.startswith(LOOK)]
    for sentence in dict.fromkeys(sentences):  # one file may hold several signals
        print(f"warning: {given.study}: {sentence}", file=sys.stderr)
    print(
        f"{given.study}: study '{study.name}' is valid; {len(read)} measured series read; "
        f"{runs} repetitions in all"
    )
    figures = getattr(given, "figures", None)
    if getattr(given, "data", False) or figures is not None:
        _preview(study, {channel: frame for channel, (frame, _) in read.items()}, figures)


def _preview(study: Any, measured: dict[tuple[str, str], Any], folder: Path | None) -> None:
    """Say what the data are beside all that the limits allow; draw it where asked."""
    from pyrofit.results.files import Results
    from pyrofit.show.text import several
    from pyrofit.stages.measurements import computed
    from pyrofit.steps.preview.compute import SETS, preview
    from pyrofit.steps.preview.figures import draw_experiments
    from pyrofit.steps.preview.sentences import sentences_on

    count = len({test for test, _ in measured})
    print(
        f"Simulating {SETS} sets within the limits at {several(count, 'test')}; this takes "
        "seconds to minutes.",
        file=sys.stderr,
    )
    made = preview(study, measured | (computed(study, fast=True) if study.is_synthetic else {}))
    for sentence in sentences_on(study, made.found):
        print(sentence)
    if folder is not None:
        draw_experiments(study, made.bands, made.found, Results(folder), ".")


def _say_plugins(study: Path, refused: bool) -> None:
    """Say before plugins are run that they are programs.

    Raises
    ------
    StudyError
        They are refused.
    """
    from pyrofit.config.read import plugins_of
    from pyrofit.config.yaml_file import read_mapping

    names = plugins_of(read_mapping(study))
    if not names:
        return
    folders = ", ".join(f"{study.parent / name}" for name in names)
    if refused:
        raise StudyError(
            f"{study}: plugins: {folders} hold programs, which a check would run. Read them, "
            "then check without --no-plugins"
        )
    print(f"warning: {study}: plugins: runs the programs in {folders}", file=sys.stderr)


def _doctor(given: argparse.Namespace) -> int:
    from pyrofit.doctor.report import check_all

    worst = 0
    for finding in check_all(given.study, given.results, given.cores, given.profile):
        print(finding, flush=True)
        worst = max(worst, finding.level == "error")
    return int(worst)
