"""Which reaction scheme the thermogravimetric records support, and the study with it."""

from pathlib import Path

from pyrofit.config import Study
from pyrofit.logs import Tell
from pyrofit.results import recorded
from pyrofit.results.files import Results, write_csv
from pyrofit.scheme.choice import Choice, choose_scheme
from pyrofit.scheme.extended import scheme_keys
from pyrofit.scheme.fit import SchemeSetting
from pyrofit.scheme.masses import masses_of
from pyrofit.scheme.records import records_of
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.stages.own_files import files_seen_from, write_study_keys
from pyrofit.steps.scheme import record
from pyrofit.steps.scheme.found import curves_of, scheme_found

_COMMENT = """\
The study with the reaction scheme that its thermogravimetric records support, at the fitted values.
It runs: snakemake --cores 2 --configfile <this file>. Inverse modelling and diagnosis take the
kinetics as they stand here; add their parameters to diagnosis.estimate to estimate them again.
"""


def run(study: Study, results: Results, tell: Tell, processes: int) -> Choice:
    """Choose the reaction scheme of a study; write ``scheme``, return the choice.

    Raises
    ------
    StudyError
        The study has no records of mass at two heating rates or more, or no reaction.
    DataError
        A measurement is missing, or no scheme can be simulated within its limits.
    """
    settings = SchemeSettings()
    masses = masses_of(study)
    measurements = {
        (name, signal): recorded.series(study, results, name, signal)
        for name, signal in (*masses.fitted, *masses.predicted)
    }
    records = tuple(records_of(study, measurements, settings.points))
    found = choose_scheme(SchemeSetting(study, measurements, records, settings), tell)
    extended = results.of_step("scheme", record.EXTENDED)
    write(study, results, found, extended)
    write_csv(results.of_step("scheme", record.CURVES), curves_of(found))
    record.write(results, scheme_found(found, settings))
    tell(f"{extended}: the study with the chosen scheme")
    return found


def write(study: Study, results: Results, found: Choice, path: Path) -> None:
    """Write the study with the chosen scheme; it names the files of the study from there."""
    signals = dict(files_seen_from(study, results, path.parent))
    write_study_keys(study, scheme_keys(study, found.chosen.fitted, signals), path, _COMMENT)
