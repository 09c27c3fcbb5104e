"""Numbers of an apparatus, fitted to its runs on inert bodies before anything is compared."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pyrofit.api.fitted import Fit
from pyrofit.api.fitting import fit
from pyrofit.config import Study
from pyrofit.errors import PyrofitError, StudyError


@dataclass(frozen=True, eq=False)
class Apparatus:
    """Values of the apparatus by parameter, SI units, and their fit; none without inert runs."""

    values: Mapping[str, float]
    fit: Fit | None = None


def fit_apparatus(
    path: Path, study: Study, runs: Sequence[str], names: Sequence[str], values: Mapping[str, float]
) -> Apparatus:
    """Fit numbers of an apparatus to runs on inert bodies, by maximum likelihood as `pf.fit` does.

    Parameters
    ----------
    path
        File of the tests, for messages.
    study
        The study with the inert runs among its experiments.
    runs, names
        Names of the inert runs, and of the parameters.
    values
        Values of all other parameters, SI units.

    Raises
    ------
    StudyError
        There are parameters without runs or runs without parameters, or the fit breaks a rule.
    """
    if not runs and not names:
        return Apparatus({})
    if not runs:
        raise StudyError(
            f"{path}: `parameters` are fitted to runs on inert bodies, and `inert` lists none; add "
            "these runs, or write numbers in place of the parameters"
        )
    if not names:
        raise StudyError(
            f"{path}: `inert` lists runs, and `parameters` names no number to fit to them; name "
            "those of the apparatus there, with unit and limits"
        )
    fixed = {n: values[n] / p.factor for n, p in study.parameters.items() if n in values}
    try:
        found = fit(study, signals=list(runs), estimate=list(names), fixed=fixed)
    except PyrofitError as error:
        raise StudyError(f"{path}: inert runs: {error}") from None
    return Apparatus({n: found.values[n] * study.parameters[n].factor for n in names}, found)
