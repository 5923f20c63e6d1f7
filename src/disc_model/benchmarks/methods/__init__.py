"""Other methods behind one interface, each as a competent user would write it; see `base` for the contract.

    >>> from disc_model.benchmarks.registry import METHODS
    >>> METHODS["RK4"].solve(problem, 1e-5)

They share the physics (`kernels`), not the engine.  heyoka and SUNDIALS come with the extra `bench`; without them their
`solve` raises `MethodUnavailable`. The methods and their settings are listed in ``benchmarks/rivals.toml``.
"""

from disc_model.benchmarks.methods.base import MethodResult, Problem, RunStatus

__all__ = ["MethodResult", "Problem", "RunStatus"]
