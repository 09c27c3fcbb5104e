"""The inputs of the times to ignition."""

from pyrofit.config import Study
from pyrofit.results import dependencies
from pyrofit.results.step import Inputs
from pyrofit.steps.ignition.record import FILE


def slice_of(study: Study) -> dependencies.Slice:
    """Return experiments and their files."""
    return {"experiments": dependencies.measured_slice(study)}


INPUTS = Inputs(
    reads=("measurements",),
    slice_of=slice_of,
    files=(
        FILE,
        "table_times.csv",
        "table_times.md",
        "table_lines.csv",
        "table_lines.md",
        "fluxes.svg",
    ),
)
