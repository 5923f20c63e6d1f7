"""Figures: pure functions from results to matplotlib figures; they never run a simulation."""

from pathlib import Path

STYLE = Path(__file__).with_name("disc_model.mplstyle")
"""The one style of all figures."""
