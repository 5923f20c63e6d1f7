"""From a configuration to datasets: what is to be computed, in which batches, and how their files are merged.

A *case* (`case`, `study`) is one named simulation with its records; a *grid study* (`grid`) asks for quantities
(`quantities`) at every point of a parameter grid, in batches that only change if their points do.
"""
