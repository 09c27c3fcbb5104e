"""Which effect the model lacks: the diagnosis of a study, and the extended study."""

import hashlib
import shutil

import numpy as np
import pandas as pd

from pyrofit.config import Study, digest
from pyrofit.config.expand.programs import externals
from pyrofit.config.resolve import diagnosed
from pyrofit.diagnose.base.journal import Journal
from pyrofit.diagnose.diagnosis import examine
from pyrofit.diagnose.result.extended_study import extended_keys
from pyrofit.errors import StudyError
from pyrofit.estimate.targets import Measurements
from pyrofit.experiments.external.simulate import OWN_MODEL
from pyrofit.logs import Tell
from pyrofit.provenance import source_fingerprint
from pyrofit.results import dependencies, diagnosis
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results, write_csv
from pyrofit.results.recorded import load
from pyrofit.stages.own_files import files_seen_from, write_study_keys

EXTENDED = "extended.yaml"
UNFINISHED = "unfinished"
"""Folder of the fits of a diagnosis that has not ended."""
_COMMENT = """\
The study that was diagnosed, with the effects that were found at their fitted strengths. It runs:
snakemake --cores 2 --configfile <this file>. Leave a strength out to have it estimated: add the
parameter <effect>_<strength> to imp.estimate then.
"""


def diagnose_study(study: Study, results: Results, tell: Tell, processes: int = 1) -> Diagnosis:
    """Diagnose a study from its measurements; write ``diagnosis``, return its record.

    Raises
    ------
    DataError
        A measurement is missing, a channel is too short, or no run within the limits finishes.
    StudyError
        An external program simulates one of its experiments.
    """
    refuse_programs(study)
    measurements = load(study, results)
    journal = Journal(results.diagnosis(UNFINISHED) / _key(study, measurements))
    if len(journal):
        tell(f"goes on where it was broken off: {len(journal)} fits are kept")
    found = examine(study, measurements, tell, processes, journal=journal)
    effects = found.end.effects
    path = results.diagnosis(EXTENDED)
    path.unlink(missing_ok=True)  # that of an earlier diagnosis
    if effects:
        signals = dict(files_seen_from(study, results, path.parent))
        keys = extended_keys(study, found.end, signals)
        write_study_keys(study, keys, path, _COMMENT)
    content = found.content.model_copy(update={"extended_study": EXTENDED if effects else ""})
    write_csv(results.diagnosis("curves.csv"), found.curves)
    diagnosis.write(results, content)
    shutil.rmtree(journal.folder.parent, ignore_errors=True)
    return content


def _key(study: Study, measurements: Measurements) -> str:
    """Return a digest of all that the fits of a diagnosis are made of."""
    content = {
        "study": dependencies.diagnose_slice(study),
        "source": source_fingerprint("pyrofit.stages.diagnose"),
        "series": {" ".join(key): _digest_of(measurements[key]) for key in sorted(measurements)},
    }
    return digest(content)


def _digest_of(frame: pd.DataFrame) -> str:
    values = np.ascontiguousarray(frame.to_numpy(float))
    return hashlib.sha256(",".join(frame.columns).encode() + values.tobytes()).hexdigest()


def refuse_programs(study: Study) -> None:
    """Refuse a study of which an external program simulates an experiment.

    Raises
    ------
    StudyError
        With the experiment.
    """
    outside = set(diagnosed(study)) & set(externals(study))
    if outside:
        raise StudyError(f"experiments.{min(outside)}: {OWN_MODEL}")
