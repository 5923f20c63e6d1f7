"""Tests of everything; what they share is in `conftest.py`."""

import os

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables by which linear algebra is told its number of threads when it is loaded."""

# Matrices are small here: two threads take up to a hundred times the processor time of one, waiting
# for each other.
for _name in THREADS:
    os.environ.setdefault(_name, "1")
