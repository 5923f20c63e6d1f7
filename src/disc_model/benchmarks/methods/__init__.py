"""Other methods behind one interface, each as a competent user would write it; see `base` for the contract.

    >>> from disc_model.benchmarks.methods import METHODS
    >>> METHODS["RK4"].solve(problem, 1e-5)

They share the physics (`kernels`), not the engine.  heyoka and SUNDIALS come with the extra `bench`; without them their
`unavailable()` gives the reason and `solve` raises `MethodUnavailable`. The methods and their settings are
listed in ``benchmarks/rivals.toml``.
"""

from importlib import import_module

from disc_model.benchmarks.methods.base import Method, MethodResult, MethodUnavailable, Problem, RunStatus
from disc_model.benchmarks.registry import RIVALS, Rival


def _made(rival: Rival) -> Method:
    module, _, name = rival.place.partition(":")
    method: Method = getattr(import_module(f"{__name__}.{module}"), name)(*rival.arguments)
    vars(method).update(rival.model_dump(exclude={"place", "arguments", "maps"}, exclude_unset=True))
    return method


METHODS: dict[str, Method] = {rival.name: _made(rival) for rival in RIVALS}

__all__ = ["METHODS", "Method", "MethodResult", "MethodUnavailable", "Problem", "RunStatus"]
