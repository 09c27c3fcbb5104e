"""Which effect the model lacks: the diagnosis of a study, and the extended study."""

from pyrofit.config import Study, as_yaml
from pyrofit.config.programs import externals
from pyrofit.config.resolve import diagnosed
from pyrofit.diagnose.diagnosis import examine
from pyrofit.diagnose.result.extended_study import extended_keys
from pyrofit.errors import StudyError
from pyrofit.experiments.external.simulate import OWN_MODEL
from pyrofit.logs import Tell
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results, write_csv, write_text
from pyrofit.results.recorded import load
from pyrofit.stages.own_files import files_seen_from, seen_from

EXTENDED = "extended.yaml"
_COMMENT = """\
The study that was diagnosed, with the effects that were found at their fitted strengths. It runs:
snakemake --cores 2 --configfile <this file>. Leave a strength out to have it estimated: add the
parameter <effect>_<strength> to imp.estimate then.
"""


def diagnose(study: Study, results: Results, tell: Tell, processes: int = 1) -> Diagnosis:
    """Diagnose a study from its measurements; write ``diagnosis``, return its record.

    Raises
    ------
    DataError
        A measurement is missing, a channel is too short, or no run within the limits finishes.
    StudyError
        An external program simulates one of its experiments.
    """
    refuse_programs(study)
    found = examine(study, load(study, results), tell, processes)
    effects = found.end.effects
    path = results.diagnosis(EXTENDED)
    path.unlink(missing_ok=True)  # that of an earlier diagnosis
    if effects:
        signals = dict(files_seen_from(study, results, path.parent))
        keys = extended_keys(study, found.end, signals)
        if study.plugins:
            keys["plugins"] = [seen_from(path.parent, folder) for folder in study.plugins]
        write_text(path, as_yaml(keys, _COMMENT))
    content = found.content.model_copy(update={"extended_study": EXTENDED if effects else ""})
    write_csv(results.diagnosis("curves.csv"), found.curves)
    diagnosis.write(results, content)
    return content


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
