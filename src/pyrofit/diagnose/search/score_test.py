"""The change by each effect, without the part that the fitted parameters could make up for.

d(s) = w(theta, s) - w(theta, null) is the change of the whitened residuals w by strength s of an
effect. With J = dw/dtheta and Pi the inverse variance of a value anywhere within its limits,
the part that no other parameter can imitate is P d, P = I - J (J^T J + Pi)^-1 J^T.

- |P d| is the detectability: by how many standard deviations the effect shows.
- cos(P d_i, P d_j) tells which effects look alike.
- z = -(P d)^T w/|P d| is the score: how far the residual points the effect's way. It orders the
  candidates and raises the alarm; no effect is claimed from it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.diagnose.base.adequacy import score
from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.model import Model, extended, model_of, strength_of
from pyrofit.estimate.projection import project
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Screening:
    """Changes by one effect at the strengths that were tried.

    ``strengths`` in SI units, shape (tried,). ``raw`` d and ``changes`` P d, both of shape
    (points + known, tried). ``ahead``, shape (tried,), the chi-square that a linear refit of the
    other parameters would leave.
    """

    effect: str
    strengths: FloatArray
    raw: FloatArray
    changes: FloatArray
    ahead: FloatArray
    typical: int
    """Position of the strength nearest to the typical one."""

    @property
    def sizes(self) -> FloatArray:
        """|P d| in standard deviations, by strength."""
        return np.asarray(np.sqrt(np.sum(self.changes**2, axis=0)))

    @property
    def directions(self) -> FloatArray:
        """P d / |P d|, of the strengths that change anything, shape (points + known, changing)."""
        seen = self.sizes > 1e-9
        return np.asarray(self.changes[:, seen] / self.sizes[seen])

    @property
    def detectability(self) -> float:
        """|P d| at the typical strength."""
        return float(self.sizes[self.typical])

    def score(self, residuals: FloatArray) -> float:
        """Return the largest score of the strengths."""
        return score(residuals, self.directions)


def change_by_effect(model: Model, fit: Fit, effect: str, spanned: FloatArray) -> Screening | None:
    """Return the change of a fitted model by an effect; None if it cannot have the effect.

    ``spanned`` is what the fitted parameters span, of `projector`.
    """
    name, _ = strength_of(effect)
    try:
        more = model_of(model.base, {**model.effects, effect: (name,)}, model.channels)
    except ValueError:  # another effect sets the same number of the description
        return None
    settings = model.base.settings
    tried = strengths_tried(effect, settings.tried_strengths, settings.near_limit)
    sets = np.array([extended(fit.x, effect, s) for s in tried])
    runs = list(zip(tried, more.residuals_all(sets), strict=True))
    runs = [(s, residuals) for s, residuals in runs if more.finished(residuals)]
    if not runs:
        return None
    strengths = np.array([s for s, _ in runs])
    d = np.column_stack([residuals for _, residuals in runs]) - fit.residuals[:, None]
    ahead = np.sum(project(spanned, fit.residuals[:, None] + d) ** 2, axis=0)
    return Screening(effect, strengths, d, project(spanned, d), ahead, _typical(effect, strengths))


def strengths_tried(effect: str, sizes: Sequence[float], near_limit: float) -> FloatArray:
    """Return the strengths that are tried, weak ones first, both sides where limits allow.

    ``sizes`` are fractions of the typical distance from the null value. The strengths keep the
    fraction ``near_limit`` of the search range to either limit.
    """
    _, quantity = strength_of(effect)
    distance = abs(quantity.typical - quantity.value)
    margin = near_limit * (quantity.upper - quantity.lower)
    found: list[float] = []
    for size in sizes:
        for side in (1.0, -1.0):
            value = quantity.value + side * size * distance
            value = float(np.clip(value, quantity.lower + margin, quantity.upper - margin))
            if side * (value - quantity.value) > 0.0 and value not in found:
                found.append(value)
    return np.array(found)


def _typical(effect: str, strengths: FloatArray) -> int:
    return int(np.argmin(np.abs(strengths - strength_of(effect)[1].typical)))


def confusability(looks: list[Screening]) -> FloatArray:
    """Return cos(P d_i, P d_j) at typical strengths, shape (effects, effects)."""
    columns = [look.changes[:, look.typical] for look in looks]
    unit = np.column_stack([c / max(linear.norm(c), 1e-12) for c in columns])
    return linear.gram(unit)
