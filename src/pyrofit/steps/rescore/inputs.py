"""What the scores of stored sets rest on."""

from pyrofit.config import Study
from pyrofit.cost import known_costs
from pyrofit.plugins import code_digest
from pyrofit.results import dependencies
from pyrofit.results.step import Inputs
from pyrofit.steps.rescore import record


def slice_of(study: Study) -> dependencies.Slice:
    """Return all searches, the likelihood, and the code of all costs."""
    return {
        "searches": {cost: dependencies.imp(study, cost, "sceua") for cost in study.imp.costs},
        "likelihood": dependencies.identify_slice(study),
        "kinds": {name: code_digest("costs", name) for name in known_costs()},
        **dependencies.collect_slice(study),
    }


INPUTS = Inputs(
    reads=("measurements", "kinetics", "programs", "fits_for_noise", "searches"),
    slice_of=slice_of,
    files=(
        record.FILE,
        record.SETS,
        record.SCORES,
        record.CORRELATION,
        record.AMONG_BEST,
        record.EXCESS,
        record.BETTER,
        "agreement.svg",
        "agreement_best.svg",
        "regret.svg",
        "valleys.svg",
    ),
)
