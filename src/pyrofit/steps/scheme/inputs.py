"""What the choice of a reaction scheme rests on."""

from pyrofit.config import Study
from pyrofit.results import dependencies
from pyrofit.results.code_digests import all_terms, code_of
from pyrofit.results.step import Inputs
from pyrofit.steps.scheme import record


def slice_of(study: Study) -> dependencies.Slice:
    """Return everything: the study is written again with a scheme, which uses two effects."""
    more = ("volatile", "tga_lag")
    terms = study.kinetics.cost if study.kinetics else all_terms(study)
    return {**study.model_dump(mode="json"), "code": code_of(study, terms, more)}


INPUTS = Inputs(
    reads=("measurements",),
    slice_of=slice_of,
    files=(
        record.FILE,
        record.CURVES,
        record.EXTENDED,
        "schemes.csv",
        "schemes.md",
        "parameters.csv",
        "parameters.md",
        "scheme.svg",
        "scheme.png",
    ),
)
