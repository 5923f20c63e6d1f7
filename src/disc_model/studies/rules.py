"""Rules between the values of a point, such as ``mu_k <= mu_s``, by which a study file leaves out points of a grid."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from functools import cache
from types import CodeType
from typing import Any

from disc_model.parameters import Parameters

_OPERATORS = (ast.operator, ast.cmpop, ast.boolop, ast.unaryop, ast.Load)
_FORBIDDEN = (ast.Pow, ast.LShift, ast.MatMult, ast.Is, ast.IsNot, ast.In, ast.NotIn)
_DEFAULTS = {name: field.default for name, field in Parameters.model_fields.items()}
LONGEST = 500
"""Of a rule, in characters."""


@cache
def names_in(rule: str) -> frozenset[str]:
    """Names that a rule such as ``mu_k <= mu_s`` or ``0.5 < a/b < 0.8`` compares; raises ValueError if it is none."""
    said = "must compare values, such as mu_k <= mu_s"
    try:
        tree = ast.parse(rule.strip()[: LONGEST + 1], mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ValueError(said) from None
    if len(rule) > LONGEST or not isinstance(tree.body, ast.Compare | ast.BoolOp):
        raise ValueError(said)
    for node in ast.walk(tree.body):
        value = isinstance(node, ast.Constant) and type(node.value) in (int, float, str)
        made_of = (ast.Name, ast.BinOp, ast.UnaryOp, ast.Compare, ast.BoolOp, *_OPERATORS)
        if not (value or isinstance(node, made_of)) or isinstance(node, _FORBIDDEN):
            raise ValueError(said)
    return frozenset(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))


@cache
def _compiled(rule: str) -> CodeType:
    names_in(rule)  # nothing else than comparisons is run
    return compile(rule.strip(), "where", "eval")


def holds(rules: Sequence[str], values: Mapping[str, Any]) -> bool:
    """Whether all rules hold for a point; one that cannot be evaluated, such as a division by zero, does not."""
    here = {**_DEFAULTS, **values}
    try:
        return all(eval(_compiled(rule), {"__builtins__": {}}, here) for rule in rules)
    except (ArithmeticError, TypeError):
        return False
