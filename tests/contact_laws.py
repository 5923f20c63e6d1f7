"""The laws of contact beside the paper's, as tests name them."""

from __future__ import annotations

from typing import Any

import pytest

from tests.references import taylor

LAWS: dict[str, dict[str, Any]] = {
    "compliant": {"contact_compliance": taylor.COMPLIANCE},
    "normal": {"contact_force": "normal"},
    "compliant_normal": {"contact_compliance": taylor.COMPLIANCE, "contact_force": "normal"},
}

# Kernels of each law take minutes to compile: the quick tests try the law that has both, the long ones all.
EACH_LAW = [pytest.param(name, marks=() if name == "compliant_normal" else pytest.mark.slow, id=name) for name in LAWS]
