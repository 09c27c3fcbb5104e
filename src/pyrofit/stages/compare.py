"""Step 5: all sets of all optimisers under all costs and one metric; predictions of good sets."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis.best_sets import ends
from pyrofit.analysis.good_sets import GOOD, farthest_apart, walk_about
from pyrofit.analysis.uses import FITTED
from pyrofit.config import Study, TermSpec
from pyrofit.errors import CostError
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.pose import of_imp, pose
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements, term_for
from pyrofit.results import searches
from pyrofit.results.files import Results, write_csv
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.recorded import load
from pyrofit.seeds import seed_for
from pyrofit.stages.fit import imp_problem

Judges = dict[str, list[TermSpec]]


def compare(study: Study, results: Results) -> None:
    """Write ``comparison``: every end under every cost, the good sets, and their predictions.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    measurements = load(study, results)
    found = ends(study, searches.read(study, results, OPTIMISERS))
    scores = pd.concat(
        [
            _scores(found, _problem(study, results, measurements, judges), place, judges)
            for place, judges in places(study, measurements).items()
        ],
        ignore_index=True,
    )
    write_csv(results.comparison("scores.csv"), scores)
    family = good(study, results, found, scores)
    write_csv(results.comparison("family.csv"), family)
    write_csv(results.comparison("bands.csv"), _bands(study, results, measurements, family))


def places(study: Study, measurements: Measurements) -> dict[str, Judges]:
    """Return by place the measures that judge the sets, with the terms of each.

    At `FITTED` every cost as it is; at every predicted experiment the common metric of its signals.
    Where no cost was fitted, also every computable cost with this experiment in the place of its
    own, over the whole record.
    """
    found: dict[str, Judges] = {FITTED: {c: list(t) for c, t in study.imp.costs.items()}}
    fitted = {t.experiment for terms in study.imp.costs.values() for t in terms if t.weight}
    for name in study.validation.experiments:
        experiment = study.experiments[name]
        found[name] = {experiment.metric(s): [_metric(study, name, s)] for s in experiment.signals}
        for cost, terms in study.imp.costs.items() if name not in fitted else ():
            there = [t.model_copy(update={"experiment": name, "window_s": None}) for t in terms]
            # Terms that differ in the experiment alone are one and the same there.
            there = [t for i, t in enumerate(there) if t not in there[:i]]
            if all(_computable(study, term, measurements) for term in there):
                found[name][cost] = there
    return found


def _metric(study: Study, name: str, signal: str) -> TermSpec:
    normalisation = "mean" if study.experiments[name].quantity(signal).relative else None
    return TermSpec(experiment=name, signal=signal, kind="RMSE", normalisation=normalisation)


def _computable(study: Study, term: TermSpec, measurements: Measurements) -> bool:
    """Tell whether a term can be computed from the measurements."""
    if (term.experiment, term.signal) not in measurements:
        return False
    try:
        term_for(study, term, measurements)
    except CostError:
        return False
    return True


def _problem(study: Study, results: Results, measurements: Measurements, judges: Judges) -> Problem:
    """Return one problem of all terms, so that a set is simulated once."""
    specs = [term for terms in judges.values() for term in terms]
    return pose(study, of_imp(study, specs), measurements, fixed_for_imp(study, results))


def _scores(found: pd.DataFrame, problem: Problem, place: str, judges: Judges) -> pd.DataFrame:
    """Return the value of every measure for every set; none where the run does not finish."""
    rows: list[dict[str, object]] = []
    results = problem.evaluate_all(found[list(problem.names)].to_numpy(float))
    for row, result in zip(found.to_dict("records"), results, strict=True):
        about = {key: row[key] for key in ("cost_function", "found_by", "number", "best")}
        first = 0
        for measure, terms in judges.items():
            value = float(sum(result.parts[first : first + len(terms)]))
            first += len(terms)
            kept = value if result.status.finished else None
            rows.append({**about, "place": place, "measure": measure, "value": kept})
    return pd.DataFrame(rows)


def good(study: Study, results: Results, found: pd.DataFrame, scores: pd.DataFrame) -> pd.DataFrame:
    """Return the family of good sets of every cost function, the best one first.

    They are looked for about the set of the lowest cost known, whatever it was fitted with.
    Columns: ``cost_function``, ``cost``, ``lowest_by`` and ``lowest_of`` (optimiser and cost
    function of that set), ``met`` (how many good sets were met), parameters in SI units.
    """
    parts = []
    for cost in study.imp.costs:
        problem = imp_problem(study, results, cost)
        here = scores[(scores["place"] == FITTED) & (scores["measure"] == cost)]
        values = here["value"].astype(float).to_numpy()
        lowest = int(np.nanargmin(values))
        best = found.iloc[lowest]
        rng = np.random.default_rng(seed_for(study.seed, cost, "family"))
        start = best[list(problem.names)].to_numpy(float)
        costs, sets = walk_about(problem, start, GOOD * float(values[lowest]), rng)
        chosen = farthest_apart((sets - problem.lower) / (problem.upper - problem.lower))
        about = {
            "cost_function": cost,
            "cost": costs[chosen],
            "lowest_by": best["found_by"],
            "lowest_of": best["cost_function"],
            "met": costs.size,
        }
        parameters = pd.DataFrame(sets[chosen], columns=list(problem.names))
        parts.append(pd.concat([pd.DataFrame(about), parameters], axis="columns"))
    return pd.concat(parts, ignore_index=True)


def _bands(
    study: Study, results: Results, measurements: Measurements, family: pd.DataFrame
) -> pd.DataFrame:
    """Return lowest and highest value that the good sets predict, and that of the best, SI units.

    One row per experiment, signal, cost function and measured time. Sets whose run does not finish
    are left out.
    """
    parts = []
    for name in study.validation.experiments:
        signals = list(study.experiments[name].signals)
        judges = {signal: [_metric(study, name, signal)] for signal in signals}
        problem = _problem(study, results, measurements, judges)
        for cost, group in family.groupby("cost_function", sort=False):
            runs = problem.simulate_all(group[list(problem.names)].to_numpy(float))
            models = [curves for status, curves in runs if status.finished]
            for i, signal in enumerate(signals):
                target = problem.cost.terms[i][1].target
                about = {"experiment": name, "signal": signal, "cost_function": cost}
                parts.append(_band(target.time_s, target.value, [m[i] for m in models], about))
    return pd.concat(parts, ignore_index=True)


def _band(time: Any, measured: Any, curves: list[Any], about: Mapping[str, Any]) -> pd.DataFrame:
    stacked = np.array(curves) if curves else np.full((1, len(time)), np.nan)
    columns = {
        "time_s": time,
        "measured": measured,
        "best": stacked[0],
        "low": stacked.min(axis=0),
        "high": stacked.max(axis=0),
    }
    return pd.DataFrame(columns).assign(**about, sets=len(curves))
