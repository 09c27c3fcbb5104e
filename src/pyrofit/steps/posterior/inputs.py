"""What the draws from the posterior rest on."""

from pyrofit.config import Study
from pyrofit.results import dependencies
from pyrofit.results.step import Inputs
from pyrofit.steps.posterior import record


def slice_of(study: Study) -> dependencies.Slice:
    """Return the likelihood and all predicted experiments."""
    return {
        "likelihood": dependencies.identify_slice(study),
        "validation": dependencies.validation_slice(study),
        "seed": study.seed,
    }


INPUTS = Inputs(
    reads=("measurements", "kinetics", "fits_for_noise", "estimate", "noise"),
    slice_of=slice_of,
    files=(
        record.FILE,
        record.SAMPLES,
        record.ENSEMBLE,
        record.BANDS,
        record.CORRELATION,
        "bands.svg",
        "parameters.svg",
    ),
    folders=(record.SETS,),
)
