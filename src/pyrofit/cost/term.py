"""One cost of one target, checked and ready to be called many times."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from inspect import Parameter, signature
from typing import Any

from pyrofit.cost.kinds import known_costs
from pyrofit.cost.target import FloatArray, Residuals, Target
from pyrofit.errors import CostError, suggest
from pyrofit.numerics import linear


@dataclass(frozen=True, eq=False)
class Term:
    """A cost as a function of the model; made by `make_term`.

    Parameters
    ----------
    kind : str
        Name of the cost, of `known_costs`.
    target : Target
        The target; the model is given at its times.
    options : mapping
        The options as given.
    """

    kind: str
    target: Target
    options: Mapping[str, Any]
    _residuals: Residuals = field(repr=False)

    def __call__(self, model: FloatArray) -> float:
        """Give the cost of a model, the norm of its residuals; infinite if it is not finite.

        Parameters
        ----------
        model : array, shape (n,)
            The model at the target's times, in its unit.

        Returns
        -------
        float
            The cost [-, or the unit of the target if it is not normalised].

        Raises
        ------
        CostError
            The model has another shape than the target.
        """
        residuals = self.residuals(model)
        cost = linear.norm(residuals)
        return cost if cost < math.inf else math.inf

    def residuals(self, model: FloatArray) -> FloatArray:
        """Give the residuals, whose norm is the cost.

        Parameters
        ----------
        model : array, shape (n,)
            The model at the target's times, in its unit.

        Returns
        -------
        array, shape (n,) for the costs of Eq. 4, (1,) for those of Eqs 1-3
            Not finite where the model is not.

        Raises
        ------
        CostError
            The model has another shape than the target.
        """
        if model.shape != self.target.value.shape:
            raise CostError(
                f"{self.kind}: the model has shape {model.shape} and the target "
                f"{self.target.value.shape}; give the model at the target's times."
            )
        return self._residuals(model)


def make_term(kind: str, target: Target, **options: Any) -> Term:
    """Prepare a cost for a target: all checks, and all that depends on the target alone.

    Parameters
    ----------
    kind : str
        Name of the cost, of `known_costs`.
    target : Target
        The target, windowed and resampled as wanted.
    **options
        The keyword arguments of the cost's function.

    Returns
    -------
    Term
        To be called with models at the target's times.

    Raises
    ------
    CostError
        The cost or an option is unknown, a needed option is absent, or the options do not fit
        the target.

    Examples
    --------
    >>> import numpy as np
    >>> term = make_term("RMSE", Target([0, 1, 2, 3], [2, 2, 2, 2]), normalisation="mean")
    >>> term(np.array([3.0, 1.0, 3.0, 1.0]))
    0.5
    """
    check_cost_options(kind, options)
    return Term(kind, target, dict(options), known_costs()[kind](target, **options))


def check_cost_options(kind: str, options: Mapping[str, Any]) -> None:
    """Check the names of a cost and its options, which needs no target.

    Raises
    ------
    CostError
        The cost or an option is unknown, or a needed option is absent.
    """
    costs = known_costs()
    if kind not in costs:
        raise CostError(f"unknown cost '{kind}'. {suggest(str(kind), costs)}")
    known = {
        name: parameter
        for name, parameter in signature(costs[kind]).parameters.items()
        if parameter.kind is Parameter.KEYWORD_ONLY
    }
    for name in options:
        if name not in known:
            raise CostError(f"{kind}: unknown option '{name}'. {suggest(name, known)}")
    for name, parameter in known.items():
        if parameter.default is Parameter.empty and name not in options:
            raise CostError(f"{kind}: the option `{name}` is absent; the cost needs it. Give it.")
