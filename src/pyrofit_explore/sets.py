"""Parameter sets to start from and to compare: of the study, of its results, of files."""

import math
from collections.abc import Iterator
from pathlib import Path

from pyrofit.analysis.best_sets import published_sets
from pyrofit.analysis.uses import ESTIMATES
from pyrofit.api.choices import in_units
from pyrofit.config import Study
from pyrofit.constants import GAS_CONSTANT
from pyrofit.errors import PyrofitError
from pyrofit.model.material import Reaction
from pyrofit.results.files import Results
from pyrofit.stages.predict import sets_of
from pyrofit_exchange.sets import DIAGNOSIS, TRUTH, named_set

Named = dict[str, dict[str, float]]
"""Values by parameter in the units of the study, by the name of their set."""


def named_sets(study: Study, results: Results, given: str, beside: Path) -> tuple[Named, list[str]]:
    """Return the sets of a study, and why others are left out.

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
    kinetics = _kinetics(study)
    used = kinetics.get(study.imp.kinetics, {})
    own = {f"{name}, kinetics": values for name, values in kinetics.items()}
    for cost, best in published_sets(study).items():
        own[f"{cost} published"] = {**used, **in_units(study, best)}
    found: Named = {}
    remarks = []
    if given:
        found[given] = own.get(given) or _values(study, results, given, beside)
    for label in _labels(study, results):
        try:
            found.setdefault(label, {**used, **_values(study, results, label, beside)})
        except PyrofitError as error:
            remarks.append(str(error))
    return {**found, **own}, remarks


def _kinetics(study: Study) -> Named:
    sets = study.kinetics.sets if study.kinetics else ()
    return {name: in_units(study, published_values(study, name)) for name in sets}


def published_values(study: Study, name: str) -> dict[str, float]:
    """Return published kinetics as values of the parameters that describe the reactions.

    Parameters
    ----------
    study, name
        The study, and a name in its ``kinetics.sets``.

    Returns
    -------
    dict
        SI values; numbers that no parameter stands for are left out.

    Examples
    --------
    >>> import pyrofit as pf
    >>> round(published_values(pf.read_study("config/paper.yaml"), "Table 3")["T_B"], 1)
    597.0
    """
    assert study.kinetics is not None
    chosen = study.kinetics.sets[name]
    places: list[tuple[object, object]] = []
    for of, published in chosen.reactions.items():
        described = study.material.reactions[of]
        A, E = published.A_1_s, published.E_J_mol
        T = reference_temperature(described, A, E)
        places += [(described.reference_temperature_K, T), (described.A_1_s, A)]
        places.append((described.E_J_mol, E))
        places.append((described.order, published.order))
    places += [(study.material.composition[of], share) for of, share in chosen.composition.items()]
    return {
        place: value
        for place, value in places
        if isinstance(place, str) and place in study.parameters and isinstance(value, float)
    }


def reference_temperature(described: Reaction, A: float, E: float) -> float | None:
    """Return the temperature at which published kinetics have the reference rate k of a reaction.

    T = E / (R ln(A / k)) [K], with A [1/s] and E [J/mol]; None where k is no number, or above A.
    """
    rate = described.reference_rate_1_s
    if not (isinstance(rate, float) and A > rate > 0.0):
        return None
    return E / (GAS_CONSTANT * math.log(A / rate))


def _values(study: Study, results: Results, label: str, beside: Path) -> dict[str, float]:
    values = named_set(study, results, label, beside).values
    return in_units(study, {n: v for n, v in values.items() if n in study.parameters})


def _labels(study: Study, results: Results) -> Iterator[str]:
    if study.synthetic is not None:
        yield TRUTH
    if results.identification("estimate.csv").exists():
        try:
            yield from dict.fromkeys([ESTIMATES, *sets_of(study, results)])
        except PyrofitError:  # the run has not come to its end
            yield ESTIMATES
    if results.diagnosis("diagnosis.json").exists():
        yield DIAGNOSIS
