"""Every stored call scored again under any cost: which costs rank the sets alike."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.analysis import rescoring
from pyrofit.config import Study, digest
from pyrofit.errors import DataError
from pyrofit.estimate.measures import measures_of
from pyrofit.logs import Tell
from pyrofit.results import dependencies, searches
from pyrofit.results.files import Results, write_csv
from pyrofit.results.recorded import load
from pyrofit.solver.arrays import Status
from pyrofit.stages.scorer import Scorer, scored_sets, scorer_of
from pyrofit.steps.rescore import record
from pyrofit.steps.rescore.options import RescoreOptions
from pyrofit.steps.rescore.record import Rescored
from pyrofit.steps.rescore.valleys import same_order, valleys


@dataclass(frozen=True, eq=False)
class Stored:
    """The stored calls that were chosen, and how many there are in all.

    Columns of ``sets``: ``set``, ``cost_function``, ``repetition``, ``call``, ``cost``, parameters
    in SI units.
    """

    sets: pd.DataFrame
    finished: int
    failed: int
    histories: int


def run(study: Study, results: Results, tell: Tell, processes: int) -> None:
    """Score stored sets under the study's and other costs; write ``rescore``.

    Raises
    ------
    StudyError
        A cost is unknown.
    CostError
        A cost that is asked for cannot be computed.
    DataError
        A search has not run, or belongs to another description of the study.
    """
    options = study.options(RescoreOptions)
    stored = stored_sets(study, results, None if options.sets == "all" else options.sets)
    measurements = load(study, results)
    measures, left_out = measures_of(study, measurements, options.costs)
    tell(
        f"scoring {len(stored.sets)} of {stored.finished} stored sets of {stored.histories} "
        f"searches under {len(measures)} costs"
    )
    scorer, more = scorer_of(study, results, measurements, measures)
    sets = stored.sets[list(scorer.problem.names)].to_numpy(float)
    names = [measure.name for measure in scorer.measures]
    scores = pd.DataFrame(scored_sets(scorer, sets, processes), columns=names)
    _write(study, results, scorer, stored, scores, [*left_out, *more])


def _write(
    study: Study,
    results: Results,
    scorer: Scorer,
    stored: Stored,
    scores: pd.DataFrame,
    left_out: Sequence[str],
) -> None:
    """Write sets, scores and results derived from them; sets whose run fails are left out."""
    whole = np.isfinite(scores.to_numpy()).all(axis=1)
    if not whole.any():
        raise DataError(f"{results.root}: no stored set can be simulated now; run the study again")
    sets = stored.sets[whole].reset_index(drop=True)
    drift = _drift(study, results, stored.sets, scores)
    scores = scores[whole].reset_index(drop=True)
    tidy = scores.assign(set=sets["set"]).melt(id_vars="set", var_name="cost", value_name="value")
    write_csv(results.of_step("rescore", record.SETS), sets)
    write_csv(results.of_step("rescore", record.SCORES), tidy)
    _write_matrices(results, scores)
    found = Rescored(
        study=study.name,
        stored=stored.finished,
        failed=stored.failed,
        sampled=len(stored.sets),
        histories=stored.histories,
        unfinished=int(np.sum(~whole)),
        drift=drift,
        valley_share=rescoring.VALLEY,
        left_out=list(left_out),
        same=same_order(scores),
        measures=valleys(study, scorer, sets, scores),
    )
    record.write(results, found)


def stored_sets(study: Study, results: Results, count: int | None) -> Stored:
    """Return the chosen calls of all searches; the lowest of every search is among them.

    Raises
    ------
    DataError
        A search has not run, or belongs to another description of the study.
    """
    found, failed = [], 0
    for cost in study.imp.costs:
        expected = digest(dependencies.imp(study, cost, "sceua"))
        for number in range(study.imp.repetitions):
            _check_own(study, results, cost, number, expected)
            history = searches.history(study, results, cost, number)
            finished = history[history["status"] == Status.OK]
            failed += len(history) - len(finished)
            found.append(finished.assign(cost_function=cost, repetition=number))
    sizes = [len(history) for history in found]
    wanted = sizes if count is None else rescoring.shares_of_histories(sizes, count)
    columns = ["cost_function", "repetition", "call", "cost", *study.imp.estimate]
    chosen = [
        history.iloc[np.sort(rescoring.strata(history["cost"].to_numpy(), share))]
        for history, share in zip(found, wanted, strict=True)
        if share
    ]
    if not chosen:
        raise DataError(f"{results.root}: none of the stored calls finished; run the study again")
    sets = pd.concat(chosen, ignore_index=True)[columns]
    sets.insert(0, "set", np.arange(len(sets)))
    return Stored(sets, sum(sizes), failed, len(found))


def _check_own(study: Study, results: Results, cost: str, number: int, expected: str) -> None:
    path = results.repetition(cost, number, ".json")
    if not path.is_file():
        raise DataError(
            f"{path}: this search has not run; its calls are to be scored. Run the study first: "
            "snakemake --cores 2 --configfile <the study>"
        )
    if searches.repetition(study, results, cost, number).digest != expected:
        raise DataError(
            f"{path}: this search belongs to another description of study '{study.name}': costs, "
            "experiments, material, parameters, budget or the program's quantities were changed "
            "since. Run the study again, or name the study file that it ran with"
        )


def _drift(study: Study, results: Results, sets: pd.DataFrame, scores: pd.DataFrame) -> float:
    """Return the largest relative difference between stored and recomputed costs.

    Compared are the best sets of the searches: the runs of a history may be coarser than those
    that the study asks for, see `estimate.coarse`.
    """
    largest = 0.0
    for cost, number in itertools.product(study.imp.costs, range(study.imp.repetitions)):
        own = (sets["cost_function"] == cost) & (sets["repetition"] == number)
        if cost in scores and own.any():
            best = int(sets["cost"].where(own).to_numpy(float).argsort(kind="stable")[0])
            stored = searches.repetition(study, results, cost, number).cost
            apart = abs(float(scores[cost].to_numpy()[best]) - stored) / max(abs(stored), 1e-300)
            largest = max(largest, 0.0 if np.isnan(apart) else apart)
    return largest


def _write_matrices(results: Results, scores: pd.DataFrame) -> None:
    telling = scores[rescoring.telling(scores)]
    tables = {
        record.EXCESS: rescoring.excess(scores),
        record.BETTER: rescoring.better(scores),
        record.CORRELATION: rescoring.spearman(telling),
        record.AMONG_BEST: rescoring.spearman_among_best(telling),
    }
    for name, table in tables.items():
        write_csv(results.of_step("rescore", name), table.rename_axis("cost").reset_index())
