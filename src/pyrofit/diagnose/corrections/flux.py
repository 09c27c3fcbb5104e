"""A factor on the external flux that varies over time."""

import numpy as np

from pyrofit.diagnose.corrections.correction import (
    Correction,
    Shape,
    Values,
    coefficient_names,
    derived,
    slabs_of,
    times_of_record,
)
from pyrofit.diagnose.corrections.flux_tables import described_at, merged, table_of
from pyrofit.estimate.problem import Problem
from pyrofit.model.time_table import TimeTable


def flux(problem: Problem, count: int, sd: float) -> Correction:
    """Make q(t) = q_0(t) (1 + c(t)), c linear between knots that lie closest at the start.

    c has ``count`` coefficients, with the prior standard deviation ``sd`` each.
    """
    end = max(float(times[-1]) for times in times_of_record(problem).values())
    knots = end * np.linspace(0.0, 1.0, count) ** 2
    names = coefficient_names("flux", count)
    described = {name: table_of(slab.front.flux_W_m2) for name, slab in slabs_of(problem).items()}
    time = {name: merged(table.time_s, knots) for name, table in described.items()}
    own = {
        name: coefficient_names(f"flux_{i}_at", len(time[name])) for i, name in enumerate(described)
    }
    fronts = {
        name: {"flux_W_m2": TimeTable(time_s=time[name], value=own[name])} for name in described
    }

    def derive(values: Values) -> dict[str, float]:
        c = [values[name] for name in names]
        found: dict[str, float] = {}
        for name, table in described.items():
            q = described_at(table, time[name], values) * (1.0 + np.interp(time[name], knots, c))
            found |= zip(own[name], q.tolist(), strict=True)
        return found

    def shape(values: Values) -> Shape:
        return [(t, 1.0 + values[name]) for t, name in zip(knots.tolist(), names, strict=True)]

    return Correction(
        probe="flux",
        what="a factor on the external flux that varies over time",
        unit="-",
        sd=dict.fromkeys(names, sd),
        problem=derived(problem, {n: {"front": own} for n, own in fronts.items()}, derive),
        shape=shape,
    )
