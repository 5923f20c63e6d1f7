"""Figures: data in readers' units, five ways to draw them, and the figures made of these."""
