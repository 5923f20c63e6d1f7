"""Figures of any named case, by kind."""
