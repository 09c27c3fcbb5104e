"""The registry of the costs: the only place that names all of the package."""

from collections.abc import Callable

from pyrofit.cost.added import added_costs
from pyrofit.cost.gpyro import gpyro
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
    "GPYRO": gpyro,
}
"""The package's costs by name; the keyword arguments of each are its options."""


def known_costs() -> dict[str, Callable[..., Residuals]]:
    """Return the package's costs and the user's own by name.

    >>> list(known_costs())[:3]
    ['RMSE', 'RANGE', 'BANDS']
    """
    return KINDS | added_costs()
