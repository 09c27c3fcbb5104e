"""Run a plan: compute each twin, diagnose it, and keep the verdict beside the truth."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from pyrofit.config import Study, digest
from pyrofit.effects import known_effects, same_as
from pyrofit.errors import DataError, StudyError
from pyrofit.estimate.targets import Measurements
from pyrofit.plugins import code_digest
from pyrofit.provenance import source_fingerprint
from pyrofit.results.diagnosis_schema import Diagnosis, OfScreen
from pyrofit.results.files import read_json, write_json
from pyrofit_blind_test.detectability import detectability, located
from pyrofit_blind_test.places import Places
from pyrofit_blind_test.plan import TwinPlan, cases_of, chunk_of
from pyrofit_blind_test.setting import Setting, files_digest
from pyrofit_blind_test.twin import make_twin, read_twin, without_effects, write_twin

Diagnose = Callable[[Study, Measurements], Diagnosis]
"""The diagnosis under test: study and measurements in, verdict and its evidence out."""
KEPT = {"verdict", "base", "screen", "candidates", "extended", "gap"}
"""Parts of a diagnosis that are kept."""


def run_chunk(setting: Setting, plan: str, chunk: int, places: Places, diagnose: Diagnose) -> None:
    """Diagnose the twins of one job, except those already diagnosed by the same source.

    Raises
    ------
    StudyError
        There is no such plan or job, or a truth breaks a rule.
    DataError
        A twin cannot be computed, or a file cannot be written.
    """
    chunks = setting.plan(plan).chunks
    if not 0 <= chunk < chunks:
        raise StudyError(f"plan '{plan}' has the jobs 0 to {chunks - 1}; there is no job {chunk}")
    cases = chunk_of(cases_of(setting, plan), chunk, chunks)
    for case in cases:
        made_of = case_digest(setting, case)
        if not _is_done(places, case, made_of):
            content = {
                "id": case.id,
                "digest": made_of,
                **run_case(setting, case, places, diagnose),
            }
            write_json(places.case(case.id), content)
    write_json(places.chunk(chunk), {"cases": [case.id for case in cases]})


def code_fingerprint() -> str:
    """Return a hash of the source that cases are computed by, all effects included."""
    effects = {name: code_digest("effects", name) for name in known_effects()}
    return digest([source_fingerprint(__name__, "pyrofit.diagnose.diagnosis"), effects])


def case_digest(setting: Setting, case: TwinPlan) -> str:
    """Return a digest of everything that the result of a case depends on."""
    of_twins = setting.model_dump(exclude={"plans", "seeds", "nominal", "forms", "pairs"})
    return digest([case.model_dump(), of_twins, files_digest(setting), code_fingerprint()])


def run_case(
    setting: Setting, case: TwinPlan, places: Places, diagnose: Diagnose
) -> dict[str, Any]:
    """Compute and diagnose one twin; return verdict and truth.

    The diagnosis reads only the files of the twin's study and measurements.
    """
    seconds: dict[str, float] = {}
    with _timed(seconds, "twin"):
        twin = make_twin(setting, case)
        write_twin(places, twin)
    study, measurements = read_twin(places, case.id)
    known = {name: prior.sd for name, prior in study.known.items()}
    with _timed(seconds, "diagnosis"):
        found = diagnose(study, measurements)
    base = {name: one.value for name, one in found.base.parameters.items()}
    with _timed(seconds, "detectability"):
        misfit = detectability(twin.truth, twin.series, known, base)
    assert twin.truth.synthetic is not None
    result: dict[str, Any] = {"case": case.model_dump(mode="json")}
    result |= {"truth": twin.truth.synthetic.truth}
    result |= {"detectability": misfit.size, "location": located(found.windows, misfit)}
    result |= found.model_dump(include=KEPT) | {"score_only": largest_score(found.screen)}
    result["left_out"] = None
    if case.left_out:
        hidden = set().union(*(same_as(name) for name in removed(case)))
        with _timed(seconds, "left_out"):
            result["left_out"] = diagnose(
                without_effects(study, hidden), measurements
            ).verdict.model_dump()
    return result | {"seconds": seconds}


def removed(case: TwinPlan) -> tuple[str, ...]:
    """Return the hidden effects that a second diagnosis does not consider: of a pair, the second.

    The first of a pair then has an effect beside it that is in no catalogue.
    """
    return tuple(case.hidden)[-1:]


def largest_score(screen: Sequence[OfScreen]) -> str:
    """Return the effect with the largest score, a reference that needs no fit."""
    scores = {entry.effect: abs(entry.z) for entry in screen}
    return max(scores, key=lambda name: scores[name], default="")


def _is_done(places: Places, case: TwinPlan, made_of: str) -> bool:
    try:
        return bool(read_json(places.case(case.id), {("digest",): str})["digest"] == made_of)
    except DataError:
        return False


@contextmanager
def _timed(seconds: dict[str, float], name: str) -> Iterator[None]:
    # CPU time: other programs on the machine do not count.
    start = time.process_time()
    yield
    seconds[name] = round(time.process_time() - start, 3)
