"""Quantities that a grid study can compute at each point, one module each; see `Quantity` of `grids.run`."""
