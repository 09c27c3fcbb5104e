"""Studies from files, mappings or other studies, with changes."""

import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pyrofit import config
from pyrofit.config import Study, as_study
from pyrofit.config.check.unusual import unusual_values
from pyrofit.config.yaml_file import read_mapping
from pyrofit.errors import StudyError

Source = Study | str | os.PathLike[str] | Mapping[str, Any]
"""A study, its file, or its keys."""


def read_study(source: Source, **changes: Any) -> Study:
    """Read and check a study.

    Parameters
    ----------
    source
        Path of a YAML file, a mapping of the same keys, or a study. Files of measurements are
        found relative to the folder of the YAML file, or to the working folder.
    changes
        Keys that differ from the source. Mappings are merged key by key, all else is replaced.
        ``**{"parameters.k.upper": 0.5}`` reaches a single key. None removes a key: a product, a
        parameter, an experiment, or a value that has a default.

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
        new = merged_keys(keys, changes)
        _check_kept(keys["parameters"], new.get("parameters"))
        return _told(as_study(new, f"study '{source.name}'", located=True))
    if isinstance(source, Mapping):
        return _told(as_study(merged_keys(source, changes), "study"))
    if not isinstance(source, str | os.PathLike):
        raise StudyError(
            f"study: this is a {type(source).__name__}; give the path of a study file, a "
            "mapping of its keys, or a study"
        )
    path = Path(source)
    if not changes:
        return _told(config.read_study(path))
    return _told(as_study(merged_keys(read_mapping(path), changes), str(path)))


def _told(study: Study) -> Study:
    """Return the study; warn of its unusual values and names."""
    for line in unusual_values(study):
        warnings.warn(f"study '{study.name}': {line}", stacklevel=3)
    return study


def _check_kept(old: Mapping[str, Any], new: Any) -> None:
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
                "parameter. Give `lower` and `upper` as well, and name it under `estimate`"
            )
        if parameter.get("expression") != before.get("expression"):
            raise StudyError(
                f"parameters.{name}.expression: a study that was read keeps its expressions; "
                "change it with the study's file or keys"
            )


def merged_keys(given: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return keys with changes.

    >>> merged_keys({"a": {"b": 1, "c": 2}}, {"a.b": 3, "a.c": None, "d": 4})
    {'a': {'b': 3}, 'd': 4}
    """
    result = dict(given)
    for name, new in changes.items():
        key, _, rest = name.partition(".")
        new = {rest: new} if rest else new
        if new is None and key in result:
            del result[key]  # no key with a default of its own takes an empty value
            continue
        if isinstance(new, Mapping):
            old = result.get(key)
            new = merged_keys(old if isinstance(old, Mapping) else {}, new)
        result[key] = new
    return result
