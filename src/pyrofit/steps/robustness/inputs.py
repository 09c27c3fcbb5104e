"""What the robustness of the cost functions rests on."""

from pyrofit.config import Study
from pyrofit.results import dependencies
from pyrofit.results.code_digests import all_terms
from pyrofit.results.step import Inputs


def slice_of(study: Study, cost: str) -> dependencies.Slice:
    """Return cost, twins, and all that a prediction rests on."""
    return {
        "terms": [t.model_dump() for t in all_terms(study)],
        "cost": cost,
        "truth": study.synthetic.truth if study.synthetic else {},
        "measured": dependencies.measured_slice(study),
        "limits": {n: study.parameters[n].bounds_si for n in study.imp.estimate},
        "seed": study.seed,
        **dependencies.known_slice(study, study.imp.estimate),
        **dependencies.validation_slice(study),
    }


INPUTS = Inputs(
    reads=("measurements", "kinetics", "programs", "truth"),
    slice_of=slice_of,
    files=("table.csv", "table.md", "robustness.svg", "robustness.png"),
    parts=lambda study: list(study.imp.costs),
    part_file="{part}.csv",
)
