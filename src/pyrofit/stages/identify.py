"""Identifiability: noise of channels, intervals, profiles, distances of the optimisers' sets."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.estimate.identify import Identification, identify
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.pose import of_imp, of_kinetics
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.numerics import linear
from pyrofit.results import goodness, identification, kinetics, searches
from pyrofit.results.files import Results, write_csv
from pyrofit.results.identification import Channel, StageNoise
from pyrofit.results.recorded import load
from pyrofit.stages.imp_likelihood import ends_of_searches, imp_likelihood
from pyrofit.stages.kinetic_curves import write_curves

BEST, MEAN = "SCE-UA best", "SCE-UA mean"


def identify_kinetics(study: Study, results: Results) -> None:
    """Analyse the likelihood of the kinetics about its optimum; write ``identification/kinetics``.

    It is searched from the fit and the ends of least squares. The optimum is the estimate of the
    kinetics, which the inverse modelling takes as given; its curves go to ``kinetics``.

    Raises
    ------
    DataError
        A result is missing, or a channel is too short to show its noise.
    """
    asked, fixed = of_kinetics(study), study.fixed_values()
    measurements = load(study, results)
    known = kinetics.read_ends(study, results)
    likelihood = pose_likelihood(study, asked, measurements, fixed, known)
    starts = [likelihood.scaled(np.array([end[n] for n in asked.names])) for end in known]
    _write(results, "kinetics", likelihood, identify(likelihood, starts))
    write_curves(study, results, measurements, kinetics.parameters(study, results))


def identify_imp(study: Study, results: Results) -> None:
    """Analyse the likelihood of the inverse modelling likewise; write ``identification/imp``.

    It is searched from the ends of least squares and CMA-ES and the best sets of all repetitions.

    Raises
    ------
    DataError
        A result is missing, or a channel is too short to show its noise.
    """
    asked = of_imp(study)
    likelihood = imp_likelihood(study, results, asked)
    ends = ends_of_searches(study, results)
    starts = [likelihood.scaled(np.array([end[n] for n in asked.names])) for end in ends]
    found = identify(likelihood, starts)
    _write(results, "imp", likelihood, found)
    write_csv(results.identification("sets.csv"), _sets(study, results, likelihood, found))


def _write(results: Results, stage: str, likelihood: Likelihood, found: Identification) -> None:
    tables = {
        "estimate": _estimates(likelihood, found),
        "sensitivities": _sensitivities(likelihood, found),
        "singular_values": _modes(likelihood, found),
        "correlation": _correlation(likelihood, found),
        "profiles": _profiles(likelihood, found),
    }
    for name, frame in tables.items():
        write_csv(results.identification(f"{name}.csv", stage), frame)
    identification.write_noise(results, stage, _noise(likelihood, found))
    goodness.write(results, stage, found.goodness)


def _estimates(likelihood: Likelihood, found: Identification) -> pd.DataFrame:
    """Return estimate and intervals in SI units, widths as fractions of the search range."""
    lower = likelihood.problem.lower
    span = likelihood.problem.upper - lower
    return pd.DataFrame(
        [
            {
                "parameter": e.name,
                "estimate": lower[i] + e.x * span[i],
                "sd": e.sd * span[i],
                "apparatus_sd": e.apparatus * span[i],
                "apparatus_most": e.most,
                "low": lower[i] + e.interval.low * span[i],
                "high": lower[i] + e.interval.high * span[i],
                "low_open": e.interval.low_open,
                "high_open": e.interval.high_open,
                "width": e.interval.width,
                "noise_low": lower[i] + e.noise.low * span[i],
                "noise_high": lower[i] + e.noise.high * span[i],
                "noise_width": e.noise.width,
                "method": e.method,
                "bound": e.bound,
                "verdict": e.verdict,
            }
            for i, e in enumerate(found.estimates)
        ]
    )


def _sensitivities(likelihood: Likelihood, found: Identification) -> pd.DataFrame:
    """Return d curve / d parameter * search range: in the signal's unit, and whitened."""
    problem = likelihood.problem
    parts = []
    for (experiment, signal, _), (_, term), slopes, whitened in zip(
        problem.picks,
        problem.cost.terms,
        likelihood.split(found.slopes),
        likelihood.split(found.posterior.jacobian),
        strict=True,
    ):
        for i, name in enumerate(problem.names):
            columns = {"time_s": term.target.time_s, "si": slopes[:, i], "whitened": whitened[:, i]}
            frame = pd.DataFrame(columns)
            parts.append(frame.assign(experiment=experiment, signal=signal, parameter=name))
    return pd.concat(parts, ignore_index=True)


