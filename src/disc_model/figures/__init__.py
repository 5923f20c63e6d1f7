"""Figures: pure functions from results to matplotlib figures; they never run a simulation."""
