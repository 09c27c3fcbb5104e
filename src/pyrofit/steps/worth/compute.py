"""Which measurement would narrow parameters and predictions most: the worth of planned tests."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.analysis import data_worth
from pyrofit.config import Study
from pyrofit.config.expand.programs import externals
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.errors import DataError
from pyrofit.estimate.posterior import curvature, limit_of
from pyrofit.estimate.targets import Measurements
from pyrofit.experiments import kind_of
from pyrofit.logs import Tell
from pyrofit.results.files import Results
from pyrofit.results.recorded import load
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.worth import record
from pyrofit.steps.worth.apparatus import of_fitted, of_record
from pyrofit.steps.worth.best_fit import best_fit
from pyrofit.steps.worth.check import DrawnData, spreads
from pyrofit.steps.worth.forecast import Forecast, Lasting, forecast_test
from pyrofit.steps.worth.options import WorthOptions
from pyrofit.steps.worth.planned import Planned, planned
from pyrofit.steps.worth.record import OfPrediction, OfTest, Sds, Worth

CHECKED = 3
"""Tests that are checked."""
Spread = tuple[FloatArray, dict[str, float]]
"""Standard deviations: of parameters, in units of their search range, and of predictions."""


@dataclass(frozen=True, eq=False)
class Ranked:
    """A test and the uncertainties that it leaves."""

    test: Planned
    gain_bit: float
    left: float
    sds: Spread


def run(study: Study, results: Results, tell: Tell, processes: int) -> None:
    """Compute by how much planned tests narrow parameters and predictions; write ``worth``.

    The best tests are checked by refits of drawn data. Where the option ``apparatus`` says
    'uncertain', flux, thickness, heat losses and temperatures of every slab are uncertain as in the
    sensitivity analysis.

    Raises
    ------
    DataError
        A result is missing, or no planned test can be simulated.
    StudyError
        An external program simulates a fitted experiment.
    """
    options = study.options(WorthOptions)
    fitted = best_fit(study, results)
    predictions = _predictions(study, fitted, load(study, results))
    tests, left_out = planned(study, fitted)
    if not tests:
        raise DataError(f"study '{study.name}': none of the planned tests can be simulated")
    tell(f"worth of {len(tests)} planned tests for {len(predictions)} predictions")
    dispersion, lasting = fitted.posterior.dispersion, Lasting()
    if options.apparatus == "uncertain":
        lasting = of_fitted(fitted, dispersion)
        tests = [replace(t, record=of_record(fitted, t.record, dispersion)) for t in tests]
    before = _curvature(fitted, lasting)
    ranked = _ranked(fitted, before, tests, predictions)
    best = [one.test for one in ranked[:CHECKED]]
    drawn = DrawnData(fitted, dispersion, study.seed, lasting)
    checked = _checked(study, drawn, best, predictions, options.draws, tell, processes)
    found = Worth(
        study=study.name,
        points=fitted.model.points,
        dispersion=dispersion,
        apparatus=options.apparatus,
        draws=options.draws,
        estimate=_in_units(study, fitted, fitted.model.likelihood.values(fitted.fit.x)),
        now=_sds(study, fitted, *_linear(fitted, before, predictions)),
        now_checked=checked.get(""),
        predictions={name: _predicted(name) for name in predictions},
        tests=[_of_test(study, fitted, one, checked.get(one.test.name)) for one in ranked],
        left_out=left_out,
    )
    record.write(results, found)


def _predicted(name: str) -> OfPrediction:
    experiment, signal = name.split(" ")
    return OfPrediction(experiment=experiment, signal=signal)


def _of_test(study: Study, fitted: FittedModel, one: Ranked, checked: Sds | None) -> OfTest:
    return OfTest(
        name=one.test.name,
        words=one.test.words,
        quantities=list(one.test.record.noise),
        gain_bit=one.gain_bit,
        left=one.left,
        sds=_sds(study, fitted, *one.sds),
        checked=checked,
    )


def _curvature(fitted: FittedModel, lasting: Lasting) -> FloatArray:
    """Return the inverse covariance that the data so far leave."""
    posterior, points = fitted.posterior, fitted.model.points
    channels = lasting.whiten(posterior.jacobian[:points])
    jacobian = np.concatenate([channels, posterior.jacobian[points:]])
    return curvature(jacobian, posterior.dispersion, posterior.known)


def _checked(
    study: Study,
    drawn: DrawnData,
    tests: Sequence[Planned],
    predictions: Mapping[str, Forecast],
    draws: int,
    tell: Tell,
    cores: int,
) -> dict[str, Sds]:
    """Return the spread over refits without a test, by the name '', and with each of some."""
    if draws == 0:
        return {}
    tell(f"checking {len(tests)} of them by {draws * (len(tests) + 1)} refits of drawn data")
    records = [None, *(test.record for test in tests)]
    found = spreads(drawn, records, predictions, draws, cores)
    names = ["", *(test.name for test in tests)]
    return {n: _sds(study, drawn.fitted, *one) for n, one in zip(names, found, strict=True)}


def _predictions(
    study: Study, fitted: FittedModel, measurements: Measurements
) -> dict[str, Forecast]:
    """Return the curves of the experiments that are predicted and not fitted."""
    likelihood, x = fitted.model.likelihood, fitted.fit.x
    found = {}
    for name in study.validation.experiments:
        if name in likelihood.problem.runs or name in externals(study):
            continue
        experiment = study.experiments[name]
        for signal in experiment.signals:
            frame = measurements[name, signal]
            time = frame["time_s"].to_numpy(float)
            request = kind_of(experiment).request(experiment, signal, frame, time)
            if one := forecast_test(likelihood, x, experiment, {signal: request}):
                found[f"{name} {signal}"] = one
    return found


def _ranked(
    fitted: FittedModel,
    before: FloatArray,
    tests: Sequence[Planned],
    predictions: Mapping[str, Forecast],
) -> list[Ranked]:
    """Return the tests with the uncertainties they leave, the best first."""
    dispersion = fitted.posterior.dispersion
    found = []
    for test in tests:
        after = data_worth.narrowed(before, test.record.jacobian, dispersion)
        parts = [_linear(fitted, curve, predictions) for curve in (before, after)]
        left = [
            data_worth.left(np.asarray(now), np.asarray(then))
            for now, then in (
                (parts[0][0], parts[1][0]),
                (list(parts[0][1].values()), list(parts[1][1].values())),
            )
        ]
        both = float(np.sqrt(left[0] * left[1])) if predictions else left[0]
        gain = data_worth.gain(before, after, _free(fitted))
        found.append(Ranked(test, gain, both, parts[1]))
    return sorted(found, key=lambda one: one.left)


def _free(fitted: FittedModel) -> list[int]:
    """Return the positions of the parameters that do not rest at a limit."""
    return [i for i, x in enumerate(fitted.fit.x) if not limit_of(x)]


def _linear(fitted: FittedModel, curve: FloatArray, predictions: Mapping[str, Forecast]) -> Spread:
    """Return the standard deviations that an inverse covariance leaves."""
    free = _free(fitted)
    return data_worth.sds(curve, free), {
        name: data_worth.predicted_sd(curve, np.concatenate(list(one.slopes.values())), free)
        for name, one in predictions.items()
    }


def _sds(
    study: Study, fitted: FittedModel, sds: FloatArray, predictions: Mapping[str, float]
) -> Sds:
    values = sds * fitted.model.likelihood.problem.span
    return Sds(parameters=_in_units(study, fitted, values), predictions=dict(predictions))


def _in_units(study: Study, fitted: FittedModel, values: FloatArray) -> dict[str, float]:
    names = fitted.model.likelihood.problem.names
    pairs = zip(names, values.tolist(), strict=True)
    return {name: value / study.parameters[name].factor for name, value in pairs}
