"""Draws from the posterior of the parameters, and all experiments predicted with them."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.config.programs import externals
from pyrofit.defaults import POSTERIOR_SETS, POSTERIOR_STEPS
from pyrofit.errors import DataError, StudyError
from pyrofit.estimate.ensembles import ENSEMBLES
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.pose import of_imp
from pyrofit.estimate.sampled import Sampled, sample, spread
from pyrofit.logs import Tell
from pyrofit.numerics import linear
from pyrofit.results import identification, posterior
from pyrofit.results.files import Results, write_csv, write_json
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.fit import fixed_for_imp
from pyrofit.stages.imp_likelihood import imp_likelihood
from pyrofit.stages.measurements import load
from pyrofit.stages.posterior_bands import predicted

KEPT = 4000
"""Draws that are kept for figures."""
CHANGED = 0.05
"""Relative change of chi-square from which on a result belongs to another study."""


def sample_posterior(
    study: Study,
    results: Results,
    tell: Tell = lambda text: None,
    sets: int = POSTERIOR_SETS,
    most_steps: int = POSTERIOR_STEPS,
    cores: int = 1,
) -> None:
    """Draw from the posterior about the optimum that `identify` found; write ``posterior``.

    Parameters
    ----------
    study, results
        A study whose step `identify` has run.
    tell
        Receives messages on the progress.
    sets
        Sets of the ensemble to write.
    most_steps
        Steps of each ensemble at most.
    cores
        Processes; the results do not depend on them.

    Raises
    ------
    StudyError
        External programs simulate an experiment.
    DataError
        `identify` has not run, or belongs to another description of the study.
    """
    if programs := sorted(externals(study)):
        raise StudyError(
            f"study '{study.name}': a posterior takes tens of thousands of model calls, and "
            f"'{programs[0]}' is simulated by an external program. Describe it for pyrofit's own "
            "solver, or use the intervals of the step identify"
        )
    likelihood, start = likelihood_and_optimum(study, results)
    found = sample(likelihood, start, study.seed, cores, most_steps, tell)
    measurements, fixed = load(study, results), fixed_for_imp(study, results)
    bands, of_bands = predicted(study, found, measurements, fixed)
    _write(study, results, found, fixed, sets)
    write_csv(results.posterior(posterior.BANDS), bands)
    posterior.write(results, _content(study, found, of_bands, sets))


def likelihood_and_optimum(study: Study, results: Results) -> tuple[Likelihood, FloatArray]:
    """Return the likelihood of the inverse modelling, and the optimum that `identify` found.

    Raises
    ------
    DataError
        `identify` has not run. Or chi-square there is another one: the study or its data changed.
    """
    path = results.identification("estimate.csv")
    if not path.is_file():
        raise DataError(
            f"{path}: this result is missing; the draws start from it. Run the study first: "
            "snakemake --cores 2 --configfile <the study>"
        )
    likelihood = imp_likelihood(study, results, of_imp(study))
    start = likelihood.scaled(identification.estimates(study, results)["estimate"].to_numpy(float))
    known = float(identification.noise(results)["chi2"])
    residuals = likelihood.residuals(start)[: sum(likelihood.points)]
    now = linear.dot(residuals, residuals)
    if abs(now - known) > CHANGED * known:
        raise DataError(
            f"{path}: this belongs to another description of the study, as its chi-square is "
            f"{now:.4g} instead of {known:.4g}. Run the study again, or name the "
            "study file that it ran with"
        )
    return likelihood, start


def _write(
    study: Study, results: Results, found: Sampled, fixed: dict[str, float], sets: int
) -> None:
    """Write draws, their correlation, and the ensemble as a table and as files of values."""
    names = list(study.imp.estimate)
    likelihood, drawn = found.likelihood, found.drawn
    draws = pd.DataFrame(likelihood.values(spread(drawn, KEPT)), columns=names)
    write_csv(results.posterior(posterior.SAMPLES), draws)
    matrix = pd.DataFrame(_correlation(drawn.flat), columns=names)
    matrix.insert(0, "parameter", names)
    write_csv(results.posterior(posterior.CORRELATION), matrix)
    ensemble = pd.DataFrame(likelihood.values(spread(drawn, sets)), columns=names)
    weight = 1.0 / len(ensemble)
    numbered = ensemble.assign(weight=weight, set=np.arange(1, len(ensemble) + 1))
    write_csv(results.posterior(posterior.ENSEMBLE), numbered[["set", "weight", *names]])
    for old in results.posterior(posterior.SETS).glob("*.json"):
        old.unlink()
    for number, row in enumerate(ensemble.to_numpy().tolist(), start=1):
        values = {**fixed, **dict(zip(names, row, strict=True))}
        about = {"study": study.name, "set": number, "weight": weight, "values_SI": values}
        write_json(results.posterior(f"{posterior.SETS}/{number:04d}.json"), about)


def _correlation(draws: FloatArray) -> FloatArray:
    return linear.correlation(draws.T)


def _content(
    study: Study, found: Sampled, bands: list[dict[str, Any]], sets: int
) -> dict[str, Any]:
    drawn = found.drawn
    picks = found.likelihood.problem.picks
    return {
        "study": study.name,
        "seed": study.seed,
        "chi2": found.chi2,
        "freedom": found.freedom,
        "probability": found.probability,
        "converged": drawn.converged,
        "ensembles": ENSEMBLES,
        "walkers": drawn.samples.shape[2],
        "steps": drawn.steps,
        "left_out": drawn.steps - drawn.samples.shape[1],
        "calls": drawn.calls,
        "accepted": drawn.accepted,
        "times": float(np.max(drawn.times)),
        "sets": min(sets, len(drawn.flat)),
        "parameters": _parameters(found),
        "discrepancies": [
            {
                "experiment": experiment,
                "signal": signal,
                "level": of.level,
                "time": of.time,
                "offset": of.offset,
                "lasting": of.lasting,
            }
            for (experiment, signal, _), of in zip(picks, found.discrepancies, strict=True)
        ],
        "bands": bands,
    }


def _parameters(found: Sampled) -> list[dict[str, Any]]:
    values = found.likelihood.values(found.drawn.flat)
    columns = {
        "mean": np.mean(values, axis=0),
        "sd": np.std(values, axis=0, ddof=1),
        **dict(
            zip(("low", "median", "high"), np.quantile(values, (0.025, 0.5, 0.975), 0), strict=True)
        ),
        "rhat": found.drawn.rhat,
        "ess": found.drawn.ess,
    }
    return [
        {"name": name, **{key: float(column[i]) for key, column in columns.items()}}
        for i, name in enumerate(found.likelihood.problem.names)
    ]
