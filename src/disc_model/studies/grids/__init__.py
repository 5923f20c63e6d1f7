"""Grids of parameters: what a file says of them, batches of points, one dataset, figures."""