def _modes(likelihood: Likelihood, found: Identification) -> pd.DataFrame:
    values, directions = found.modes()
    frame = pd.DataFrame({"mode": np.arange(1, values.size + 1), "singular_value": values})
    for name, components in zip(likelihood.problem.names, directions, strict=True):
        frame[name] = components
    return frame


def _correlation(likelihood: Likelihood, found: Identification) -> pd.DataFrame:
    names = list(likelihood.problem.names)
    frame = pd.DataFrame(found.correlation, columns=names)
    frame.insert(0, "parameter", names)
    return frame


def _profiles(likelihood: Likelihood, found: Identification) -> pd.DataFrame:
    """Return the rise of chi-square against each parameter that has a profile, SI units."""
    names = likelihood.problem.names
    columns: dict[str, list[Any]] = {"parameter": [], "value": [], "rise": []}
    for name, profile in found.profiles.items():
        i = names.index(name)
        span = likelihood.problem.upper[i] - likelihood.problem.lower[i]
        columns["parameter"] += [name] * profile.x.size
        columns["value"] += (likelihood.problem.lower[i] + profile.x * span).tolist()
        columns["rise"] += profile.rise.tolist()
    return pd.DataFrame(columns)


def _sets(
    study: Study, results: Results, likelihood: Likelihood, found: Identification
) -> pd.DataFrame:
    """Return chi-square of the optimisers' sets, and their distance from the optimum in sd."""
    names = list(study.imp.estimate)
    summary = searches.best_of_repetitions(study, results)
    rows = []
    for cost in study.imp.costs:
        group = summary[summary["cost_function"] == cost]
        sets: dict[str, Mapping[str, float] | pd.Series] = {
            BEST: group.iloc[int(group["cost"].to_numpy().argmin())],
            MEAN: group[names].mean(),
            **{
                f"{optimiser.words} best": searches.read_starts(study, results, cost, key)[
                    0
                ].parameters
                for key, optimiser in OPTIMISERS.items()
            },
        }
        for label, values in sets.items():
            x = likelihood.scaled(np.array([float(values[name]) for name in names]))
            distances = {e.name: (x[i] - e.x) / e.sd for i, e in enumerate(found.estimates)}
            about = {"cost_function": cost, "set": label, "chi2": likelihood.chi2(x)}
            rows.append({**about, **distances})
    return pd.DataFrame(rows)


def _noise(likelihood: Likelihood, found: Identification) -> StageNoise:
    residuals = likelihood.split(likelihood.residuals(found.optimum.x))
    channels = [
        Channel(
            experiment=experiment,
            signal=signal,
            points=part.size,
            sd_median=float(np.median(noise.total_sd)),
            points_sd=float(np.median(noise.sd)),
            lasting_sd=float(np.median(noise.lasting_sd)),
            lags=list(noise.correlation.lags),
            ar=noise.correlation.ar,
            splines=noise.splines,
            excess=noise.excess,
            whiteness=noise.whiteness,
            floors=dict(noise.floors),
            words=noise.describe(),
            chi2=linear.dot(part, part),
        )
        for (experiment, signal, _), noise, part in zip(
            likelihood.problem.picks, likelihood.noise, residuals, strict=True
        )
    ]
    return StageNoise(
        channels=channels,
        chi2=found.posterior.chi2,
        freedom=found.posterior.freedom,
        dispersion=found.posterior.dispersion,
    )
