"""Which effect the model lacks: the diagnosis of a study, and the study with what it found."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pyrofit.config import Study, as_yaml
from pyrofit.config.study import is_own
from pyrofit.diagnose.diagnosis import examine
from pyrofit.diagnose.result.extended_study import extended_keys
from pyrofit.diagnose.search.step import Tell
from pyrofit.results import diagnosis
from pyrofit.results.files import Results, read_csv, write_csv, write_text
from pyrofit.stages.measurements import load

EXTENDED = "extended.yaml"
_COMMENT = """\
The study that was diagnosed, with the effects that were found at their fitted strengths. It runs:
snakemake --cores 2 --configfile <this file>. Leave a strength out to have it estimated: add the
parameter <effect>_<strength> to imp.estimate then.
"""


def diagnose(study: Study, results: Results, tell: Tell, processes: int = 1) -> dict[str, Any]:
    """Diagnose a study from its measurements; write ``diagnosis``, return ``diagnosis.json``.

    Raises
    ------
    DataError
        A measurement is missing, a channel is too short, or no run within the limits finishes.
    """
    found = examine(study, load(study, results), tell, processes)
    effects = found.search.end.effects
    path = results.diagnosis(EXTENDED)
    path.unlink(missing_ok=True)  # that of an earlier diagnosis
    if effects:
        signals = dict(_files(study, results, path.parent))
        keys = extended_keys(study, found.search.end, signals)
        if study.plugins:
            keys["plugins"] = [_seen_from(path.parent, folder) for folder in study.plugins]
        write_text(path, as_yaml(keys, _COMMENT))
    found.content["extended_study"] = EXTENDED if effects else ""
    write_csv(results.diagnosis("curves.csv"), found.curves)
    diagnosis.write(results, found.content)
    return found.content


def _files(
    study: Study, results: Results, folder: Path
) -> Iterator[tuple[tuple[str, str], dict[str, Any]]]:
    """Yield where the extended study, in its folder, finds files of its own.

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
                file = _seen_from(folder, table)
                yield (name, quantity), {"file": file, "columns": columns, "units": units}
            elif is_own(signal.file):
                yield (name, quantity), {"file": _seen_from(folder, signal.file)}


def _seen_from(folder: Path, path: str | Path) -> str:
    return Path(os.path.relpath(path, folder)).as_posix()
