"""A bound on the cells and time steps of single runs."""

from dataclasses import replace

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import model_of
from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray


def within_work(trial: FittedModel) -> FittedModel:
    """Return the fit with a base that bounds the work of all runs by that of the fitted one.

    Far from it, a reaction zone may be so thin that a run takes a thousand times as long.
    """
    base = trial.model.base
    likelihood = base.likelihood
    problem = bounded(likelihood.problem, likelihood.values(trial.fit.x), base.settings.most_work)
    base = replace(base, likelihood=replace(likelihood, problem=problem))
    return replace(trial, model=model_of(base, trial.model.effects, trial.model.channels))


def bounded(problem: Problem, x: FloatArray, most: int) -> Problem:
    """Return a problem whose runs get at most ``most`` times the cells and steps of that at x [SI].

    A run that needs more cells gets fewer; one that needs more steps does not finish.
    """
    simulated = problem.simulated(problem.values(x), 1)
    cells = most * max(curves[0].cells for curves in simulated.values())
    steps = most * max(curves[0].steps for curves in simulated.values())
    accuracy = problem.accuracy
    least = {
        "most_cells": min(max(cells, 50), accuracy.most_cells),
        "most_steps": min(max(steps, 100), accuracy.most_steps),
    }
    return replace(problem, accuracy=accuracy.model_copy(update=least))
