"""What the worth of planned tests rests on."""

from pyrofit.config import Study
from pyrofit.plugins import code_digest
from pyrofit.quantities import known_quantities
from pyrofit.results import dependencies
from pyrofit.results.step import Inputs
from pyrofit.steps.worth import record


def slice_of(study: Study) -> dependencies.Slice:
    """Return all data that are fitted, and predicted signals."""
    return {
        "likelihood": dependencies.identify_slice(study),
        "kinetics": dependencies.kinetics(study) if study.imp.kinetics == "fitted" else {},
        "validation": dependencies.validation_slice(study),
        # New tests may record any quantity.
        "quantities": {n: code_digest("quantities", n) for n in known_quantities()},
        "seed": study.seed,
    }


INPUTS = Inputs(
    reads=("measurements", "kinetics", "fits_for_noise", "estimate"),
    slice_of=slice_of,
    files=(record.FILE, "worth.svg"),
)
