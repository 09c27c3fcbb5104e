"""An uneven flux as spots of the surface under multiples of it."""

from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.solver.observe import POINTS, WEIGHTS, rings
from pyrofit_exchange.fds.materials import Values


def spots_of(experiment: SlabExperiment, values: Values) -> list[tuple[float, float]]:
    """Return multiples of the flux, and weights, whose mean the uneven flux is."""
    spread = value_of(experiment.front.spread, values)
    even = [(1.0, 1.0)]
    if spread:
        pairs = zip(POINTS.tolist(), WEIGHTS.tolist(), strict=True)
        even = [(1.0 + spread * x, 0.5 * w) for x, w in pairs]
    profile = zip(*(part.tolist() for part in rings(experiment.front.profile)), strict=True)
    return [(f * g, v * w) for f, v in list(profile) for g, w in even]
