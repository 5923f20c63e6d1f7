"""Figures of grid studies, a module a kind."""
