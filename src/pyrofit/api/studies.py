"""Studies from files, mappings or other studies, with changes; drafts from measured files."""

import os
import tempfile
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from pyrofit import config
from pyrofit.config import Study, as_study
from pyrofit.config.unusual import unusual
from pyrofit.config.yaml_file import read_mapping
from pyrofit.errors import StudyError, suggest
from pyrofit.new_study.words import assumed
from pyrofit.new_study.write import drafted

Source = Study | str | os.PathLike[str] | Mapping[str, Any]
"""A study, its file, or its keys."""
Files = str | os.PathLike[str] | Iterable[str | os.PathLike[str]]


def read_study(source: Source, **changes: Any) -> Study:
    """Read and check a study.

    Parameters
    ----------
    source
        Path of a YAML file, a mapping of the same keys, or a study. Files of measurements are
        found relative to the folder of the YAML file, or to the working folder.
    changes
        Keys that differ from the source. Mappings are merged key by key, all else is replaced.
        ``**{"parameters.k.upper": 0.5}`` reaches a single key.

    Raises
    ------
    StudyError
        With key, rule and way out for everything that is wrong.

    Warns
    -----
    UserWarning
        Of unusual values, most often because of a wrong unit.

    Examples
    --------
    >>> import pyrofit as pf
    >>> study = pf.read_study("config/smoke.yaml", imp={"repetitions": 3}, seed=1)
    >>> study.imp.repetitions, study.seed
    (3, 1)
    """
    if isinstance(source, Study):
        if not changes:
            return source
        keys = source.model_dump(mode="json")
        new = merged(keys, changes)
        _check_kept(keys["parameters"], new["parameters"])
        return _told(as_study(new, f"study '{source.name}'", located=True))
    if isinstance(source, Mapping):
        return _told(as_study(merged(source, changes), "study"))
    if not isinstance(source, str | os.PathLike):
        raise StudyError(
            f"study: this is a {type(source).__name__}; give the path of a study file, a "
            "mapping of its keys, or a study"
        )
    path = Path(source)
    if not changes:
        return _told(config.read_study(path))
    return _told(as_study(merged(read_mapping(path), changes), str(path)))


def _told(study: Study) -> Study:
    """Return the study; warn of its unusual values and names."""
    for line in unusual(study):
        warnings.warn(f"study '{study.name}': {line}", stacklevel=3)
    return study


def _check_kept(old: Mapping[str, Any], new: Mapping[str, Any]) -> None:
    """Refuse changes of expressions, which stand in all their places, and of parameters held."""
    if not isinstance(new, Mapping):
        return  # the check of the whole study says so
    for name, parameter in new.items():
        if not isinstance(parameter, Mapping):
            continue
        before = old.get(name, {})
        held = before.get("fixed") is not None and parameter.get("fixed") is None
        if held and (parameter.get("lower") is None or parameter.get("upper") is None):
            raise StudyError(
                f"parameters.{name}.fixed: a study that was read has no limits of a fixed "
                "parameter; give `lower` and `upper` as well, and name it under `estimate`"
            )
        if parameter.get("expression") != before.get("expression"):
            raise StudyError(
                f"parameters.{name}.expression: a study that was read keeps its expressions; "
                "change it with the study's file or keys"
            )


def merged(given: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return keys with changes.

    >>> merged({"a": {"b": 1, "c": 2}}, {"a.b": 3, "d": 4})
    {'a': {'b': 3, 'c': 2}, 'd': 4}
    """
    result = dict(given)
    for name, new in changes.items():
        key, _, rest = name.partition(".")
        new = {rest: new} if rest else new
        if isinstance(new, Mapping):
            old = result.get(key)
            new = merged(old if isinstance(old, Mapping) else {}, new)
        result[key] = new
    return result


def new_study(name: str, **files: Files) -> Study:
    """Draft a study from measured files, as `pyrofit init` does, without writing anything.

    Columns and units are recognised; the material has one reaction and wide limits. Check the
    facts that the files do not tell, such as the thickness, and change them with `read_study`. A
    study of TGA alone has no slab.

    Parameters
    ----------
    name
        Name of the study: letters, digits and _.
    files
        A file or files by kind of experiment: ``tga``, ``dsc``, ``mcc``, ``gasification``,
        ``cone``.

    Raises
    ------
    StudyError
        The name is no name, the kind is not known, or there is no file.
    DataError
        A file is no table of numbers.

    Warns
    -----
    UserWarning
        Of a heating rate, flux or unit that neither a file nor its name tells.
    """
    paths = {kind: _paths(of) for kind, of in files.items()}
    _check_kinds(paths)
    with tempfile.TemporaryDirectory() as folder:
        text, records = drafted(name, paths)
        draft = Path(folder) / f"{name}.yaml"
        draft.write_text(text, encoding="utf-8")
        keys = read_mapping(draft)
    where = {f"data/{record.name}.csv": str(record.path) for record in records if record.path}
    for line in assumed(records):
        warnings.warn(f"study '{name}': {line}", stacklevel=2)
    return as_study(_with_files(keys, where), name)


def _paths(given: Files) -> list[Path]:
    if isinstance(given, str | os.PathLike):
        return [Path(given)]
    # Going through a table yields its headers, which would be taken for names of files.
    is_table = isinstance(given, pd.DataFrame) or not isinstance(given, Iterable)
    files = [] if is_table else list(given)
    if is_table or not all(isinstance(file, str | os.PathLike) for file in files):
        raise StudyError(
            "a new study needs paths of files; write a table to a file first, such as "
            "table.to_csv('tga_10K.csv', index=False)"
        )
    return [Path(file) for file in files]


def _check_kinds(paths: Mapping[str, list[Path]]) -> None:
    from pyrofit.experiments import OF_FILES

    for kind in paths:
        if kind not in OF_FILES:
            raise StudyError(f"unknown kind of experiment '{kind}'. {suggest(kind, OF_FILES)}")
    if not any(paths.values()):
        known = ", ".join(OF_FILES)
        raise StudyError(f"no measured file is given; give files by kind of experiment: {known}")


def _with_files(part: Any, where: Mapping[str, str]) -> Any:
    """Return keys in which the copies of files are the files themselves."""
    if isinstance(part, Mapping):
        return {key: _with_files(of, where) for key, of in part.items()}
    if isinstance(part, list):
        return [_with_files(of, where) for of in part]
    return where.get(part, part) if isinstance(part, str) else part
