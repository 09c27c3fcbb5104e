"""Parameter sets to start from and to compare: of the study, of its results, of files."""

from collections.abc import Iterator
from pathlib import Path

from pyrofit.analysis.best_sets import published_sets
from pyrofit.analysis.uses import ESTIMATES
from pyrofit.api.choices import in_units
from pyrofit.config import Study
from pyrofit.errors import PyrofitError
from pyrofit.exchange.sets import DIAGNOSIS, TRUTH, parameter_set
from pyrofit.results.files import Results
from pyrofit.stages.predict import sets_of

Named = dict[str, dict[str, float]]
"""Values by parameter in the units of the study, by the name of their set."""


def named_sets(study: Study, results: Results, given: str, beside: Path) -> tuple[Named, list[str]]:
    """Return the sets of a study that have all values, and why others are left out.

    Parameters
    ----------
    study, results
        The study and the folder of its results, which may be empty.
    given
        A further set as `--set` names it, such as a JSON file of SI values; may be empty.
    beside
        Folder of the study file.

    Raises
    ------
    StudyError
        The given set is missing or broken.
    """
    found: Named = {}
    remarks = []
    if given:
        found[given] = _values(study, results, given, beside)
    for label in _labels(study, results):
        try:
            found.setdefault(label, _values(study, results, label, beside))
        except PyrofitError as error:
            remarks.append(str(error))
    return found, remarks


def _values(study: Study, results: Results, label: str, beside: Path) -> dict[str, float]:
    values = parameter_set(study, results, label, beside).values
    return in_units(study, {n: v for n, v in values.items() if n in study.parameters})


def _labels(study: Study, results: Results) -> Iterator[str]:
    if study.synthetic is not None:
        yield TRUTH
    if results.identification("estimate.csv").exists():
        try:
            yield from dict.fromkeys([ESTIMATES, *sets_of(study, results)])
        except PyrofitError:  # the run has not come to its end
            yield ESTIMATES
        yield from (f"{cost} published" for cost in published_sets(study))
    if results.diagnosis("diagnosis.json").exists():
        yield DIAGNOSIS
