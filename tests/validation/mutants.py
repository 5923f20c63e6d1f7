"""Wrong signs, factors and comparisons in the functions that hold the equations, one at a time.

What is changed is read from the syntax tree, so that no formatting and no new term needs attention here:

    a + b, a - b, a += b, a -= b    the other sign; of a vector operation, the sign of its last argument
    -a                              a
    a**b                            a
    2.0 in a sum or product         4.0 (any float)
    a < b, a == b, ...              the opposite

Left alone are elements' numbers, messages of errors, and sizes (sums of moduli, by which rounding is judged).
`FUNCTIONS` says which functions; `EQUIVALENT` lists, each with its reason, the changes that make no difference.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import disc_model

PACKAGE = Path(disc_model.__file__).parent
FUNCTIONS = {
    "engine/layout.py": ("build_model", "on_ramp", "drive_angle", "build_state"),
    "engine/dense_output.py": ("state_at",),
    "engine/stepping.py": ("set_course",),
    "engine/sampling.py": ("point_motion", "_write_row"),
    "engine/audit.py": ("transverse_energy", "inplane_energy", "_powers_in", "audit_impact"),
    "engine/series.py": (
        *("_disc_point", "_inner_terms", "_pending", "_order", "_order_zero", "_axisymmetric"),
        *("_first_order", "_last_force"),
        *("slip_series", "_stick_order", "stick_series", "separation_series"),
    ),
    "engine/contact_series.py": (
        *("_deflection", "_slope", "_disc_velocity", "_closing", "_spring", "_weight", "_leverage", "_move_slider"),
        *("compliant_slip_series", "compliant_stick_series", "release_series", "normal_slip_series"),
    ),
    "engine/coasting.py": ("coast_length", "coast_to", "_times"),
    "engine/stick_modes.py": ("_eigenmodes", "_compliant_eigenmodes", "_decomposed", "_under_unit_load", "_packed"),
    "engine/laws.py": (
        *("spring_force", "free_force", "stick_numerator", "vertical_in_stick", "slip_denominator", "slip_numerator"),
        *("slip_rates", "grip", "impact"),
    ),
    "engine/switches.py": (
        *("disc_point", "_free_acceleration", "_deflection_size", "_rounding", "force_in_stick"),
        *("slip_force", "impact", "switch_function"),
    ),
    "flexibility.py": (
        *("residual_flexibility", "harmonic_flexibility", "_point_load", "_moment", "_shear", "_power"),
        *("_high_harmonics", "_axisymmetric", "_first", "_logarithmic", "_with_edges"),
    ),
    "engine/saltation.py": (
        *("rates", "_free_change", "_put_changes", "_change", "_set_derivative", "switch_gradient"),
        *("switch_change", "switch_times", "shift", "impact_change"),
    ),
    "engine/tangent.py": (
        *("_convolve", "_motion_slope", "point_change", "_diametral_rates", "_axisymmetric_rates"),
        *("_slider_forces", "_path_change", "_apply_force", "tangent_series"),
    ),
    "engine/variational.py": ("section_map",),
    "simulation/ramps.py": ("Piece.at", "pieces", "_line", "_at"),
    "simulation/result.py": ("read_state",),
    "stability/return_map.py": ("parameter_change", "ReturnMap.state", "ReturnMap.contact_force"),
    "stability/sliding.py": ("steady_sliding", "_equilibrium", "_jacobian"),
    "benchmarks/methods/physics.py": (
        *("Physics.__init__", "Physics.disc_point", "Physics._pull", "Physics._contact", "Physics.rate"),
    ),
    "benchmarks/methods/kernels.py": (
        *("contact", "rate", "rk4_step", "switch_values", "violated", "switch"),
        *("smooth_friction", "smooth_force", "smooth_rate"),
    ),
    "benchmarks/methods/taylor_heyoka.py": ("_system",),
    "benchmarks/scenes.py": ("static_start",),
    "plate.py": ("_modes", "_columns", "_coupling", "coupled_frequencies", "modal_damping"),
}
#: By the name of a mutant (as `Mutant` prints it): why it makes no difference.
EQUIVALENT: dict[str, str] = {
    "engine/audit.py:_powers_in: + lost -> -": "a size, without abs() as it is never negative",
    "engine/audit.py:_powers_in: + damped -> -": "a size, without abs() as it is never negative",
    "engine/stick_modes.py:_compliant_eigenmodes: + k -> -": "the scale of u is free",
    "engine/stick_modes.py:_compliant_eigenmodes: 1.0 -> 2.0": "the scale of u is free",
    "engine/switches.py:_rounding: + i.m * size -> -": "a size, without abs() as it is never negative",
    "engine/stepping.py:set_course: + x[TIME_LOW] -> -": "of Omega and N a rounding of the clock, 1e-17 of the time",
    "stability/sliding.py:_jacobian: + p.m * weight * (2 * l * beta - 2 * l ** 2 * p.Omega * a) -> -": (
        "zero at the equilibrium, where beta = l Omega a"
    ),
    "engine/stick_modes.py:_decomposed: -1e-15 -> +1e-15": "rounding of an undamped mode: 0 either way",
}

VECTOR_OPERATIONS = ("fma", "mul", "add", "sub")
STORAGE = ("load", "store", "spread")
NUMBERS_OF_ELEMENTS = ("range", "len")
OTHER = {ast.Add: ast.Sub, ast.Sub: ast.Add}
OPPOSITE = {
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
}


class Mutant(NamedTuple):
    """One change: the ``place``-th of a function, in the order of the syntax tree."""

    file: str
    function: str
    place: int
    change: str

    def __str__(self) -> str:
        return f"{self.file}:{self.function}: {self.change}"

    def source(self, package: Path = PACKAGE) -> str:
        """The file's text with the change in it."""
        tree = ast.parse((package / self.file).read_text(encoding="utf-8"))
        node = list(changeable(find(tree, self.file, self.function)))[self.place]
        assert flip(node), self
        return ast.unparse(tree) + "\n"


