"""The work of single runs is bounded by that of the fitted base model."""

from dataclasses import replace

import numpy as np
from small import base_of, study, truth_of

from pyrofit.diagnose.base.descent import descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import model_of
from pyrofit.diagnose.base.work import within_work
from pyrofit.diagnose.settings import Settings


def fitted() -> FittedModel:
    base = base_of(study())
    model = model_of(base, {})
    return FittedModel(model, descend_chi_square(model, truth_of(base, {}), enough=1e9))


def test_run_with_more_steps_than_the_bound_does_not_finish() -> None:
    trial = fitted()
    bounded = within_work(trial)
    accuracy = bounded.model.likelihood.problem.accuracy
    problem = trial.model.likelihood.problem
    x = trial.model.likelihood.values(trial.fit.x)
    steps = max(curves[0].steps for curves in problem.simulated(problem.values(x), 1).values())
    assert accuracy.most_steps == Settings().most_work * steps
    assert np.array_equal(bounded.model.residuals(trial.fit.x), trial.fit.residuals)
    few = replace(problem, accuracy=accuracy.model_copy(update={"most_steps": 100}))
    assert not few.simulate(x)[0].finished


def test_bound_never_exceeds_that_of_the_study() -> None:
    trial = fitted()
    mine = trial.model.likelihood.problem.accuracy
    accuracy = within_work(trial).model.likelihood.problem.accuracy
    assert accuracy.most_steps <= mine.most_steps
    assert accuracy.most_cells <= mine.most_cells
