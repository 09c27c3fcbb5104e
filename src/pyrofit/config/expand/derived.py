"""Parameters that are held at a value, and those that are expressions of others."""

import ast
from collections.abc import Mapping
from typing import Any

from pyrofit.config.keys.study import Study
from pyrofit.errors import suggest
from pyrofit.model.base import replaced
from pyrofit.model.expressions import names_of
from pyrofit.model.parameters import Parameter

_STAGES = ("kinetics", "imp", "diagnosis")


def hold_fixed(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return a description in which parameters with the key ``fixed`` have that value alone.

    >>> one = {"parameters": {"k": {"unit": "-", "lower": 1, "upper": 3, "fixed": 2}}}
    >>> held = hold_fixed(one | {"imp": {"estimate": ["k", "c"]}})
    >>> held["parameters"]["k"], held["imp"]["estimate"]
    ({'unit': '-', 'fixed': 2, 'value': 2}, ['c'])
    """
    parameters = given.get("parameters")
    if not isinstance(parameters, Mapping):
        return dict(given)
    held = {
        name: p
        for name, p in parameters.items()
        if isinstance(p, Mapping) and isinstance(p.get("fixed"), int | float)
    }
    if not held:
        return dict(given)
    for name, p in held.items():
        ends = p.get("lower"), p.get("upper")
        if (
            all(isinstance(end, int | float) for end in ends)
            and not ends[0] <= p["fixed"] <= ends[1]
        ):
            raise ValueError(
                f"parameters.{name}.fixed: {p['fixed']} lies outside the limits {ends[0]:g} to "
                f"{ends[1]:g}; correct it or delete the limits"
            )
    alone = {
        name: {k: v for k, v in p.items() if k not in ("lower", "upper")} | {"value": p["fixed"]}
        for name, p in held.items()
    }
    new = {**given, "parameters": {**parameters, **alone}}
    if isinstance(known := given.get("known"), Mapping):
        new["known"] = {name: value for name, value in known.items() if name not in held}
    for stage in _STAGES:
        of_stage = given.get(stage)
        listed = of_stage.get("estimate") if isinstance(of_stage, Mapping) else None
        if isinstance(of_stage, Mapping) and isinstance(listed, list | tuple):
            new[stage] = {**of_stage, "estimate": [name for name in listed if name not in held]}
    return new


def with_expressions(study: Study) -> Study:
    """Return a study in which the expressions stand in the places of their parameters, in SI units.

    Raises
    ------
    ValueError
        An expression names an unknown parameter, or leads back to itself.
    """
    texts = {n: p.expression for n, p in study.parameters.items() if p.expression is not None}
    if not texts:
        return study
    for name, text in texts.items():
        for other in sorted(names_of(text)):
            if other not in study.parameters:
                raise ValueError(
                    f"parameters.{name}.expression: unknown parameter '{other}'. "
                    + suggest(other, study.parameters)
                )
    in_si = {
        name: ast.unparse(_times(_inlined(study.parameters, name, ()), study.parameters[name]))
        for name in texts
    }
    return replaced(study, lambda name: in_si.get(name, name))


def _inlined(parameters: Mapping[str, Parameter], name: str, path: tuple[str, ...]) -> ast.expr:
    """Return the expression of a parameter, in its unit, of parameters in SI units."""
    if name in path:
        way = " -> ".join((*path[path.index(name) :], name))
        raise ValueError(f"parameters.{name}.expression: it leads back to itself: {way}")
    text = parameters[name].expression
    assert text is not None
    tree = ast.parse(text.strip(), mode="eval").body
    inlined: ast.expr = _Inline(parameters, (*path, name)).visit(tree)
    return inlined


class _Inline(ast.NodeTransformer):
    def __init__(self, parameters: Mapping[str, Parameter], path: tuple[str, ...]) -> None:
        self._parameters = parameters
        self._path = path

    def visit_Call(self, node: ast.Call) -> ast.expr:
        arguments = [self.visit(argument) for argument in node.args]
        return ast.Call(func=node.func, args=arguments, keywords=[])

    def visit_Name(self, node: ast.Name) -> ast.expr:
        of = self._parameters[node.id]
        if of.expression is not None:
            return _inlined(self._parameters, node.id, self._path)
        return node if of.factor == 1.0 else ast.BinOp(node, ast.Div(), ast.Constant(of.factor))


def _times(node: ast.expr, parameter: Parameter) -> ast.expr:
    if parameter.factor == 1.0:
        return node
    return ast.BinOp(node, ast.Mult(), ast.Constant(parameter.factor))
