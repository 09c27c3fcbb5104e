"""All checks, in the order of the report."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pyrofit.config import read_mapping, read_study
from pyrofit.data.fetch import missing, registry, store
from pyrofit.doctor.finding import Check, ReadyLine, Situation
from pyrofit.doctor.machine import available_cores, cache, check_cores, check_versions, disk, memory
from pyrofit.doctor.slurm import slurm
from pyrofit.doctor.timing import duration
from pyrofit.errors import CostError, DataError, PyrofitError, StudyError
from pyrofit.running.targets import WORKFLOW
from pyrofit.stages.reading import check_measurements


def check_data(situation: Situation) -> Iterator[ReadyLine]:
    """Read every measured file of the study; without one, look for those of the data base."""
    study = situation.study
    if study is None:
        yield _data_base()
        return
    try:
        read = len(check_measurements(study, study.name))
    except (CostError, DataError) as error:
        yield ReadyLine("error", "data", str(error))
        return
    if read == 0:
        yield ReadyLine("ok", "data", "all measurements are synthetic")
        return
    count = len(set(study.needs_macfp))
    sums = f"; checksums of {count} files of the MaCFP data base are right" if count else ""
    yield ReadyLine("ok", "data", f"{read} measured series read{sums}")


def _data_base() -> ReadyLine:
    try:
        folder = store()
    except DataError as error:
        return ReadyLine("error", "data", str(error))
    absent = missing(folder)
    if absent:
        text = (
            f"{len(absent)} of {len(registry())} files of the MaCFP data base are not in {folder}; "
            "studies on them need `make data`, or PYROFIT_DATA_DIR set to a copy"
        )
        return ReadyLine("warning", "data", text)
    return ReadyLine("ok", "data", f"all files of the MaCFP data base are in {folder}")


CHECKS: list[Check] = [
    check_versions,
    cache,
    check_cores,
    memory,
    disk,
    check_data,
    slurm,
    duration,
]
USUAL = Path("profiles/default/config.yaml")
"""The profile that is taken if none is named, of the project or of the package."""


def check_all(
    source: Path | None, results: Path | None, cores: int | None, profile: Path | None
) -> Iterator[ReadyLine]:
    """Yield the findings of all checks.

    Parameters
    ----------
    source
        The study file; None checks the machine alone.
    results
        Folder of results; by default ``results/<name>``.
    cores
        Jobs at once; by default those of the profile.
    profile
        Folder of the Snakemake profile; by default the usual one.

    Raises
    ------
    StudyError
        The profile cannot be read.
    """
    study = None
    if source is not None:
        try:
            study = read_study(source)
            yield ReadyLine("ok", "study", f"'{study.name}' is valid")
        except PyrofitError as error:
            yield ReadyLine("error", "study", str(error))
    keys = _profile(profile)
    at_once = cores or keys.get("jobs") or keys.get("cores") or available_cores()
    if not isinstance(at_once, int):
        at_once = available_cores()
    folder = results or Path("results") / (study.name if study else "")
    situation = Situation(study, folder, at_once, profile=keys)
    for check in CHECKS:
        yield from check(situation)


def _profile(folder: Path | None) -> dict[str, Any]:
    if folder is None:
        return read_mapping(USUAL if USUAL.is_file() else WORKFLOW / USUAL)
    path = folder / "config.yaml"
    if not path.is_file():
        raise StudyError(
            f"{path}: there is no such profile; name its folder: profiles/slurm, which "
            "`pyrofit run STUDY --profile profiles/slurm` writes"
        )
    return read_mapping(path)
