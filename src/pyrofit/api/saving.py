"""Studies as files, for the workflow to run a study that was tried in memory."""

import os
from pathlib import Path

from pyrofit.api.arguments import path_of
from pyrofit.api.studies import Source, read_study
from pyrofit.config.expand.programs import externals
from pyrofit.config.keys.study import is_own
from pyrofit.errors import StudyError
from pyrofit.stages.own_files import seen_from, write_study_keys

_COMMENT = "Run it: snakemake --cores 2 --configfile {}"


def write_study(study: Source, path: str | os.PathLike[str]) -> Path:
    """Write a study as a YAML file, which the workflow runs; return its path.

    Keys at their defaults are left out. Measured files stay where they are.

    Raises
    ------
    StudyError
        An external program simulates one of its experiments.
    DataError
        The file cannot be written.
    """
    path, study = path_of("path", path), read_study(study)
    if outside := externals(study):
        raise StudyError(
            f"experiments.{min(outside)}: an external program simulates it; change the study's "
            "own file instead"
        )
    keys = study.model_dump(mode="json", exclude_defaults=True)
    for experiment in keys["experiments"].values():
        for signal in experiment["signals"].values():
            if is_own(signal["file"]):
                signal["file"] = seen_from(path.parent, signal["file"])
    write_study_keys(study, keys, path, _COMMENT.format(path.name))
    return path
