"""Result of the diagnosis: written and read as `diagnosis_schema` describes it."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results, read_csv
from pyrofit.results.needed import AGAIN
from pyrofit.results.record import read_record, write_record


def write(results: Results, found: Diagnosis) -> None:
    """Write the results."""
    write_record(results.diagnosis("diagnosis.json"), found)


def read(study: Study, results: Results) -> Diagnosis:
    """Return the result of the diagnosis.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    path = results.diagnosis("diagnosis.json")
    found = read_record(path, Diagnosis)
    verdict = found.verdict
    if verdict.kind in ("named", "ambiguous", "multiple", "partly") and not verdict.sets:
        raise DataError(f"{path}: 'verdict.sets' is empty; {AGAIN}")
    here = {(n.experiment, n.signal) for n in found.noise}
    here |= {(w.experiment, w.signal) for w in found.windows}
    there = {(name, s) for name, e in study.experiments.items() for s in e.signals}
    if found.study != study.name or not here <= there:
        raise DataError(f"{path}: this is the diagnosis of another study; {AGAIN}")
    return found


def read_curves(study: Study, results: Results) -> pd.DataFrame:
    """Return measured curves, those of the base and those with the named effects, SI units."""
    channels = [(c.experiment, c.signal) for c in read(study, results).noise]
    numbers = ("time_s", "measured", "sd", "before")
    return read_csv(
        results.diagnosis("curves.csv"),
        {**dict.fromkeys(numbers, float), **dict.fromkeys(("temperature_K", "after"), object)},
        {("experiment", "signal"): channels},
    )
