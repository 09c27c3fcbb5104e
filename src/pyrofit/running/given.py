"""The study of a run as it is given: in files, or by a workflow that uses this one as a module."""

import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from snakemake.utils import update_config

from pyrofit.config import read_mapping
from pyrofit.config.yaml_file import as_read
from pyrofit.errors import StudyError

FILE = "study"
"""Key of a module's configuration that names a study file."""
_PROGRAMS = "__use_yte__"
"""Key by which a YAML file holds programs for Snakemake."""
DEFAULT = "config/twin.yaml"
"""The study that runs if none is given."""


class GivenStudy(NamedTuple):
    """A study as it is given.

    Parameters
    ----------
    keys
        Its keys, unchecked.
    source
        The file that errors name. Files of the study are found from its folder.
    files
        All files that it was read from.
    """

    keys: dict[str, Any]
    source: str
    files: list[str]


def check_files(words: Sequence[str]) -> None:
    """End this process with a line on a study that Snakemake is given and that cannot be read.

    Snakemake itself would name neither the file nor the line, or show a traceback.

    Parameters
    ----------
    words
        Arguments of Snakemake, such as ``["--configfile", "mywood.yaml"]``.
    """
    try:
        for file in _config_files(words):
            check_file(Path(file))
    except StudyError as error:
        print(f"error: {error}", file=sys.stderr)
        raise SystemExit(2) from None


def check_file(file: Path) -> None:
    """Refuse a study that Snakemake cannot read, or that would run programs as it is read.

    Raises
    ------
    StudyError
        With file and line where it is no YAML; the nearest file where there is none.
    """
    if _PROGRAMS in read_mapping(file):
        raise StudyError(
            f"{file}: {_PROGRAMS}: it lets Snakemake run programs in the file; delete this key"
        )


def _config_files(words: Sequence[str]) -> list[str]:
    """Return the files behind ``--configfile``.

    >>> _config_files(["--cores", "1", "--configfile", "a.yaml", "b.yaml", "-n", "--configfile=c"])
    ['a.yaml', 'b.yaml', 'c']
    """
    files: list[str] = []
    inside = False
    for word in words:
        option, _, value = word.partition("=")
        if option in ("--configfile", "--configfiles"):
            inside = not value
            files += [value] if value else []
        elif word.startswith("-"):
            inside = False
        elif inside:
            files.append(word)
    return files


def study_of_files(files: Sequence[str], changes: Mapping[str, Any]) -> GivenStudy:
    """Return the study of one or more files, the later ones and ``changes`` on top.

    The files are read anew: to Snakemake a key may stand twice, and 1e-3 is text.

    Raises
    ------
    StudyError
        There is no file, or one of them cannot be read.
    """
    if not files:
        raise StudyError(
            f"no study is given, and {DEFAULT} is not here; give yours: --configfile STUDY"
        )
    places = [os.path.relpath(file) for file in files]
    keys: dict[str, Any] = {}
    for place in places:
        update_config(keys, read_mapping(Path(place)))
    update_config(keys, dict(changes))
    return GivenStudy(keys, places[0], places)


def from_workflow(files: Sequence[str], config: Mapping[str, Any]) -> GivenStudy:
    """Return the study that another workflow gives.

    Parameters
    ----------
    files
        Configuration files of the other workflow.
    config
        The keys of a study; or the name of a study file as ``study``, and keys that change it.

    Raises
    ------
    StudyError
        There is no study, or its file cannot be read.
    """
    if FILE in config:
        return study_of_files([config[FILE]], {k: v for k, v in config.items() if k != FILE})
    if not config:
        raise StudyError(
            f"no study is given; write in the module: config: {{'{FILE}': 'mywood/mywood.yaml'}}"
        )
    places = [os.path.relpath(file) for file in files]
    return GivenStudy(as_read(config), places[0] if places else "config.yaml", places)
