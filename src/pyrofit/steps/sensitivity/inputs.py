"""What the sensitivity analysis rests on."""

from pyrofit.config import Study
from pyrofit.cost import known_costs
from pyrofit.plugins import code_digest
from pyrofit.results import dependencies
from pyrofit.results.step import Inputs
from pyrofit.steps.sensitivity import record


def slice_of(study: Study) -> dependencies.Slice:
    """Return the likelihood, all costs and experiments, and known values."""
    return {
        "searches": {cost: dependencies.imp(study, cost, "sceua") for cost in study.imp.costs},
        "likelihood": dependencies.identify_slice(study),
        "kinds": {name: code_digest("costs", name) for name in known_costs()},
        "known": {name: known.model_dump() for name, known in study.known.items()},
        "seed": study.seed,
    }


INPUTS = Inputs(
    reads=("measurements", "kinetics", "programs"),
    slice_of=slice_of,
    files=(
        record.FILE,
        record.CURVES,
        record.OVER_TIME,
        record.COSTS,
        "total.svg",
        "apparatus.svg",
        "first.svg",
        "costs.svg",
    ),
)