def all_mutants() -> list[Mutant]:
    """Every change of every function, the equivalent ones too."""
    return [
        mutant for file, functions in FUNCTIONS.items() for function in functions for mutant in mutants(file, function)
    ]


def mutants(file: str, function: str) -> Iterator[Mutant]:
    """The changes of a function; equal ones are numbered."""
    tree = ast.parse((PACKAGE / file).read_text(encoding="utf-8"))
    seen: Counter[str] = Counter()
    for place, node in enumerate(list(changeable(find(tree, file, function)))):
        change = flip(node)
        seen[change] += 1
        yield Mutant(file, function, place, change + (f" ({seen[change]})" if seen[change] > 1 else ""))


def find(tree: ast.Module, file: str, function: str) -> ast.FunctionDef:
    """A function, or a method given as Class.method."""
    node: ast.AST = tree
    for name in function.split("."):
        body = getattr(node, "body", [])
        found = [child for child in body if getattr(child, "name", None) == name]
        assert len(found) == 1, f"{file} has no function {function}: bring tests/validation/mutants.py up to date"
        node = found[0]
    assert isinstance(node, ast.FunctionDef)
    return node


def changeable(function: ast.FunctionDef) -> Iterator[ast.AST]:
    """Where a function can be changed."""
    for statement in function.body:
        yield from _changeable(statement)


def _changeable(node: ast.AST) -> Iterator[ast.AST]:
    if isinstance(node, ast.Raise | ast.JoinedStr):
        return
    if isinstance(node, ast.Subscript):  # what is taken, not from where
        yield from _changeable(node.value)
        return
    called = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
    if called in NUMBERS_OF_ELEMENTS:
        return
    if (called in VECTOR_OPERATIONS and not _is_size(node)) or _is_changeable(node):
        yield node
    if isinstance(node, ast.BinOp):
        yield from (side for side in (node.left, node.right) if _is_factor(side))
    for child in ast.iter_child_nodes(node):
        if not (called in STORAGE or called.startswith("_")) or not _is_index(child):
            yield from _changeable(child)


def _is_changeable(node: ast.AST) -> bool:
    match node:
        case ast.BinOp(op=ast.Add() | ast.Sub(), right=other) | ast.AugAssign(op=ast.Add() | ast.Sub(), value=other):
            return not _is_size(other)
        case ast.BinOp(op=ast.Pow()):
            return True
        case ast.UnaryOp(op=ast.USub()):
            return True
        case ast.Compare():
            return type(node.ops[0]) in OPPOSITE
    return False


def _is_factor(side: ast.AST) -> bool:
    return isinstance(side, ast.Constant) and isinstance(side.value, float) and side.value != 0.0


def _is_size(term: ast.AST) -> bool:
    return any(
        isinstance(part, ast.Call) and getattr(part.func, "id", "") in ("abs", "absolute") for part in ast.walk(term)
    )


def _is_index(argument: ast.AST) -> bool:
    """Whether an argument is made of bare names and whole numbers."""
    return isinstance(argument, ast.BinOp) and all(
        isinstance(part, ast.BinOp | ast.operator | ast.Name | ast.expr_context)
        or (isinstance(part, ast.Constant) and isinstance(part.value, int))
        for part in ast.walk(argument)
    )


def flip(node: ast.AST) -> str:
    """Change a node in place; says what is changed, in a line."""
    before = ast.unparse(node)
    match node:
        case ast.BinOp(op=ast.Pow()):
            node.right = ast.Constant(1)
            return f"{before} -> {ast.unparse(node.left)}"
        case ast.BinOp(right=other) | ast.AugAssign(value=other):
            sign, opposite = ("+", "-") if isinstance(node.op, ast.Add) else ("-", "+")
            node.op = OTHER[type(node.op)]()
            return f"{sign} {ast.unparse(other)} -> {opposite}"
        case ast.UnaryOp():
            node.op = ast.UAdd()
        case ast.Compare():
            node.ops[0] = OPPOSITE[type(node.ops[0])]()
        case ast.Constant():
            node.value = 2 * node.value
        case ast.Call(func=function, args=[*_, last]):
            node.args[-1] = ast.UnaryOp(ast.USub(), last)
            return f"{ast.unparse(function)}(..., {ast.unparse(last)}) -> -"
    return f"{before} -> {ast.unparse(node)}"
