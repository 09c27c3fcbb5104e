"""What the preview rests on."""

from pyrofit.config import Study
from pyrofit.results import dependencies
from pyrofit.results.step import Inputs
from pyrofit.steps.preview import record


def slice_of(study: Study) -> dependencies.Slice:
    """Return experiments, material, limits and known values."""
    return {
        "experiments": dependencies.measured_slice(study),
        "material": study.material_with(study.imp.kinetics).model_dump(),
        "heated": study.material.model_dump(),
        "parameters": {n: p.model_dump(exclude={"label"}) for n, p in study.parameters.items()},
        "accuracy": study.accuracy.model_dump(),
        "seed": study.seed,
        **dependencies.known_slice(study, study.parameters),
    }


INPUTS = Inputs(
    reads=("measurements",),
    slice_of=slice_of,
    files=(
        record.FOUND,
        record.BANDS,
        "table_outside.csv",
        "table_outside.md",
        "table_causes.csv",
        "table_causes.md",
    ),
)
