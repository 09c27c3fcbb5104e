"""Steps 2 and 3: the kinetics fit, and the repeated inverse modelling."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from pyrofit.config import Study, digest, kinetics_of
from pyrofit.errors import StudyError, suggest
from pyrofit.estimate.coarse import are_close, for_search
from pyrofit.estimate.history import best_of, convergence
from pyrofit.estimate.least_squares import Start, descend, multistart
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.pose import of_imp, of_kinetics, pose
from pyrofit.estimate.problem import Problem
from pyrofit.results import dependencies, kinetics, searches
from pyrofit.results.files import Results, write_csv
from pyrofit.results.record import write_record
from pyrofit.results.recorded import load
from pyrofit.results.searches import Descent, End, Repetition, Starts
from pyrofit.running.shares import at_once, parts_of_repetitions
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray, Status
from pyrofit.stages.progress import CallsTold, Told, counted
from pyrofit.stages.unfinished import Unfinished, sweep


def _named(problem: Problem, x: FloatArray) -> dict[str, float]:
    return dict(zip(problem.names, x.tolist(), strict=True))


def _end(problem: Problem, start: Start) -> End:
    return End(
        cost=start.cost,
        calls=start.calls,
        at_bound=list(start.at_bound),
        parameters=_named(problem, start.values),
    )


def fit_kinetics(study: Study, results: Results) -> None:
    """Search the kinetics on their cost, by SCE-UA and by starts of least squares.

    The end of the lower cost is kept. The estimates are made from these ends by the step identify.
    """
    stage = kinetics_of(study)
    measurements = load(study, results)
    asked = of_kinetics(study, stage.cost)
    problem = pose(study, asked, measurements, study.fixed_values())
    seed = seed_for(study.seed, "kinetics")
    generations = stage.sceua.generations
    from pyrofit.estimate.sceua import search  # takes 0.2 s to import

    told = Told("kinetics", 1, generations)
    history = search(problem, seed, generations, stage.sceua.complexes, *told.of_each)
    cost, x = best_of(history, problem)
    starts = multistart(problem, stage.least_squares.starts, seed)
    optimiser = "SCE-UA"
    # The squares of several terms have another minimum than their sum: polish that one as well.
    if starts[0].cost < cost:
        optimiser, cost, x = "least squares", starts[0].cost, starts[0].values
    fitted = _named(problem, x)
    write_csv(results.kinetics("history.csv.gz"), history)
    write_csv(results.kinetics("convergence.csv"), convergence(history))
    lowest = kinetics.Searched(cost=best_of(history, problem)[0], calls=len(history))
    found = kinetics.KineticsFit(
        cost=cost,
        parameters=fitted,
        optimiser=optimiser,
        seed=seed,
        sceua=lowest,
        least_squares=[_end(problem, s) for s in starts],
    )
    write_record(results.kinetics("fit.json"), found)


def imp_problem(study: Study, results: Results, cost: str) -> Problem:
    """Return the inverse-modelling problem of one cost function, as optimisers search it."""
    if cost not in study.imp.costs:
        raise StudyError(
            f"study '{study.name}' has no cost '{cost}'. {suggest(cost, study.imp.costs)}"
        )
    asked = of_imp(study, study.imp.costs[cost])
    return pose(study, asked, load(study, results), kinetics.fixed_for_imp(study, results))


def repeat(study: Study, results: Results, cost: str, repetitions: Sequence[int]) -> None:
    """Run repetitions of the inverse modelling; write histories and results.

    Some run side by side, then the next ones: as many as are fastest at once.
    """
    problem = imp_problem(study, results, cost)
    side_by_side = parts_of_repetitions(list(repetitions), at_once(study))
    if len(side_by_side) == 1:
        _search(study, results, problem, cost, side_by_side[0])
        return
    unfinished = Unfinished(study, results, cost)
    for some in side_by_side:
        _search(
            study, unfinished.results, problem, cost, [n for n in some if not unfinished.has(n)]
        )
    unfinished.place(repetitions)


def _search(
    study: Study, results: Results, problem: Problem, cost: str, repetitions: Sequence[int]
) -> None:
    """Run repetitions side by side; write histories and results."""
    seeds = [seed_for(study.seed, cost, repetition) for repetition in repetitions]
    found = _histories(study, problem, cost, repetitions, seeds)
    best = np.array([best_of(history, problem)[1] for history in found])
    costs = [end.cost for end in problem.evaluate_all(best)]
    refined = [end.cost for end in problem.refined().evaluate_all(best)]
    for k, (repetition, history) in enumerate(zip(repetitions, found, strict=True)):
        write_csv(results.repetition(cost, repetition, ".csv.gz"), history)
        write_csv(results.repetition(cost, repetition, "_convergence.csv"), convergence(history))
        end = Repetition(
            cost_function=cost,
            repetition=repetition,
            seed=seeds[k],
            digest=digest(dependencies.imp(study, cost, "sceua")),
            cost=costs[k],
            cost_refined=refined[k],
            parameters=_named(problem, best[k]),
            calls=len(history),
            failed_calls=int((history["status"] != Status.OK).sum()),
            generations=int(history["generation"].max()),
        )
        write_record(results.repetition(cost, repetition, ".json"), end)


def _histories(
    study: Study, problem: Problem, cost: str, repetitions: Sequence[int], seeds: Sequence[int]
) -> list[pd.DataFrame]:
    """Return the histories of searches with coarser runs; with finer ones where these are not good.

    Each repetition decides by itself, so that it has the same bits beside any others.
    """
    budget = study.imp.sceua
    ends = dict.fromkeys(f"{n:02d}" for n in (*repetitions[:1], *repetitions[-1:]))
    told = Told(f"{cost} {' to '.join(ends)}", len(repetitions), budget.generations)
    from pyrofit.estimate.sceua import search_several  # as above

    coarse = for_search(problem)
    found = search_several(coarse, seeds, budget.generations, budget.complexes, told.of_each)
    if coarse is problem:
        return found
    best = np.array([best_of(history, problem)[1] for history in found])
    again = [k for k, close in enumerate(are_close(coarse, problem, best)) if not close]
    chosen = [seeds[k] for k in again]
    finer = search_several(problem, chosen, budget.generations, budget.complexes) if again else []
    for k, history in zip(again, finer, strict=True):
        found[k] = history
    return found


def optimise(study: Study, results: Results, cost: str, optimiser: str) -> None:
    """Run an optimiser from several starts on the same cost; write every end, best first."""
    problem = imp_problem(study, results, cost)
    seed = seed_for(study.seed, cost, optimiser)
    of, settings = OPTIMISERS[optimiser], getattr(study.imp, optimiser)
    told = CallsTold(f"{of.words}, {cost}", of.calls(settings, len(problem.names)))
    starts = of.searched(counted(problem, told), settings, seed)
    ends = [_end(problem, s) for s in starts]
    found = Starts(cost_function=cost, seed=seed, starts=ends)
    write_record(results.starts(cost, optimiser), found)


def descent(study: Study, results: Results, cost: str) -> None:
    """Run least squares from SCE-UA's best set, to see whether that is a local minimum."""
    problem = imp_problem(study, results, cost)
    best = best_set_of_each_cost(study, results)[cost]
    end = descend(problem, np.array([best[name] for name in problem.names]))
    write_record(results.descent(cost), Descent(cost_function=cost, end=_end(problem, end)))


