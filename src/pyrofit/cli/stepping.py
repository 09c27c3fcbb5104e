"""Commands of the steps that a study may go without, built of what each step declares."""

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args, get_origin

from pyrofit.cli.common import add_own_options, open_study, tell
from pyrofit.cli.parser import Parser
from pyrofit.errors import CostError, StudyError, suggest
from pyrofit.steps import known_steps
from pyrofit.steps.base import Step

if TYPE_CHECKING:
    from pyrofit.config import Study


def add(commands: Any) -> None:
    """Add a command for each step."""
    for step in known_steps().values():
        words = f"{step.words[0].upper()}{step.words[1:]}."
        command: Parser = commands.add_parser(step.name, help=step.words, description=words)
        command.add_argument("study", type=Path, help="study file (YAML or JSON)")
        if step.part:
            command.add_argument(
                f"--{step.part}",
                dest="part",
                metavar="NAME",
                help="the part to compute; without: gather all",
            )
        if step.write:
            command.add_argument(
                "--write", type=Path, metavar="FILE", help=f"write {step.write} there, too"
            )
        command.late = partial(_add_options, step)
        add_own_options(command, partial(_run, step))


def _add_options(step: Step, command: argparse.ArgumentParser) -> None:
    """Add the options of a step, each a key of the study, too."""
    if step.options is None:
        return
    group = command.add_argument_group("options of the step, as keys of the study")
    for name, field in step.options.model_fields.items():
        origin, inside = get_origin(field.annotation), get_args(field.annotation)
        more: dict[str, Any] = {"choices": inside} if origin is Literal else {}
        more |= {"nargs": "+"} if origin is tuple else {}
        default = field.default
        shown = " ".join(map(str, default)) if isinstance(default, tuple) else default
        said = "" if default in (None, ()) else f"; default: that of the study, else {shown}"
        group.add_argument(
            f"--{name.replace('_', '-')}",
            dest=f"option_{name}",
            metavar=None if origin is Literal else name.upper(),
            help=f"{field.description}{said}",
            **more,
        )


def _run(step: Step, given: argparse.Namespace) -> None:
    """Compute a step or one of its parts, or gather the parts; then write its page."""
    from pyrofit.results.step import check_options, inputs_of, write_options
    from pyrofit.stages import measurements

    study, results, part = _open(step, given)
    inputs = inputs_of(step.name)
    if part or not step.part:
        if given.by_hand and inputs.reads == ("measurements",):
            measurements.prepare(study, results)  # by hand, without the workflow that has read them
        compute = step.load("compute")
        try:
            made = compute.run(study, results, tell, given.cores, *part)
        except (CostError, StudyError) as error:
            raise type(error)(f"{given.study}: {error}") from None
        write_options(study, results, step.name, *part)
        if step.write and given.write is not None:
            compute.write(study, results, made, given.write)
            tell(f"{given.write}: {step.write}")
    if not part:
        check_options(study, results, step.name)
        page = step.load("page").PAGE
        page.write(study, results)
        for line in page.sentences(study, results):
            print(line)
    if results.by_hand:
        tell(
            f"With these options, the results stand in {results.folder(step.name)}, not among "
            "those of the study"
        )


def _open(step: Step, given: argparse.Namespace) -> tuple[Any, Any, tuple[str, ...]]:
    """Return study with the options given, results and part."""
    from pyrofit.results.files import Results
    from pyrofit.results.step import inputs_of

    part: tuple[str, ...] = () if getattr(given, "part", None) is None else (given.part,)
    own: list[Study] = []

    def asked(study: "Study") -> "Study":
        own.append(study)
        parts = inputs_of(step.name).parts(study)
        for name in set(part) - {*parts}:
            raise StudyError(
                f"{given.study}: study '{study.name}' has no {step.part} '{name}'. "
                + suggest(name, parts)
            )
        return _with_options(study, step, given)

    study, results = open_study(given, change=asked)
    if study.steps != own[0].steps:
        results = Results(results.root, by_hand=step.name)
    return study, results, part


def _with_options(study: "Study", step: Step, given: argparse.Namespace) -> "Study":
    """Return a study with the options of the command line."""
    from pydantic import ValidationError

    from pyrofit.config.keys.steps import with_options
    from pyrofit.config.words import in_plain_words

    options = {
        name.removeprefix("option_"): value
        for name, value in vars(given).items()
        if name.startswith("option_") and value is not None
    }
    if not options:
        return study
    try:
        steps = with_options(study.steps, step.name, options)
    except ValidationError as error:
        said = "; ".join(f"--{line.replace('_', '-')}" for line in in_plain_words(error, options))
        raise StudyError(said) from None
    return study.model_copy(update={"steps": steps})
