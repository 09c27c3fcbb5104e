"""Signals and costs of sampled sets: every set is simulated once."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.stages.scorer import Scorer
from pyrofit.steps.sensitivity.varied import Input, columns


@dataclass(frozen=True, eq=False)
class Sampler:
    """Signals and costs of sets: every set is simulated once.

    Parameters
    ----------
    scorer
        Its first measure are the signals.
    inputs
        The varied inputs.
    at
        Positions of the times that count, of each signal.
    """

    scorer: Scorer
    inputs: Sequence[Input]
    at: Sequence[FloatArray]

    def outputs(self, points: FloatArray) -> FloatArray:
        """Return signals, then costs, at points of the unit cube; no numbers of failed runs."""
        problem = self.scorer.problem
        varied = columns(self.inputs, points)
        values: Values = {**problem.fixed, **varied}
        sets = np.column_stack([varied[name] for name in problem.names])
        rows = []
        for own, outcome in zip(sets, problem.outcomes(values, len(points)), strict=True):
            status, models = outcome
            curves = [m[i] for m, i in zip(models, self.at, strict=False)]
            if not status.finished:
                curves = [np.full(len(i), np.nan) for i in self.at]
            rows.append(np.concatenate([*curves, self.scorer.of(own, outcome)[1:]]))
        return np.array(rows)
