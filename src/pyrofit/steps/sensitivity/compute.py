"""Variance-based sensitivity of signals and costs, over time."""

import numpy as np

from pyrofit.analysis import sobol
from pyrofit.config import Study, TermSpec
from pyrofit.errors import DataError
from pyrofit.estimate.measures import Measure, channels, measures_of
from pyrofit.logs import Tell
from pyrofit.parallel import MOST_PIECES, parallel_map
from pyrofit.results.files import Results
from pyrofit.results.recorded import load
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.scorer import AT_ONCE, Scorer, scorer_of
from pyrofit.steps.sensitivity import record
from pyrofit.steps.sensitivity.found import indices_found, of_input, write_tables
from pyrofit.steps.sensitivity.options import SensitivityOptions
from pyrofit.steps.sensitivity.record import Sensitivity
from pyrofit.steps.sensitivity.sampler import Sampler
from pyrofit.steps.sensitivity.varied import varied_inputs

MOST_TIMES = 120
"""Times of a signal at which indices are computed."""
LITERAL = "_literal"
"""End of the names of costs that give nearly all sets the same value; they are left out."""


def run(study: Study, results: Results, tell: Tell, processes: int) -> None:
    """Compute Sobol's indices of all signals over time and of all costs; write ``sensitivity``.

    Estimated parameters vary as the option ``within`` says. 'limits': they are uniform over their
    limits. 'near': uniform over a fifth of them about the estimates. 'intervals': normal about the
    estimates, with the standard deviations of the analysis of the likelihood.

    Raises
    ------
    DataError
        A result is missing, or no run finishes.
    """
    options = study.options(SensitivityOptions)
    measurements = load(study, results)
    known, left_out = measures_of(study, measurements)
    measures = [m for m in known if m.name in study.imp.costs or not m.name.endswith(LITERAL)]
    scored = [_signals(study), *measures]
    scorer, more = scorer_of(study, results, measurements, scored, searched=False)
    inputs, problem = varied_inputs(study, results, scorer.problem, options.within)
    sampler = Sampler(Scorer(problem, scorer.measures, scorer.likelihood), inputs, _times(scorer))
    seed = seed_for(study.seed, "sensitivity")
    points = sobol.design(options.samples, len(inputs), seed)
    tell(f"sensitivity: {points[..., 0].size} model calls, {len(inputs)} inputs")
    outputs, failed = sobol.replace_failed(_sampled(sampler, points, processes), seed)
    if failed == options.samples:
        raise DataError(
            f"{results.root}: of each point of the sample, a run does not finish; narrow the "
            "limits of the parameters, or take more points with --samples"
        )
    indices = sobol.indices(outputs, seed)
    found = indices_found(study, sampler, outputs, indices)
    write_tables(results, found)
    record.write(
        results,
        Sensitivity(
            study=study.name,
            within=options.within,
            samples=options.samples,
            runs=int(points[..., 0].size),
            unfinished=failed,
            left_out=[*left_out, *more],
            inputs=[of_input(one) for one in inputs],
            signals=found.signals,
            costs=found.costs,
            same=found.same,
        ),
    )


def _signals(study: Study) -> Measure:
    """Return all signals of the fitted experiments as terms, at all measured times."""
    experiments = dict.fromkeys(c.experiment for c in channels(study))
    pairs = [(e, s) for e in experiments for s in study.experiments[e].signals]
    return Measure("", "", tuple(TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in pairs))


def _times(scorer: Scorer) -> list[FloatArray]:
    found = []
    for _, term in scorer.problem.cost.terms[: len(scorer.measures[0].terms)]:
        last = term.target.time_s.size - 1
        found.append(np.unique(np.linspace(0, last, min(last + 1, MOST_TIMES)).round().astype(int)))
    return found


def _sampled(sampler: Sampler, points: FloatArray, cores: int) -> FloatArray:
    """Return the outputs, shape (samples, inputs + 2, outputs); processes do not change them."""
    flat = points.reshape(-1, points.shape[-1])
    size = max(AT_ONCE, -(-len(flat) // MOST_PIECES))
    starts = range(0, len(flat), size)
    pieces = parallel_map(
        lambda i: sampler.outputs(flat[starts[i] : starts[i] + size]), len(starts), cores
    )
    return np.concatenate(pieces).reshape(*points.shape[:2], -1)
