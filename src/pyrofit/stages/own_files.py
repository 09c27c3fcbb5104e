"""Where a study that is written into a folder of results finds the files of the first one."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pyrofit.config import Study, as_yaml
from pyrofit.config.keys.study import is_own
from pyrofit.results.files import Results, read_csv, write_text


def files_seen_from(
    study: Study, results: Results, folder: Path
) -> Iterator[tuple[tuple[str, str], dict[str, Any]]]:
    """Yield keys by signal: where a study in another folder finds the files of this one.

    Synthetic measurements are the tables that were made of them.
    """
    for name, experiment in study.experiments.items():
        for quantity, signal in experiment.signals.items():
            if study.is_computed(name, quantity):
                table = results.measurement(name, quantity)
                has = read_csv(table).columns
                keys = study.experiments[name].quantity(quantity).tidy_keys()
                columns = {role: c for role, c in keys["columns"].items() if c in has}
                units = {role: keys["units"][role] for role in columns}
                file = seen_from(folder, table)
                yield (name, quantity), {"file": file, "columns": columns, "units": units}
            elif is_own(signal.file):
                yield (name, quantity), {"file": seen_from(folder, signal.file)}


def seen_from(folder: Path, path: str | Path) -> str:
    """Return a path relative to a folder."""
    return Path(os.path.relpath(path, folder)).as_posix()


def write_study_keys(study: Study, keys: dict[str, Any], path: Path, comment: str) -> None:
    """Write keys that were made of a study as a study file; it finds the study's plugins."""
    if study.plugins:
        keys["plugins"] = [seen_from(path.parent, folder) for folder in study.plugins]
    write_text(path, as_yaml(keys, comment))
