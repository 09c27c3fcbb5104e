"""External programs of a study: places of their files, parameters of templates, and checks."""

import re
from pathlib import Path

import numpy as np

from pyrofit.config.numbers import alike_units, require
from pyrofit.config.study import Study
from pyrofit.errors import DataError, ProgramError, suggest
from pyrofit.external.filled import other_files, template_text, used_parameters
from pyrofit.external.output import in_si
from pyrofit.external.template import check_template, places
from pyrofit.model.expressions import FUNCTIONS, names_of
from pyrofit.model.external import ExternalExperiment
from pyrofit.model.program import Program


def externals(study: Study) -> dict[str, ExternalExperiment]:
    """Return the experiments that external programs simulate, by name."""
    return {n: e for n, e in study.experiments.items() if isinstance(e, ExternalExperiment)}


def with_programs(study: Study, folder: Path | None) -> Study:
    """Return a study with the places of its programs and the units of their parameters.

    Parameters
    ----------
    study
        The study; each key is valid by itself.
    folder
        Folder of the study file; None if the files are found already.

    Raises
    ------
    ValueError
        With place, file and line, rule and remedy.
    """
    made = {
        name: e.model_copy(update={"program": _checked(study, name, e, folder)})
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


def _checked(
    study: Study, name: str, experiment: ExternalExperiment, folder: Path | None
) -> Program:
    place = f"experiments.{name}.program"
    program = _located(experiment.program, folder)
    try:
        text = template_text(program)
        other_files(program)
        check_template(program.template, text, {*study.parameters, *program.placeholders})
    except ProgramError as error:
        raise ValueError(f"{place}: {error}") from None
    _check_placeholders(study, place, program, {n for n, _ in places(text)})
    used = used_parameters(program)
    _check_units(study, place, program, used)
    for key in ("succeeds", "fails"):
        _check_pattern(f"{place}.{key}", getattr(program, key))
    for signal, reading in program.reads.items():
        dummy = {role: np.ones(2) for role in reading.heads}
        try:
            in_si(reading, experiment.quantity(signal), dummy)
        except DataError as error:
            raise ValueError(f"{place}.reads.{signal}: {error}") from None
    units = {n: program.units.get(n, study.parameters[n].unit) for n in sorted(used)}
    return program.model_copy(update={"units": units})


def _located(program: Program, folder: Path | None) -> Program:
    """Return a program with its files as seen from the working folder."""
    if folder is None:
        return program
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


def _check_placeholders(study: Study, place: str, program: Program, there: set[str]) -> None:
    """Refuse placeholders that the template lacks, that hide a parameter, or use unknown ones."""
    for name, given in program.placeholders.items():
        at = f"{place}.placeholders.{name}"
        require(name in there, at, f"{program.template} has no '#{name}#'; delete it")
        require(
            name not in study.parameters,
            at,
            "this is a parameter, too; give the placeholder another name",
        )
        if isinstance(given, str):
            for parameter in sorted(_names(at, given)):
                require(
                    parameter in study.parameters,
                    at,
                    f"unknown parameter '{parameter}'. "
                    + suggest(parameter, {*study.parameters, *FUNCTIONS}),
                )


def _names(place: str, expression: str) -> set[str]:
    try:
        return names_of(expression)
    except ValueError as error:
        raise ValueError(f"{place}: {error}") from None


def _check_units(study: Study, place: str, program: Program, used: set[str]) -> None:
    """Refuse units of unused parameters, those of another quantity, and expressions."""
    for name in sorted(used & set(study.parameters)):
        require(
            study.parameters[name].expression is None,
            f"{place}.template",
            f"'{name}' is an expression; a program has its own: name it under `placeholders`",
        )
    for name, unit in program.units.items():
        at = f"{place}.units.{name}"
        require(
            name in used,
            at,
            f"{program.template} does not use it. {suggest(name, used)}",
        )
        own = study.parameters[name].unit
        fitting = alike_units(own)
        require(
            unit in fitting,
            at,
            f"'{unit}' is no unit of a parameter in {own}; give {' or '.join(fitting)}",
        )


def _check_pattern(place: str, pattern: str) -> None:
    try:
        re.compile(pattern)
    except re.error as error:
        raise ValueError(f"{place}: '{pattern}' is no regular expression ({error})") from None
