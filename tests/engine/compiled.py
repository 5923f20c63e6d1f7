"""Kernels of tests are never cached: numba would not notice that the engine they call has changed."""

import numba

from disc_model.engine.jit import RULES

kernel = numba.njit(**(RULES | {"cache": False}))
