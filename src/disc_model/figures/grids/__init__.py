"""Figures of grid studies, one module per kind."""
