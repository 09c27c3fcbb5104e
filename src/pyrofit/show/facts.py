"""Facts for the sentences of a report, read and computed once."""

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from pyrofit.analysis.answer import OutsideAnswer, outside_intervals
from pyrofit.analysis.assumptions import assumptions
from pyrofit.analysis.best_sets import best_sets
from pyrofit.analysis.distances import Distance, distances
from pyrofit.analysis.estimates import Estimated, estimates_of
from pyrofit.analysis.known_values import KnownBesideEstimate, known_values
from pyrofit.analysis.repetitions import OverRepetitions, repeated
from pyrofit.analysis.scores import Score, scores_of_sets
from pyrofit.analysis.trade_offs import TradeOff, trade_offs
from pyrofit.analysis.uses import predicted_labels
from pyrofit.analysis.wall_times import wall_times
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import identification, isoconversional, prediction, searches
from pyrofit.results.files import Results
from pyrofit.results.goodness import Goodness
from pyrofit.results.step import exists
from pyrofit.show.table import Frames
from pyrofit.show.water import lacking_water
from pyrofit.steps.posterior import record as posterior
from pyrofit.steps.preview import record as preview
from pyrofit.steps.sensitivity import record as sensitivity


@dataclass(frozen=True)
class Facts:
    """The facts of a study, from its written tables and its results.

    Parameters
    ----------
    tables
        All tables that the study has, by name, as they were written.
    estimates, known
        The estimates of all stages, and those that have a known value.
    trade_offs
        Pairs of strongly correlated estimates.
    goodness
        Whether the models describe their tests, by stage.
    chi2_per_point
        Chi-square per degree of freedom of the estimates, by stage.
    outside
        The best set of each cost function, with its values outside the intervals.
    assumptions
        Surroundings that the study takes as given, with their tests.
    influence
        Largest part of each in the variance of a signal; none where that was not analysed.
    distances
        How far the optimisers' sets are from the optimum of the likelihood.
    repeated
        Results of the repetitions of SCE-UA.
    scores
        How well all sets predict; none without validation.
    times
        Wall times of the searches by optimiser [s], as far as they were measured.
    isoconversional
        What the activation energies over conversion show, in sentences.
    offers
        Which reactions would describe the masses better, in sentences.
    suspect
        The likeliest cause of records that no set within the limits reaches, in words, or nothing.
    water
        Where temperatures show water of which the model has none, in a sentence, or nothing.
    ensemble
        Number of sets drawn from the posterior; 0 where it was not sampled, or did not converge.
    """

    tables: Frames
    estimates: list[Estimated]
    known: list[KnownBesideEstimate]
    trade_offs: list[TradeOff]
    goodness: Mapping[str, Goodness]
    chi2_per_point: Mapping[str, float]
    outside: list[OutsideAnswer]
    assumptions: Mapping[str, list[str]]
    influence: Mapping[str, float] | None
    distances: list[Distance]
    repeated: list[OverRepetitions]
    scores: list[Score]
    times: Mapping[str, list[float]]
    isoconversional: list[str]
    offers: list[str]
    suspect: str
    water: str
    ensemble: int


def facts_of(study: Study, results: Results, tables: Frames) -> Facts:
    """Return the facts of a study: its results are read first, then analysed.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    identified = identification.read(study, results)
    searched = searches.read(study, results, OPTIMISERS)
    predicted = pd.DataFrame()
    if study.validation.experiments:
        predicted = prediction.read_scores(study, results, predicted_labels(study))
    estimates = estimates_of(study, identified)
    return Facts(
        tables=tables,
        estimates=estimates,
        known=known_values(study, estimates),
        trade_offs=trade_offs(study, identified),
        goodness=identified.goodness,
        chi2_per_point={s: n.chi2 / n.freedom for s, n in identified.noise.items()},
        outside=outside_intervals(study, estimates, best_sets(study, searched)),
        assumptions=assumptions(study),
        influence=_influence(study, results),
        distances=distances(study, identified),
        repeated=repeated(study, searched.repetitions),
        scores=scores_of_sets(study, predicted),
        times=wall_times(study, results),
        isoconversional=isoconversional.read_findings(results),
        offers=isoconversional.offers(results),
        suspect=_suspect(study, results, identified.goodness),
        water=_water(study, results),
        ensemble=_ensemble(study, results),
    )


def _suspect(study: Study, results: Results, goodness: Mapping[str, Goodness]) -> str:
    """Return the likeliest cause, but none at records that a fit describes as they are."""
    causes = preview.read(results).causes if exists(study, results, "preview") else []
    met = {s.experiment for found in goodness.values() if found.describes for s in found.signals}
    return next((cause.words for cause in causes if not met.issuperset(cause.places)), "")


def _water(study: Study, results: Results) -> str:
    return lacking_water(preview.read(results)) if exists(study, results, "preview") else ""


def _influence(study: Study, results: Results) -> dict[str, float] | None:
    """Return the largest part of each kind of surroundings in the variance of a signal."""
    if not exists(study, results, "sensitivity"):
        return None
    found = sensitivity.read(study, results)
    parts: dict[str, float] = {}
    for one in found.inputs:
        if one.kind == "apparatus":
            most = max(signal.total[one.name] for signal in found.signals)
            parts[one.label] = max(most, parts.get(one.label, 0.0))
    return parts


def _ensemble(study: Study, results: Results) -> int:
    if not exists(study, results, "posterior"):
        return 0
    found = posterior.read(study, results)
    return found.sets if found.converged else 0
