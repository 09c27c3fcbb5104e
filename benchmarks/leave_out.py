"""The diagnosis of a study without one of its candidate effects, for each of them in turn.

    pyrofit prepare --study config/pmma.yaml
    python benchmarks/leave_out.py config/pmma.yaml OUT.csv [EFFECT ...]

A verdict that hangs on an effect outside the final model hangs on how complete the catalogue is.
Descents that several diagnoses share are made once. Effects in OUT.csv are not repeated.
"""

import csv
import sys
from pathlib import Path
from tempfile import gettempdir

from pyrofit.config import Study, candidate_effects
from pyrofit.config.read import read_study
from pyrofit.diagnose.base.journal import Journal
from pyrofit.diagnose.diagnosis import examine
from pyrofit.estimate.targets import Measurements
from pyrofit.provenance import source_fingerprint
from pyrofit.results.files import Results
from pyrofit.results.recorded import load

COLUMNS = ("left_out", "verdict", "named", "final_model", "strengths", "chi2", "reasons")


def without(study: Study, effect: str) -> Study:
    """Return a study whose diagnosis does not consider an effect."""
    left = tuple(name for name in candidate_effects(study) if name != effect)
    options = study.diagnosis.model_copy(update={"effects": left})
    return study.model_copy(update={"diagnosis": options})


def row(study: Study, measurements: Measurements, effect: str, journal: Journal) -> list[str]:
    """Diagnose a study without an effect, and tell what it finds."""
    tried = without(study, effect) if effect else study
    found = examine(tried, measurements, advise=False, journal=journal)
    verdict, end = found.content.verdict, found.end
    named = [effect for one in verdict.sets for effect in one] if verdict.confirmed else []
    strengths = [f"{end.strength(name):.4g}" for name in end.effects]
    said = [effect or "none", verdict.kind, *map(" ".join, (named, end.effects, strengths))]
    return [*said, f"{end.fit.chi2:.1f}", "; ".join(verdict.reasons)]


def main(path: str, out: str, *effects: str) -> None:
    """Write a row for the whole catalogue, and one for each effect left out."""
    study = read_study(Path(path))
    measurements = load(study, Results(Path("results") / study.name))
    kept = f"pyrofit-leave-out-{study.name}-{source_fingerprint('pyrofit.stages.diagnose')}"
    journal = Journal(Path(gettempdir()) / kept)
    file = Path(out)
    if not file.exists():
        file.write_text(",".join(COLUMNS) + "\n")
    done = {line["left_out"] for line in csv.DictReader(file.read_text().splitlines())}
    for effect in ("", *(effects or candidate_effects(study))):
        if (effect or "none") in done:
            continue
        found = row(study, measurements, effect, journal)
        with file.open("a", newline="") as handle:
            csv.writer(handle, lineterminator="\n").writerow(found)
        print(*found[:5], sep=" | ", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
