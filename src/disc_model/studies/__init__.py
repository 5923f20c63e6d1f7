"""Studies: which results are computed, in which batches, and how the files of the batches are merged.

A *case* is one named simulation with its records. A *grid study* computes a quantity at every point of a grid.
"""
