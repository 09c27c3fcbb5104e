"""Rules for external programs of a study: their files, templates, patterns and units."""

import re

import numpy as np

from pyrofit.config.check.numbers import alike_units
from pyrofit.config.expand.programs import externals
from pyrofit.config.keys.study import Study
from pyrofit.config.words import require
from pyrofit.errors import DataError, ProgramError, suggest
from pyrofit.external.filled import other_files, template_text, used_parameters
from pyrofit.external.output import in_si
from pyrofit.external.template import check_template, places_of_names
from pyrofit.model.expressions import FUNCTIONS, names_of
from pyrofit.model.external import ExternalExperiment
from pyrofit.model.program import Program


def check_programs(study: Study) -> None:
    """Check the programs of a study, whose files are seen from the working folder.

    Raises
    ------
    ValueError
        With place, file and line, rule and remedy.
    """
    for name, experiment in externals(study).items():
        _check_program(study, f"experiments.{name}.program", experiment)


def _check_program(study: Study, place: str, experiment: ExternalExperiment) -> None:
    program = experiment.program
    try:
        text = template_text(program)
        other_files(program)
        check_template(program.template, text, {*study.parameters, *program.placeholders})
    except ProgramError as error:
        raise ValueError(f"{place}: {error}") from None
    _check_placeholders(study, place, program, {n for n, _ in places_of_names(text)})
    _check_units(study, place, program, used_parameters(program))
    for key in ("succeeds", "fails"):
        _check_pattern(f"{place}.{key}", getattr(program, key))
    for signal, reading in program.reads.items():
        dummy = {role: np.ones(2) for role in reading.heads}
        try:
            in_si(reading, experiment.quantity(signal), dummy)
        except DataError as error:
            raise ValueError(f"{place}.reads.{signal}: {error}") from None


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
