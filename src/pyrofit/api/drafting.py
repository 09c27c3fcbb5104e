"""Drafts of studies from measured files, and from series in memory."""

import os
import re
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.api.arguments import word_of
from pyrofit.api.given_tables import as_table, named_in_memory
from pyrofit.config import Study, as_study
from pyrofit.config.keys.study import IN_MEMORY
from pyrofit.config.yaml_file import read_mapping
from pyrofit.errors import DataError, StudyError, suggest
from pyrofit.experiments import OF_FILES, files_of, measurable
from pyrofit.new_study.words import assumed
from pyrofit.new_study.write import drafted
from pyrofit.quantities.base import Quantity
from pyrofit.results.files import write_csv

File = str | os.PathLike[str]
Given = File | Iterable[File] | Mapping[str, Any]
"""A file, files, or by the name of an experiment a file, a table, an array, a tuple of columns."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def new_study(name: str, **given: Given) -> Study:
    """Draft a study from measurements, as `pyrofit init` does, without writing anything.

    Columns and units are recognised; the material has one reaction, or three and a char where a
    residue is left, and wide limits. Check the facts that the measurements do not tell, such as the
    thickness, and change them with `read_study`. A study of TGA alone has no slab.

    Parameters
    ----------
    name
        Name of the study: letters, digits and _.
    given
        Measurements by kind of experiment: ``tga``, ``dsc``, ``mcc``, ``gasification``, ``cone``.
        A file or files, or a mapping from names of experiments to a file or a series. A series is
        a table with the headers of a file, or an array or tuple of columns as of `read_data`. It is
        no part of the study: give the same mapping as ``data`` to `fit` and the other functions.

    Raises
    ------
    StudyError
        The name is no name, the kind is not known, or there is no measurement.
    DataError
        A file is no table of numbers, or an array has other columns.

    Warns
    -----
    UserWarning
        Of a heating rate, flux, unit or column that neither a record nor its name tells, and of a
        record that contradicts its name. Of a gas with oxygen, as the model has no oxidation. Of
        two records with the same numbers, which the study has and which it leaves out.

    Examples
    --------
    >>> import numpy as np, pyrofit as pf
    >>> T = np.arange(400.0, 800.0, 5.0)
    >>> mass = 1.0 / (1.0 + np.exp((T - 640.0) / 12.0))
    >>> pf.new_study("pmma", tga={"tga_10K": (6.0 * (T - T[0]), T, mass)})
    study 'pmma'
      parameter T_p: 490 to 670 K
      parameter E_p: 60 to 350 kJ/mol
      parameter y: 0 to 0.051
      experiment tga_10K: TGA; mass_fraction
    """
    name = word_of("name", name)
    with tempfile.TemporaryDirectory() as folder:
        labels: dict[str, str] = {}
        paths = {kind: list(_paths(kind, of, Path(folder), labels)) for kind, of in given.items()}
        if not any(paths.values()):
            raise StudyError(
                "no measured file is given; give files or tables by kind of experiment: "
                f"{', '.join(OF_FILES)}"
            )
        try:
            text, records, copied = drafted(name, paths)
        except (DataError, StudyError) as error:
            raise type(error)(named_in_memory(str(error), labels)) from None
        draft = Path(folder) / "draft.yaml"
        draft.write_text(text, encoding="utf-8")
        keys = read_mapping(draft)
    for line in [*copied, *assumed(records)]:
        warnings.warn(f"study '{name}': {named_in_memory(line, labels)}", stacklevel=2)
    where = {
        f"data/{record.name}.csv": IN_MEMORY if str(record.path) in labels else str(record.path)
        for record in records
    }
    return as_study(_with_files(keys, where), name)


def _paths(kind: str, given: Any, folder: Path, labels: dict[str, str]) -> Iterator[Path]:
    """Yield the files of a kind of experiment; series in memory are written to a folder."""
    if kind not in OF_FILES:
        raise StudyError(f"unknown kind of experiment '{kind}'. {suggest(kind, OF_FILES)}")
    if isinstance(given, Mapping):
        for name, one in given.items():
            if isinstance(one, str | os.PathLike):
                yield Path(one)
            else:
                yield _written(kind, name, one, folder, labels)
        return
    if isinstance(given, str | os.PathLike):
        given = [given]
    # Going through a table yields its headers, which would be taken for names of files.
    is_table = isinstance(given, pd.DataFrame | np.ndarray) or not isinstance(given, Iterable)
    files = [] if is_table else list(given)
    if is_table or not all(isinstance(file, str | os.PathLike) for file in files):
        raise StudyError(
            f"{kind}: give paths of files, or tables by the name of their experiment, such as "
            f"{kind}={{'{kind}_1': table}}; this is a {type(given).__name__}"
        )
    yield from map(Path, files)


def _written(kind: str, name: Any, given: Any, folder: Path, labels: dict[str, str]) -> Path:
    """Write a series in memory as a file of its name, and return its path."""
    if not (isinstance(name, str) and _NAME.fullmatch(name)):
        raise StudyError(
            f"{kind}: {name!r} is no name of an experiment; letters, digits and _ make one, a "
            "letter first, as tga_10K"
        )
    label = f"data of {name}"
    table = as_table(given, _quantity_of_arrays(kind, given, label), label)
    path = folder / kind / f"{name}.csv"
    path.parent.mkdir(exist_ok=True)
    write_csv(path, table)
    labels[str(path)] = label
    return path


def _quantity_of_arrays(kind: str, given: Any, label: str) -> Quantity:
    """Return the quantity that the arrays of a kind hold: its only one, or the one of most use."""
    known = measurable(kind)
    usual = next(iter(known)) if len(known) == 1 else files_of(kind).computed_signal
    if usual in known:
        return known[usual]
    if isinstance(given, pd.DataFrame):
        return next(iter(known.values()))
    raise StudyError(
        f"{label}: a test of the kind {kind} measures {', '.join(known)}; give a table whose "
        "headers tell the quantities"
    )


def _with_files(part: Any, where: Mapping[str, str]) -> Any:
    """Return keys in which the copies of files are the files themselves."""
    if isinstance(part, Mapping):
        return {key: _with_files(of, where) for key, of in part.items()}
    if isinstance(part, list):
        return [_with_files(of, where) for of in part]
    return where.get(part, part) if isinstance(part, str) else part
