"""Predictions of a finished study against further tests and other people's predictions."""

import os
from collections.abc import Iterable
from pathlib import Path

from pyrofit.api.arguments import path_of, paths_of, word_of
from pyrofit.api.studies import Source, read_study
from pyrofit.results.files import Results
from pyrofit_compare import compute
from pyrofit_compare.compute import ComparedWith

Path_ = str | os.PathLike[str]


def compare_with(
    study: Source,
    tests: Path_,
    *,
    predictions: Iterable[Path_] = (),
    parameter_set: str = "",
    results: Path_ | None = None,
) -> ComparedWith:
    """Predict further tests with a set of a finished study, and score it as MaCFP does.

    The error of a curve is ``rms(mean measured - mean predicted) / (max - min of mean measured)``.

    Parameters
    ----------
    study
        A study, its file, or its keys.
    tests
        YAML file of the tests: ``experiments`` as in a study, under names that it does not have.
    predictions
        Files of others in MaCFP's form, or folders of them.
    parameter_set
        'estimates', a set of the report, 'truth', 'diagnosis', or a JSON file of values; by default
        the answer of the study.
    results
        Folder of the results, by default ``results/<name>``.

    Returns
    -------
    ComparedWith
        ``scores``: a table of test, signal, who, nrms, covered, repeats.

    Raises
    ------
    StudyError
        The tests break a rule, or the study has no such set.
    DataError
        A measured or predicted file breaks a rule, or a simulation does not finish.
    """
    beside = Path(study).parent if isinstance(study, str | os.PathLike) else Path()
    checked = read_study(study)
    own = Path("results") / checked.name
    root = Results(own if results is None else path_of("results", results))
    given, files = path_of("tests", tests), paths_of("predictions", predictions)
    chosen = word_of("parameter_set", parameter_set)
    return compute.compute_comparison(checked, root, given, files, chosen, beside)
