"""The laws of contact beside the paper's, as tests name them; and what of them is left to the long tests."""

from __future__ import annotations

from typing import Any

import numba
import pytest

from tests.references import taylor

LAWS: dict[str, dict[str, Any]] = {
    "compliant": {"contact_compliance": taylor.COMPLIANCE},
    "normal": {"contact_force": "normal"},
    "compliant_normal": {"contact_compliance": taylor.COMPLIANCE, "contact_force": "normal"},
}

COMPILES = () if numba.config.DISABLE_JIT else (pytest.mark.slow,)
"""Marks of what has kernels of its own, which compile for a minute; without compilation it is quick."""

# Kernels of each law take minutes to compile: the quick tests try the law that has both, the long ones all.
EACH_LAW = [pytest.param(name, marks=() if name == "compliant_normal" else pytest.mark.slow, id=name) for name in LAWS]
