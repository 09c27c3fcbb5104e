"""What a step rests on, and with which options its results were made."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results.dependencies import Slice
from pyrofit.results.files import Results, read_json, write_json
from pyrofit.steps import known_steps


def _no_parts(study: Study) -> list[str]:
    return []


@dataclass(frozen=True)
class Inputs:
    """What a step reads and depends on, and what it leaves behind.

    Parameters
    ----------
    reads
        Groups of files that it reads, by the names in `workflow/rules/steps.smk`.
    slice_of
        Function of a study, and of a part where there are parts. It returns all on which the
        results depend but the step's options and the files that it reads.
    files
        Files that it leaves in its folder, or gathers of its parts; the last is written last.
    folders
        Folders in it.
    parts, part_file
        Function of a study that returns the names of its parts, and the file of each.
    of_parts
        Options that only tell which parts there are.
    gathers
        Groups of files that are read with its parts.
    version
        For parts that are not repeated unless asked for: a digest of those on the page.
    """

    reads: tuple[str, ...]
    slice_of: Callable[..., Slice]
    files: tuple[str, ...]
    folders: tuple[str, ...] = ()
    parts: Callable[[Study], Sequence[str]] = _no_parts
    part_file: str = ""
    of_parts: tuple[str, ...] = ()
    gathers: tuple[str, ...] = ()
    version: Callable[[Study, Results], str] | None = None


def inputs_of(step: str) -> Inputs:
    """Return the inputs of a step."""
    found: Inputs = known_steps()[step].load("inputs").INPUTS
    return found


def slice_of(study: Study, step: str, *part: str) -> Slice:
    """Return all on which a step, or a part of it, depends but the files that it reads."""
    return {
        **inputs_of(step).slice_of(study, *part),
        "options": _options(study, step, bool(part)),
    }


def exists(study: Study, results: Results, step: str) -> bool:
    """Tell whether a step was made and its page drawn, and both are up to date."""
    inputs = inputs_of(step)
    if inputs.version is not None:
        return bool(inputs.version(study, results))
    return results.of_step(step, inputs.files[-1]).is_file()


def write_options(study: Study, results: Results, step: str, *part: str) -> None:
    """Write the options of a step, or of a part of it, beside its results."""
    if options := _options(study, step, bool(part)):
        write_json(_made_with(results, step, *part), options)


def check_options(study: Study, results: Results, step: str) -> None:
    """Refuse results that were made with other options than those of the study.

    Raises
    ------
    DataError
        With the file that holds their options.
    """
    if step not in known_steps():
        return
    parts: Sequence[str] = inputs_of(step).parts(study)
    for part in [[name] for name in parts] or [[]]:
        options = _options(study, step, bool(part))
        path = _made_with(results, step, *part)
        if options and read_json(path) != options:
            raise DataError(
                f"{path}: these results were made with other options than those of the study; "
                f"delete the folder and run `snakemake {step}` again"
            )


def _made_with(results: Results, step: str, *part: str) -> Path:
    return results.of_step(step, f"{'_'.join(['options', *part])}.json")


def _options(study: Study, step: str, of_part: bool) -> Slice:
    options = dict(study.steps).get(step)
    left_out = {*inputs_of(step).of_parts} if of_part else set()
    return {} if options is None else options.model_dump(mode="json", exclude=left_out)
