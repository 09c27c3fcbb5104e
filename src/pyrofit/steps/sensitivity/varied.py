"""Inputs of a sensitivity analysis: estimated parameters, known values, the apparatus."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.config import Study, parameters_in
from pyrofit.effects.base import changed
from pyrofit.estimate.prior import within_known
from pyrofit.estimate.problem import Problem
from pyrofit.experiments.slab.uncertain import PLACES, Place, uncertain_numbers, with_value
from pyrofit.model.slab import SlabExperiment
from pyrofit.results.files import Results, read_csv
from pyrofit.results.goodness import MISFIT
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.sensitivity.record import Kind

REACH = 3.0
"""Standard deviations from the mean to the farthest value of a normal distribution."""
NEAR = 0.1
"""Half of the width about an estimate, as a fraction of the search range."""
ESTIMATED: Kind = "estimated"
KNOWN: Kind = "known"
APPARATUS: Kind = "apparatus"
EMISSIVITY_SD = 0.02
"""Of a component whose emissivity is a number of the description."""


@dataclass(frozen=True)
class Input:
    """Something that varies, SI units: uniform between limits, or normal within them.

    ``experiment`` is empty where it belongs to all of them; ``sd`` is none if it is uniform.
    """

    name: str
    label: str
    kind: Kind
    unit: str
    factor: float
    low: float
    high: float
    mean: float
    sd: float | None
    source: str
    experiment: str = ""

    def at(self, u: FloatArray) -> FloatArray:
        """Return the values of a uniform variable in [0, 1)."""
        if self.sd is None:
            return np.asarray(self.low + u * (self.high - self.low))
        from scipy.special import ndtr, ndtri

        ends = ndtr((np.array([self.low, self.high]) - self.mean) / self.sd)
        drawn = self.mean + self.sd * ndtri(ends[0] + u * (ends[1] - ends[0]))
        return np.asarray(np.clip(drawn, self.low, self.high))


def varied_inputs(
    study: Study, results: Results, problem: Problem, within: str
) -> tuple[list[Input], Problem]:
    """Return the inputs that vary, and the problem with names in their places.

    Parameters
    ----------
    study, results
        The study.
    problem
        Its terms are all costs.
    within
        'limits': estimated parameters vary over their limits; 'near': over a fifth of them about
        the estimates; 'intervals': as the data leave them.
    """
    named, apparatus = _apparatus(problem)
    used = {
        n for run in problem.runs.values() for n in parameters_in(problem.material, run.experiment)
    }
    estimated = {"limits": _within_limits, "near": _near, "intervals": _within_intervals}[within]
    found = estimated(study, results, problem)
    known = [n for n in study.known if n in used and n not in problem.names]
    return [*found, *(_known(study, name) for name in known), *apparatus], named


def _within_limits(study: Study, results: Results, problem: Problem) -> list[Input]:
    searched = within_known(study, problem)
    return [
        _parameter(study, name, ESTIMATED, low, high, 0.5 * (low + high), None, "limits")
        for name, low, high in zip(
            searched.names, searched.lower.tolist(), searched.upper.tolist(), strict=True
        )
    ]


def _near(study: Study, results: Results, problem: Problem) -> list[Input]:
    """Return uniform distributions about the estimates, over a fifth of the search range."""
    searched = within_known(study, problem)
    reach = NEAR * searched.span
    found = []
    for i, (name, (mean, _)) in enumerate(_estimates(results, problem).items()):
        low = float(max(mean - reach[i], searched.lower[i]))
        high = float(min(mean + reach[i], searched.upper[i]))
        found.append(_parameter(study, name, ESTIMATED, low, high, mean, None, "about estimate"))
    return found


def _within_intervals(study: Study, results: Results, problem: Problem) -> list[Input]:
    """Return normal distributions about the estimates, cut off at the limits."""
    found = []
    for i, (name, (mean, sd)) in enumerate(_estimates(results, problem).items()):
        low = float(max(mean - REACH * sd, problem.lower[i]))
        high = float(min(mean + REACH * sd, problem.upper[i]))
        found.append(_parameter(study, name, ESTIMATED, low, high, mean, sd, "estimate"))
    return found


def _estimates(results: Results, problem: Problem) -> dict[str, tuple[float, float]]:
    """Return estimate and standard deviation of the analysis of the likelihood, SI units.

    Errors of the apparatus, which vary here by themselves, are not part of it.
    """
    numbers = ("estimate", "sd", "apparatus_sd")
    columns = {"parameter": object, "method": object, **dict.fromkeys(numbers, float)}
    frame = read_csv(
        results.identification("estimate.csv"),
        columns,
        {("parameter",): [(name,) for name in problem.names]},
    )
    of_apparatus = frame["apparatus_sd"].where(frame["method"] == MISFIT, 0.0)
    sds = np.sqrt(np.maximum(frame["sd"] ** 2 - of_apparatus**2, 0.0))
    rows = zip(frame["parameter"], frame["estimate"], sds, strict=True)
    pairs = {str(name): (float(mean), float(sd)) for name, mean, sd in rows}
    return {name: pairs[name] for name in problem.names}


def _known(study: Study, name: str) -> Input:
    known, factor = study.known[name], study.parameters[name].factor
    mean, sd = factor * known.value, factor * known.sd
    source = known.source or "known value"
    return _parameter(study, name, KNOWN, mean - REACH * sd, mean + REACH * sd, mean, sd, source)


def _parameter(
    study: Study,
    name: str,
    kind: Kind,
    low: float,
    high: float,
    mean: float,
    sd: float | None,
    source: str,
) -> Input:
    p = study.parameters[name]
    return Input(name, p.label or name, kind, p.unit, p.factor, low, high, mean, sd, source)


def _apparatus(problem: Problem) -> tuple[Problem, list[Input]]:
    """Return the problem with uncertain numbers of slabs and uncertain emissivities, and these."""
    runs, found = dict(problem.runs), list[Input]()
    for name, run in problem.runs.items():
        experiment = run.experiment
        for key, value in uncertain_numbers(experiment).items():
            if isinstance(value, float):
                made = f"{name}_{key}"
                experiment = with_value(experiment, PLACES[key], made)
                found.append(_uncertain(made, PLACES[key], value, name))
        runs[name] = replace(run, experiment=experiment)
    components = dict(problem.material.components)
    for name in sorted(problem.material.own if any(_slabs(problem)) else ()):
        emissivity = components[name].emissivity
        if isinstance(emissivity, float):
            made = f"emissivity_{name}"
            components[name] = changed(components[name], emissivity=made)
            place = Place("", "", f"emissivity of {name}", "-", EMISSIVITY_SD)
            found.append(_uncertain(made, place, emissivity, "", 0.0, 1.0))
    material = changed(problem.material, components=components)
    return replace(problem, runs=runs, material=material), found


def _slabs(problem: Problem) -> Iterable[SlabExperiment]:
    experiments = (run.experiment for run in problem.runs.values())
    return [e for e in experiments if isinstance(e, SlabExperiment)]


def _uncertain(
    name: str,
    place: Place,
    value: float,
    experiment: str,
    least: float = -np.inf,
    most: float = np.inf,
) -> Input:
    low, high = max(value - REACH * place.sd, least), min(value + REACH * place.sd, most)
    return Input(
        name=name,
        label=place.label,
        kind=APPARATUS,
        unit=place.unit,
        factor=1.0,
        low=low,
        high=high,
        mean=value,
        sd=place.sd,
        source="default",
        experiment=experiment,
    )


def columns(inputs: Iterable[Input], points: FloatArray) -> Mapping[str, FloatArray]:
    """Return the values of all inputs, by name, at points of the unit cube (points, inputs)."""
    return {one.name: one.at(points[:, i]) for i, one in enumerate(inputs)}
