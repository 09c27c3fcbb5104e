"""Results of the sampling, in sentences."""

from pyrofit.config import Study
from pyrofit.estimate.convergence import ENOUGH_TIMES, ESS, RHAT
from pyrofit.results.files import Results
from pyrofit.show.text import listed, several
from pyrofit.steps.posterior import record
from pyrofit.steps.posterior.record import SampledPosterior

CHANCE = 0.05
"""Chance of a chi-square below which noise alone does not explain the data."""
FAR = 2.0
"""Chi-square per degree of freedom from which on bands of wrong twins held half of the points."""
INSIDE = 0.9
"""Share of the points of a held-out signal that a band of 95 % should hold at least."""


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on convergence, adequacy, bands and the ensemble."""
    found = record.read(study, results)
    return [_converged(found), _adequate(found), *_bands(found), *_missing(found), _ensemble(found)]


def _converged(found: SampledPosterior) -> str:
    rhat = max(p.rhat for p in found.parameters)
    ess = min(p.ess for p in found.parameters)
    reached = (
        f"{several(found.ensembles, 'ensemble')} of {found.walkers} walkers took {found.steps} "
        f"steps ({found.calls} model calls): R-hat is at most {rhat:.3f}, the effective sample "
        f"size at least {ess:.0f}"
    )
    if found.converged:
        return f"The sampling converged. {reached}."
    length = (found.steps - found.left_out) / found.times
    return (
        f"The sampling did NOT converge: do not use its numbers. {reached}, and the ensembles "
        f"are {length:.0f} autocorrelation times long. Below {RHAT:g}, above {ESS:g} and "
        f"{ENOUGH_TIMES:g} are needed: raise --steps."
    )


def _adequate(found: SampledPosterior) -> str:
    ratio = found.chi2 / found.freedom
    size = f"chi-square per degree of freedom {ratio:.3g}, p = {found.probability:.2g}"
    if found.probability < CHANCE:
        said = f"Noise alone does not explain the data ({size}): the model lacks an effect. "
        if ratio > FAR:
            return said + (
                "The misfit is so large that bands at other conditions may miss the truth. "
                "First find the missing effect (snakemake diagnose)."
            )
        return said + "The bands include a model discrepancy of the size of the residuals."
    return (
        f"Noise alone may explain the data ({size}). This does not prove the model: parameters "
        "can compensate for a missing effect. The bands include a model discrepancy of a size "
        "that the residuals allow."
    )


def _bands(found: SampledPosterior) -> list[str]:
    """Say whether the bands contain the held-out measurements."""
    held = [of for of in found.bands if of.role == "held out" and of.inside is not None]
    low = [of for of in held if of.inside is not None and of.inside < INSIDE]
    said = [
        f"The 95 % band of {of.experiment} {of.signal}, which was not fitted, contains only "
        f"{100.0 * (of.inside or 0.0):.0f} % of the measured points: do not rely on it."
        for of in low
    ]
    if held and not low:
        names = listed([f"{of.experiment} {of.signal}" for of in held])
        least = min(of.inside for of in held if of.inside is not None)
        said.append(
            f"The 95 % bands contain {100.0 * least:.0f} % or more of the held-out points "
            f"({names})."
        )
    return said


def _missing(found: SampledPosterior) -> list[str]:
    names = [f"{of.experiment} {of.signal}" for of in found.bands if not of.lacking]
    if not names:
        return []
    return [
        f"No fitted signal determines the model discrepancy of {listed(names)}. The band contains "
        "the uncertainty of the parameters alone, and is too narrow."
    ]


def _ensemble(found: SampledPosterior) -> str:
    return (
        f"For predictions, use the ensemble of {found.sets} sets of equal weight rather than one "
        "set: posterior/ensemble.csv, and posterior/sets for other programs."
    )
