"""Evenly spaced values, of axes and of options, and rules: between the keys of a part of a file, and of a point."""

import ast
import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from itertools import chain
from types import CodeType
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from disc_model.parameters import DEFAULTS, with_ratios
from disc_model.units import Count, Finite, Positive, Strict, number

Value = float | int | str
Blocks = tuple[tuple[Value, ...], ...]
MOST = 100_000
"""Greatest number of values along one axis; a slip of the pen can ask for more than fit into memory."""
Rules = tuple[tuple[Callable[[Any], bool], str], ...]


class Ruled(Strict):
    """A part of a file with conditions between its fields.

    _rules : conditions, each with its message, which may show values of the part
    """

    _rules: ClassVar[Rules] = ()

    @model_validator(mode="after")
    def _keep_rules(self) -> Self:
        for holds, stated in self._rules:
            if not holds(self):
                raise ValueError(stated.format(self))
        return self


class Range(Ruled):
    """Evenly spaced values from `start` to `stop`, both included: `count` of them, or one each `step`.

    On a logarithmic scale the ratio of neighbours is constant.
    """

    start: Finite
    stop: Finite
    count: Annotated[Count, Field(ge=2)] | None = None
    step: Positive | None = None
    scale: Literal["linear", "log"] = "linear"

    _rules = (
        (lambda r: r.start < r.stop, "start={0.start:g} must be < stop={0.stop:g}"),
        (lambda r: math.isfinite(r.stop - r.start), "stop - start must be finite"),
        (lambda r: (r.count is None) != (r.step is None), "must give either count or step"),
        (
            lambda r: r.scale == "linear" or (r.count and r.start > 0),
            "a logarithmic range must give count, and start > 0",
        ),
        (lambda r: r._steps < MOST, f"must be at most {MOST} values"),
        (
            lambda r: abs(r._steps - r.intervals) <= 1e-9 * r._steps,
            "stop - start must be a multiple of step={0.step:g}",
        ),
    )

    @property
    def _steps(self) -> float:
        return (self.stop - self.start) / self.step if self.step else float((self.count or 2) - 1)

    @property
    def intervals(self) -> int:
        """Number of intervals: one less than the number of values."""
        return round(self._steps)

    @property
    def values(self) -> list[float]:
        """All values, in ascending order."""
        return [float(value) for value in self.blocks()[0]]

    def blocks(self, resolution: int = 1) -> Blocks:
        """The range's own values, then those that divide each interval further.

        A finer grid adds blocks and keeps the existing ones: resolution 4 has the blocks of 2, and one more.
        """
        n = self.intervals * resolution
        if n >= MOST:
            raise ValueError(f"must be at most {MOST} values, and not {n + 1}")
        by_level: dict[int, list[Value]] = {}
        for i in range(n + 1):
            # the lowest resolution at which this value is there
            level = resolution // math.gcd(i, resolution)
            by_level.setdefault(level, []).append(self._at(i / n))
        if len({*chain(*by_level.values())}) <= n:
            raise ValueError(f"must be {n + 1} values that differ in their first 12 digits")
        return tuple(tuple(by_level[level]) for level in sorted(by_level))

    def _at(self, share: float) -> float:
        """The value at a fraction of the range, rounded to 12 digits, so that ranges and lists agree on 0.3."""
        if share in (0.0, 1.0):
            return self.stop if share else self.start
        if self.scale == "log":
            return float(f"{self.start * (self.stop / self.start) ** share:.12g}")
        return float(f"{self.start + share * (self.stop - self.start):.12g}")


# ----------------------------------------------------------------------------------------------------
# Rules between the values of a point, such as ``mu_k <= mu_s``, that exclude points of a grid

_MADE_OF = (
    *(ast.Name, ast.Load, ast.Constant, ast.BinOp, ast.UnaryOp, ast.Compare, ast.BoolOp),
    *(ast.Add, ast.Sub, ast.Mult, ast.Div, ast.USub, ast.And, ast.Or),
    *(ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq),
)


def checked_rule(rule: str) -> str:
    """The text if it is a rule such as ``mu_k <= mu_s`` or ``0.5 < a/b < 0.8``, otherwise raises ValueError."""
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
    floats = {name: float(x) if isinstance(x, int) else x for name, x in (DEFAULTS | with_ratios(values)).items()}
    try:
        return all(eval(_compiled(rule), {"__builtins__": {}}, floats) for rule in rules)
    except (ArithmeticError, TypeError):
        return False
