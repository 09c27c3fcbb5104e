"""Expressions: arithmetic on the values of parameters, and nothing else."""

import ast
import math
import operator
from collections.abc import Callable, Mapping

from pyrofit.errors import suggest

FUNCTIONS: dict[str, Callable[..., float]] = {
    "abs": abs,
    "exp": math.exp,
    "log": math.log,
    "log10": math.log10,
    "max": max,
    "min": min,
    "sqrt": math.sqrt,
}
OF_SEVERAL = ("max", "min")
"""Functions of two numbers or more; all others take one."""
_OPERATORS: dict[type, Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: math.pow,  # not that of Python, whose root of a negative number is complex
}
_ARITHMETIC = (
    *(ast.Expression, ast.BinOp, ast.UnaryOp, ast.Constant, ast.Name, ast.Call, ast.Load),
    *(ast.UAdd, ast.USub),
)


def names_of(expression: str) -> set[str]:
    """Return the names of the parameters in an expression.

    Raises
    ------
    ValueError
        It is more than arithmetic, or calls a function that is unknown or takes other numbers.

    Examples
    --------
    >>> sorted(names_of("1e-3 * exp(E / (8.314 * T))"))
    ['E', 'T']
    """
    try:
        tree = ast.parse(expression.strip(), mode="eval")
    except (SyntaxError, ValueError):
        raise ValueError(f"'{expression}' is no expression; correct it") from None
    called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    found = set()
    for node in ast.walk(tree):
        _check(node, expression)
        if isinstance(node, ast.Name) and id(node) not in called:
            found.add(node.id)
    return found


def _check(node: ast.AST, expression: str) -> None:
    """Refuse all but arithmetic."""
    if isinstance(node, ast.Call):
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in FUNCTIONS or node.keywords or not node.args:
            raise ValueError(
                f"'{expression}': unknown function '{ast.unparse(node.func)}'. "
                + suggest(name, FUNCTIONS)
            )
        if (len(node.args) > 1) != (name in OF_SEVERAL):
            takes = "two numbers or more" if name in OF_SEVERAL else "one number"
            raise ValueError(f"'{expression}': {name} takes {takes}; correct it")
    number = not isinstance(node, ast.Constant) or type(node.value) in (int, float)
    if not (isinstance(node, (*_ARITHMETIC, *_OPERATORS)) and number):
        raise ValueError(
            f"'{expression}': only numbers, parameters, + - * / ** and "
            f"{', '.join(FUNCTIONS)} are allowed"
        )


def value_of_expression(expression: str, values: Mapping[str, float]) -> float:
    """Return the value of an expression; NaN if it has none.

    Parameters
    ----------
    expression
        Arithmetic, checked by `names_of`.
    values
        Values of the parameters by name.

    Examples
    --------
    >>> value_of_expression("T - 273.15", {"T": 300.0})
    26.850000000000023
    """
    try:
        return _value(ast.parse(expression.strip(), mode="eval").body, values)
    except (ArithmeticError, ValueError):
        return math.nan


def _value(node: ast.expr, values: Mapping[str, float]) -> float:
    if isinstance(node, ast.Constant):
        assert isinstance(node.value, (int, float))
        return float(node.value)
    if isinstance(node, ast.Name):
        return values[node.id]
    if isinstance(node, ast.UnaryOp):
        value = _value(node.operand, values)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.BinOp):
        return _OPERATORS[type(node.op)](_value(node.left, values), _value(node.right, values))
    assert isinstance(node, ast.Call)
    assert isinstance(node.func, ast.Name)
    return FUNCTIONS[node.func.id](*(_value(argument, values) for argument in node.args))
