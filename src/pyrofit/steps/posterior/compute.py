"""Draws from the posterior of the parameters, and all experiments predicted with them."""

from dataclasses import asdict

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.config.expand.programs import externals
from pyrofit.errors import DataError, StudyError
from pyrofit.estimate.ensembles import ENSEMBLES
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.pose import of_imp
from pyrofit.estimate.sampled import Sampled, sample, spread
from pyrofit.logs import Tell
from pyrofit.numerics import linear
from pyrofit.results import identification
from pyrofit.results.files import Results, write_csv, write_json
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.recorded import load
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.imp_likelihood import imp_likelihood
from pyrofit.steps.posterior import record
from pyrofit.steps.posterior.bands import predict_with_bands
from pyrofit.steps.posterior.options import PosteriorOptions
from pyrofit.steps.posterior.record import OfBand, OfDiscrepancy, OfDraws, SampledPosterior

KEPT = 4000
"""Draws that are kept for figures."""
CHANGED = 0.05
"""Relative change of chi-square from which on a result belongs to another study."""


def run(study: Study, results: Results, tell: Tell, processes: int) -> None:
    """Draw from the posterior about the optimum that `identify` found; write ``posterior``.

    The results do not depend on the number of processes.

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
    options = study.options(PosteriorOptions)
    found = sample(likelihood, start, study.seed, processes, options.steps, tell)
    measurements, fixed = load(study, results), fixed_for_imp(study, results)
    bands, of_bands = predict_with_bands(study, found, measurements, fixed)
    _write(study, results, found, fixed, options.sets)
    write_csv(results.of_step("posterior", record.BANDS), bands)
    record.write(results, _found(study, found, of_bands, options.sets))


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
    known = identification.read_noise(results).chi2
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
    write_csv(results.of_step("posterior", record.SAMPLES), draws)
    matrix = pd.DataFrame(linear.correlation(drawn.flat.T), columns=names)
    matrix.insert(0, "parameter", names)
    write_csv(results.of_step("posterior", record.CORRELATION), matrix)
    ensemble = pd.DataFrame(likelihood.values(spread(drawn, sets)), columns=names)
    weight = 1.0 / len(ensemble)
    numbered = ensemble.assign(weight=weight, set=np.arange(1, len(ensemble) + 1))
    write_csv(results.of_step("posterior", record.ENSEMBLE), numbered[["set", "weight", *names]])
    for old in results.of_step("posterior", record.SETS).glob("*.json"):
        old.unlink()
    for number, row in enumerate(ensemble.to_numpy().tolist(), start=1):
        values = {**fixed, **dict(zip(names, row, strict=True))}
        about = {"study": study.name, "set": number, "weight": weight, "values_SI": values}
        write_json(results.of_step("posterior", f"{record.SETS}/{number:04d}.json"), about)


def _found(study: Study, found: Sampled, bands: list[OfBand], sets: int) -> SampledPosterior:
    drawn = found.drawn
    picks = found.likelihood.problem.picks
    return SampledPosterior(
        study=study.name,
        seed=study.seed,
        chi2=found.chi2,
        freedom=found.freedom,
        probability=found.probability,
        converged=drawn.converged,
        ensembles=ENSEMBLES,
        walkers=drawn.samples.shape[2],
        steps=drawn.steps,
        left_out=drawn.steps - drawn.samples.shape[1],
        calls=drawn.calls,
        accepted=drawn.accepted,
        times=float(np.max(drawn.times)),
        sets=min(sets, len(drawn.flat)),
        parameters=_parameters(found),
        discrepancies=[
            OfDiscrepancy(experiment=experiment, signal=signal, **asdict(of))
            for (experiment, signal, _), of in zip(picks, found.discrepancies, strict=True)
        ],
        bands=bands,
    )


def _parameters(found: Sampled) -> list[OfDraws]:
    values = found.likelihood.values(found.drawn.flat)
    quantiles = np.quantile(values, (0.025, 0.5, 0.975), 0)
    columns = {
        "mean": np.mean(values, axis=0),
        "sd": np.std(values, axis=0, ddof=1),
        **dict(zip(("low", "median", "high"), quantiles, strict=True)),
        "rhat": found.drawn.rhat,
        "ess": found.drawn.ess,
    }
    return [
        OfDraws(name=name, **{key: float(column[i]) for key, column in columns.items()})
        for i, name in enumerate(found.likelihood.problem.names)
    ]
