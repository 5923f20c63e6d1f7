"""Numbers packed for JSON: deflated, as text."""

import base64
import zlib

import numpy as np


def packed(values: np.ndarray, kind: str) -> str:
    """An array, last dimension fastest, as base64: first bytes of all numbers, then second ones and
    so on, deflated."""
    numbers = np.ascontiguousarray(values, dtype=kind).reshape(-1)
    planes = numbers.view(np.uint8).reshape(-1, numbers.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode("ascii")