def collect(study: Study, results: Results) -> None:
    """Gather all repetitions: ``imp/summary.csv`` and ``imp/convergence.csv``."""
    rows = []
    running = []
    for cost in study.imp.costs:
        expected = digest(dependencies.imp(study, cost, "sceua"))
        for repetition in range(study.imp.repetitions):
            found = searches.repetition(study, results, cost, repetition)
            if found.digest != expected:
                raise StudyError(
                    f"{results.repetition(cost, repetition, '.json')}: this repetition belongs to "
                    "another description of the study; two runs of it at once? Run it again."
                )
            kept = found.model_dump(exclude={"digest", "parameters"})
            rows.append({**kept, **found.parameters})
            frame = searches.running_minimum(results, cost, repetition)
            running.append(frame.assign(cost_function=cost, repetition=repetition))
    write_csv(results.imp("summary.csv"), pd.DataFrame(rows))
    write_csv(results.imp("convergence.csv"), pd.concat(running, ignore_index=True))
    sweep(results)


def best_set_of_each_cost(study: Study, results: Results) -> dict[str, dict[str, float]]:
    """Return the best parameter set of each cost function, SI units."""
    summary = searches.best_of_repetitions(study, results)
    sets = {}
    for cost in study.imp.costs:
        group = summary[summary["cost_function"] == cost]
        row = group.iloc[int(group["cost"].to_numpy().argmin())]
        sets[cost] = {name: float(row[name]) for name in study.imp.estimate}
    return sets
