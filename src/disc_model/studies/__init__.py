"""From a configuration to datasets: what is to be computed, in which batches, and how their files are merged.

What a study file may say is `document`, what it amounts to `study`. A *case* is one named simulation with its records;
a *grid study* asks for quantities (`grids.quantities`) at every point of a parameter grid, in batches that only change
if their points do.
"""
