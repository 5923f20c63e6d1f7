"""Numbers packed for JSON: few bits of each, deflated, as text."""

import base64
import zlib

import numpy as np

MANTISSA = 23  # bits of the mantissa of a 32-bit float,
BITS = 17  # and those that are kept: five digits, as many as are shown


def packed(values: np.ndarray, kind: str) -> str:
    """An array, last dimension fastest, as base64: first bytes of all numbers, then second ones and
    so on, deflated."""
    numbers = np.ascontiguousarray(values, dtype=kind).reshape(-1)
    planes = numbers.view(np.uint8).reshape(-1, numbers.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode("ascii")


def shortened(values: np.ndarray) -> np.ndarray:
    """Numbers rounded to `BITS` bits of their mantissa; the other bits are zero, which compresses
    well."""
    whole = np.array(values, dtype=np.float32)
    bits = whole.view(np.uint32)
    shift = np.uint32(MANTISSA - BITS)
    half = np.uint32(1 << (shift - 1))
    rounded = (bits + half) >> shift << shift
    return np.where(np.isfinite(whole), rounded.view(np.float32), whole)
