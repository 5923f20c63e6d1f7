"""The functions of all methods, by the names that ``rivals.toml`` uses."""

from collections.abc import Callable

from benchmarks.methods.by_cvode import solve_by_cvode
from benchmarks.methods.by_heyoka import solve_by_heyoka
from benchmarks.methods.by_scipy import solve_by_scipy
from benchmarks.methods.integrators import MethodResult
from benchmarks.methods.whole_runs import solve_by_rk4, solve_by_series

SOLVERS: dict[str, Callable[..., MethodResult]] = {
    "solve_by_series": solve_by_series,
    "solve_by_rk4": solve_by_rk4,
    "solve_by_scipy": solve_by_scipy,
    "solve_by_heyoka": solve_by_heyoka,
    "solve_by_cvode": solve_by_cvode,
}
