"""Rules between the values of a point, such as ``mu_k <= mu_s``, that exclude points of a grid."""

import ast
from collections.abc import Mapping, Sequence
from functools import cache
from types import CodeType
from typing import Any

from disc_model.parameters import Parameters, with_ratios
from disc_model.units import number

_MADE_OF = (
    *(ast.Name, ast.Load, ast.Constant, ast.BinOp, ast.UnaryOp, ast.Compare, ast.BoolOp),
    *(ast.Add, ast.Sub, ast.Mult, ast.Div, ast.USub, ast.And, ast.Or),
    *(ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq),
)
_DEFAULTS = {name: field.default for name, field in Parameters.model_fields.items()}
LONGEST = 500
"""Greatest length of a rule, in characters."""


def checked_rule(rule: str) -> str:
    """The text if it is a rule such as ``mu_k <= mu_s`` or ``0.5 < a/b < 0.8``, otherwise raises ValueError."""
    if len(rule) > LONGEST:
        raise ValueError(f"must be at most {LONGEST} characters")
    _compiled(rule)
    return rule


def names_in(rule: str) -> frozenset[str]:
    """Names in a rule."""
    return frozenset(_compiled(rule).co_names)


@cache
def _compiled(rule: str) -> CodeType:
    """A rule of comparisons, with floats only: a whole number could repeat a word without end."""
    try:
        tree = ast.parse(rule.strip(), mode="eval")
        nodes = list(ast.walk(tree.body))
        if not isinstance(tree.body, ast.Compare | ast.BoolOp) or not all(isinstance(node, _MADE_OF) for node in nodes):
            raise ValueError
        for node in nodes:
            if isinstance(node, ast.Constant) and not isinstance(node.value, str):
                node.value = number(node.value)
        return compile(tree, "where", "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError("must compare values in SI, without units, such as mu_k <= mu_s") from None


def holds(rules: Sequence[str], values: Mapping[str, Any]) -> bool:
    """Whether all rules hold at a point; a rule that cannot be evaluated, such as a division by zero, does not."""
    here = {name: float(x) if isinstance(x, int) else x for name, x in {**_DEFAULTS, **with_ratios(values)}.items()}
    try:
        return all(eval(_compiled(rule), {"__builtins__": {}}, here) for rule in rules)
    except (ArithmeticError, TypeError):
        return False
