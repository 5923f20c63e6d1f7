"""Grids of parameters: their batches of points, the merged dataset and its figures."""
