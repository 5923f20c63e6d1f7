"""Studies: which results are computed, in which batches, and how the files of the batches are merged.

`document` defines the keys of a study file, and `study` derives the cases and grids from it. A *case* is one named
simulation with its records. A *grid study* computes quantities (`grids.quantities`) at every point of a parameter grid.
A batch changes only if its points do.
"""
