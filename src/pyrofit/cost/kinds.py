"""The registry of the costs: the only place that names them all."""

from collections.abc import Callable

from pyrofit.cost.single_point import (
    nrse,
    thr_above,
    thr_above_literal,
    thr_below,
    thr_below_literal,
)
from pyrofit.cost.target import Residuals
from pyrofit.cost.whole_curve import bands, bands_propti, range_, range_propti, rmse

KINDS: dict[str, Callable[..., Residuals]] = {
    "RMSE": rmse,
    "RANGE": range_,
    "BANDS": bands,
    "RANGE_PROPTI": range_propti,
    "BANDS_PROPTI": bands_propti,
    "NRSE": nrse,
    "THR_above": thr_above,
    "THR_below": thr_below,
    "THR_above_literal": thr_above_literal,
    "THR_below_literal": thr_below_literal,
}
"""The costs by name; the keyword arguments of each are its options."""
