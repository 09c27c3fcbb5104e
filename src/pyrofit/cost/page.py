"""The costs as a page of the documentation."""

from collections.abc import Callable
from inspect import Parameter, getdoc, signature
from typing import Any

from pyrofit.cost.kinds import KINDS
from pyrofit.cost.normalisation import NORMALISATIONS

_HEAD = """\
# Costs

A term of a cost function compares one simulated curve with its target. A study names the `kind` of
the term and its options. The equations are those of Lauer et al., *Role of the cost function for
material parameter estimation*. [Adding a cost](adding.md#a-cost) takes one file.
[Which of them to use](which_cost.md) was tested on twins and measured data.

- `y` is the measured curve, `model` the simulated one at the same times. `y_lb` and `y_ub` are the
  limits of the band.
- `y_N` is the normalisation, one of {normalisations}: 1, the range, the mean, or the
  interquartile range of `y`.
- The band is `lower` to `upper`, columns of the file. Or it is `y` with `n_sigma` stated standard
  deviations on each side, smoothed over `smooth_s`.
- `THR` is a threshold, not the total heat release. `t0` is `time_s`, and `y(t0)` the measured value
  at that time.
- PROPTI is the program with which the paper computed its costs.

This page is generated: `pyrofit reference --of costs > docs/costs.md`.

| kind | options and usual values | cost |
|---|---|---|
"""


def costs_page() -> str:
    """Return the page: every cost with its options and the first line of its function."""
    names = ", ".join(f"`{name}`" for name in NORMALISATIONS)
    rows = [f"| `{kind}` | {_options(cost)} | {_first(cost)} |\n" for kind, cost in KINDS.items()]
    return "".join([_HEAD.format(normalisations=names), *rows])


def _options(cost: Callable[..., Any]) -> str:
    """Return the keyword arguments of a cost with their defaults, as a study writes them."""
    given = signature(cost).parameters.values()
    return ", ".join(_option(p) for p in given if p.kind is Parameter.KEYWORD_ONLY)


def _option(option: Parameter) -> str:
    if option.default is Parameter.empty:
        return f"`{option.name}` (required)"
    if option.default is None:
        return f"`{option.name}`"
    return f"`{option.name}: {option.default}`"


def _first(cost: Callable[..., Any]) -> str:
    """Return the first line of a docstring, with the signs of a table escaped."""
    return (getdoc(cost) or "").partition("\n")[0].replace("|", "\\|").replace("*", "\\*")
