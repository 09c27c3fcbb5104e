"""Check of the measured files, and of their checksums."""

from collections.abc import Iterator

from pyrofit.data.fetch import missing, registry, store
from pyrofit.doctor.finding import ReadyLine, Situation
from pyrofit.errors import CostError, DataError
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
