"""What the stability of a diagnosis rests on."""

from pyrofit.config import Study
from pyrofit.results import dependencies
from pyrofit.results.step import Inputs
from pyrofit.steps.stability import record
from pyrofit.steps.stability.options import StabilityOptions


def parts(study: Study) -> list[str]:
    """Return the numbers of the draws."""
    return [str(draw) for draw in range(study.options(StabilityOptions).draws)]


def slice_of(study: Study, draw: str) -> dependencies.Slice:
    """Return the inputs of a draw: those of the diagnosis."""
    return dependencies.diagnose_slice(study)


INPUTS = Inputs(
    reads=("measurements",),
    slice_of=slice_of,
    files=(
        "table_effects.csv",
        "table_effects.md",
        "table_draws.csv",
        "table_draws.md",
        "stability.svg",
        "stability.png",
        record.GATHERED,
    ),
    parts=parts,
    part_file="draw_{part}.json",
    of_parts=("draws",),
    gathers=("diagnosis",),
    version=record.version,
)
