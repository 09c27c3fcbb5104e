"""Eq. 5: several costs as one."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.cost.target import FloatArray
from pyrofit.cost.term import Term
from pyrofit.errors import CostError


@dataclass(frozen=True, eq=False)
class WeightedSum:
    """Eq. 5: E = sum of w_i cost_i, over quantities, experiments and kinds of cost.

    Parameters
    ----------
    terms : sequence of (float, Term)
        Weights w_i [-], finite, not negative and not all 0, and costs. A weight of 0 leaves a
        term out, whatever its cost.

    Raises
    ------
    CostError
        No term, or a weight breaks its rule.

    References
    ----------
    Lauer et al., Role of the cost function for material parameter estimation, Eq. 5.

    Examples
    --------
    >>> from pyrofit.cost import Target, make_term
    >>> term = make_term("RMSE", Target([0, 1, 2, 3], [2, 2, 2, 2]))
    >>> both = WeightedSum([(1.0, term), (0.5, term)])
    >>> models = np.full(4, 3.0), np.full(4, 2.0)
    >>> both.value(models), both.value(models[::-1])
    (1.0, 0.5)
    """

    terms: Sequence[tuple[float, Term]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "terms", tuple(self.terms))
        for weight, term in self.terms:
            if not (math.isfinite(weight) and weight >= 0.0):
                raise CostError(
                    f"weight {weight} of {term.kind}: a weight must be finite and not negative. "
                    "Correct it, or leave the term out."
                )
        if not any(weight > 0.0 for weight, _ in self.terms):
            raise CostError("no term has a weight above 0; give at least one.")

    def value(self, models: Sequence[FloatArray]) -> float:
        """Eq. 5: the sum E of the weighted costs.

        Parameters
        ----------
        models : sequence of arrays
            One model for each term, at its target's times.

        Returns
        -------
        float
            E, infinite if a term with a weight is.

        Raises
        ------
        CostError
            The number of models differs from that of terms, or a model has a wrong shape.
        """
        return math.fsum(self.parts(models))

    def parts(self, models: Sequence[FloatArray]) -> list[float]:
        """Give the weighted costs w_i cost_i, whose sum is E.

        Parameters, errors: as `value`.
        """
        self._check_count(models)
        return [
            weight * term(model) if weight > 0.0 else 0.0
            for (weight, term), model in zip(self.terms, models, strict=True)
        ]

    def residuals(self, models: Sequence[FloatArray]) -> FloatArray:
        """Give residuals for a least-squares optimiser.

        One term with a weight above 0: w residuals, whose norm is E. More: sqrt(w_i) residuals_i
        one after the other. E is then a sum of norms, not of squares, and no residuals have it as
        their norm. The sum of squares is the sum of w_i cost_i^2. It has the same zero, but in
        general another minimum than E.

        Parameters, errors: as `value`.
        """
        self._check_count(models)
        active = [
            (weight, term.residuals(model))
            for (weight, term), model in zip(self.terms, models, strict=True)
            if weight > 0.0
        ]
        if len(active) == 1:
            weight, residuals = active[0]
            return weight * residuals
        return np.concatenate([math.sqrt(weight) * residuals for weight, residuals in active])

    def _check_count(self, models: Sequence[FloatArray]) -> None:
        if len(models) != len(self.terms):
            raise CostError(
                f"given {len(models)} models for {len(self.terms)} terms; give one for each."
            )
