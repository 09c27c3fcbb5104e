"""Input of a run and its digest: the filled template, its other files, the program itself."""

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

from pyrofit.errors import ProgramError
from pyrofit.external.fds import NO_FDS, fds_environment, find_fds
from pyrofit.external.template import bytes_of, fill_template, places_of_names, read_bytes, text_of
from pyrofit.model.expressions import names_of, value_of_expression
from pyrofit.model.parameters import UNITS
from pyrofit.model.program import Program


class Filled(NamedTuple):
    """The input of a run, and a digest of everything that the output depends on."""

    content: bytes
    key: str


def template_text(program: Program) -> str:
    """Return the text of the template, read once."""
    return program.derived("template", lambda p: text_of(read_bytes(Path(p.template))))


def other_files(program: Program) -> dict[str, bytes]:
    """Return the other files of a run by name, read once."""
    return program.derived(
        "files", lambda p: {Path(file).name: read_bytes(Path(file)) for file in p.files}
    )


def file_digests(program: Program) -> dict[str, str]:
    """Return the SHA-256 of template and other files, by file."""
    contents = [bytes_of(template_text(program)), *other_files(program).values()]
    return {
        file: hashlib.sha256(content).hexdigest()
        for file, content in zip(program.own_files, contents, strict=True)
    }


def used_parameters(program: Program) -> set[str]:
    """Return the names of the parameters in the template and the expressions."""
    direct = {name for name, _ in places_of_names(template_text(program))} - set(
        program.placeholders
    )
    given = program.placeholders.values()
    return direct.union(*(names_of(e) for e in given if isinstance(e, str)))


def placeholder_values(program: Program, values: Mapping[str, float]) -> dict[str, float]:
    """Return the number of every placeholder.

    Parameters
    ----------
    program
        The program, whose ``units`` name the unit of each parameter that it uses.
    values
        Parameter values in SI units by name.
    """
    found = {name: values[name] / UNITS[unit] for name, unit in program.units.items()}
    given = {
        name: value_of_expression(e, found) if isinstance(e, str) else e
        for name, e in program.placeholders.items()
    }
    return found | given


def executable_of(program: Program) -> Path:
    """Return the executable file of a program.

    Raises
    ------
    ProgramError
        There is none.
    """
    word = program.command[0]
    if program.dialect == "fds" and word == "fds":
        path = find_fds()
        if path is None:
            raise ProgramError(NO_FDS)
        return path
    if "/" in word:
        # Not resolved: a program may depend on the name of its link.
        path = Path(word).expanduser().absolute()
        if path.is_file() and os.access(path, os.X_OK):
            return path
        raise ProgramError(
            f"program.command: '{word}' is no executable file; correct the path, or make the file "
            "executable"
        )
    found = shutil.which(word)
    if found is None:
        raise ProgramError(
            f"program.command: there is no program '{word}' on the PATH; install it, load its "
            "module, or give its path"
        )
    return Path(found).absolute()


def words_of_command(program: Program) -> list[str]:
    """Return the words that start the program."""
    return [str(executable_of(program)), *program.command[1:]]


def environment_of(program: Program) -> dict[str, str]:
    """Return the environment of a run; FDS gets no variable that changes a result."""
    usual = fds_environment() if program.dialect == "fds" else dict(os.environ)
    return {**usual, "OMP_NUM_THREADS": str(program.cores), **program.environment}


def executable_digest(program: Program) -> str:
    """Return the SHA-256 of the executable file."""
    path = executable_of(program)
    about = path.stat()
    return _digest(path, about.st_size, about.st_mtime_ns)


@cache
def _digest(path: Path, size: int, time_ns: int) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def filled_input(program: Program, values: Mapping[str, float]) -> Filled:
    """Return the input of a run.

    Raises
    ------
    ValueError
        A placeholder has no finite value.
    """
    content = bytes_of(fill_template(template_text(program), placeholder_values(program, values)))
    described = program.model_dump(
        mode="json",
        include={"command", "reads", "dialect", "succeeds", "fails", "environment", "cores"},
    )
    described["input"] = program.input_name
    described["files"] = {n: hashlib.sha256(b).hexdigest() for n, b in other_files(program).items()}
    described["executable"] = executable_digest(program)
    whole = hashlib.sha256(json.dumps(described, sort_keys=True).encode())
    whole.update(content)
    return Filled(content, whole.hexdigest()[:40])
