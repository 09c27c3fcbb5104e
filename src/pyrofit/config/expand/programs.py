"""External programs of a study: places of their files, and parameters of their templates."""

from collections.abc import Callable
from pathlib import Path

from pyrofit.config.keys.study import Study
from pyrofit.external.filled import used_parameters
from pyrofit.model.external import ExternalExperiment
from pyrofit.model.program import Program


def externals(study: Study) -> dict[str, ExternalExperiment]:
    """Return the experiments that external programs simulate, by name."""
    return {n: e for n, e in study.experiments.items() if isinstance(e, ExternalExperiment)}


def with_programs(study: Study, folder: Path | None) -> Study:
    """Return a study whose programs and their files are seen from the working folder.

    Parameters
    ----------
    study
        The study; each key is valid by itself.
    folder
        Folder of the study file; None if the files are found already.
    """
    return study if folder is None else _changed(study, lambda p: _located(p, folder))


def with_units(study: Study) -> Study:
    """Return a study whose programs name the unit of each parameter that they use.

    The programs have passed their checks.
    """

    def complete(program: Program) -> Program:
        used = sorted(used_parameters(program))
        units = {n: program.units.get(n, study.parameters[n].unit) for n in used}
        return program.model_copy(update={"units": units})

    return _changed(study, complete)


def _changed(study: Study, change: Callable[[Program], Program]) -> Study:
    made = {
        name: e.model_copy(update={"program": change(e.program)})
        for name, e in externals(study).items()
    }
    if not made:
        return study
    return study.model_copy(update={"experiments": {**study.experiments, **made}})


def keeping_runs(study: Study, folder: Path) -> Study:
    """Return a study whose programs keep their runs in a folder."""
    made = {
        name: e.model_copy(
            update={"program": e.program.model_copy(update={"store": str(folder / name)})}
        )
        for name, e in externals(study).items()
    }
    return study.model_copy(update={"experiments": {**study.experiments, **made}})


def program_files(study: Study) -> tuple[str, ...]:
    """Return the files of the user that runs of programs need, templates among them."""
    files = (file for e in externals(study).values() for file in e.program.own_files)
    return tuple(dict.fromkeys(files))


def _located(program: Program, folder: Path) -> Program:
    """Return a program with its files as seen from the working folder."""
    first = program.command[0]
    here = folder / first
    # A path from the home folder stays so: it is another one on another machine.
    if not first.startswith("~") and ("/" in first or here.is_file()):
        found = here.as_posix()
        first = found if "/" in found else f"./{found}"
    return program.model_copy(
        update={
            "template": (folder / program.template).as_posix(),
            "input": program.input_name,
            "command": (first, *program.command[1:]),
            "files": tuple((folder / file).as_posix() for file in program.files),
        }
    )
