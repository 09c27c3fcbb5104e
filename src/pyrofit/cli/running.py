"""The whole study with one command: Snakemake with the workflow of the package."""

import argparse
import contextlib
import io
import logging
import shutil
import sys
from pathlib import Path
from typing import Any

from pyrofit.cli.common import cores
from pyrofit.errors import StudyError

USUAL_CORES = 2


def add(commands: Any) -> None:
    """Add the command."""
    run = commands.add_parser(
        "run",
        help="run a study: all steps up to its report, or to a target",
        description="Run all steps of a study up to its report, or up to targets. After an "
        "interruption the same command goes on.",
    )
    run.add_argument("study", type=Path, nargs="?", help="study file (YAML)")
    run.add_argument("target", nargs="*", help="see --list; default: the report")
    run.add_argument("--cores", type=cores, help=f"jobs at once; default: {USUAL_CORES}")
    run.add_argument(
        "--profile", metavar="FOLDER", help="Snakemake profile of a cluster, such as profiles/slurm"
    )
    run.add_argument("--list", action="store_true", help="list the targets, run nothing")
    run.add_argument("--dry-run", action="store_true", help="list the steps, run nothing")
    run.add_argument(
        "--snakemake",
        nargs=argparse.REMAINDER,
        default=[],
        metavar="OPTION",
        help="options of Snakemake; they stand last",
    )
    run.set_defaults(step=_run)


def _run(given: argparse.Namespace) -> int:
    from pyrofit.running.given import check_file
    from pyrofit.running.targets import targets

    if given.list:
        for name, text in targets().items():
            print(f"{name:<12} {text}")
        return 0
    if given.study is None:
        raise StudyError(
            "no study is given: pyrofit run STUDY; `pyrofit init NAME` writes one, and "
            "`pyrofit run --list` lists the targets"
        )
    check_file(given.study)
    return _snakemake(_arguments(given))


def _snakemake(words: list[str]) -> int:
    """Run Snakemake in this process, shown by the logger plugin of the package."""
    from snakemake import cli
    from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

    from pyrofit.running import terminal

    LoggerPluginRegistry().register_plugin(terminal.NAME, terminal)
    logging.getLogger("snakemake.logging").propagate = False  # else errors are printed twice
    told = io.StringIO()
    try:
        with contextlib.redirect_stderr(told):  # the profile that it uses
            parser, given = cli.parse_args(words)
    except SystemExit as end:
        print(told.getvalue(), end="", file=sys.stderr)
        return int(end.code or 0)
    return 0 if cli.args_to_api(given, parser) else 1


def _arguments(given: argparse.Namespace) -> list[str]:
    """Return the arguments of Snakemake."""
    from pyrofit.running.targets import WORKFLOW
    from pyrofit.running.terminal import NAME

    words = ["--snakefile", str(WORKFLOW / "Snakefile"), "--logger", NAME]
    words += ["--configfile", str(given.study)]
    if given.profile is not None:
        words += ["--workflow-profile", str(_profile(Path(given.profile)))]
    if given.cores is not None or given.profile is None:
        words += ["--cores", str(given.cores or USUAL_CORES)]
    if given.dry_run:
        words.append("--dry-run")
    # Behind --, because --configfile takes any number of files.
    return [*words, *given.snakemake, "--", *given.target]


def _profile(folder: Path) -> Path:
    """Return the folder of a profile; write one that is shipped, so that the user may change it.

    Raises
    ------
    StudyError
        There is no such profile, or it was written just now.
    """
    from pyrofit.running.targets import WORKFLOW

    if (folder / "config.yaml").is_file():
        return folder
    shipped = WORKFLOW / "profiles" / folder.name
    if not shipped.is_dir():
        raise StudyError(
            f"{folder / 'config.yaml'}: there is no such profile; name a folder with one, or "
            "profiles/slurm, which is then written"
        )
    own = Path("profiles") / folder.name
    if not (own / "config.yaml").is_file():
        own.mkdir(parents=True, exist_ok=True)
        shutil.copy(shipped / "config.yaml", own)
        raise StudyError(
            f"{own / 'config.yaml'}: written; change the values marked CHANGE, and run again"
        )
    return own
