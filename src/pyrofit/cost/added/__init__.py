"""Costs of a user's own, from the folders that a study names under ``plugins``.

The package has none here. A file defines the function ``cost``; its name is the cost's name. Other
packages add costs by entry points of the group ``pyrofit.costs``.
"""

from collections.abc import Callable
from functools import cache
from types import FunctionType

from pyrofit.cost.target import Residuals
from pyrofit.discovery import catalogue


def added_costs() -> dict[str, Callable[..., Residuals]]:
    """Return the user's own costs by name, sorted."""
    return _costs_in(tuple(__path__))


@cache
def _costs_in(folders: tuple[str, ...]) -> dict[str, Callable[..., Residuals]]:
    return catalogue(__name__, folders, "cost", "costs", FunctionType)
