"""The laws of contact as functions of Python, which need no compilation for complex arrays."""

from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any

from disc_model.engine import laws


def _in_python(module: ModuleType) -> Any:
    """Return what a module has, with its compiled functions as functions of Python."""
    names = dict(vars(module))
    for name, law in vars(module).items():
        if hasattr(law, "py_func"):
            names[name] = FunctionType(law.py_func.__code__, names)
    return SimpleNamespace(**names)


LAWS = _in_python(laws)
"""What `disc_model.engine.laws` has."""
