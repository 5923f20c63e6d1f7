"""Figures of single runs: time histories, phase portraits, Poincaré sections and spectra."""
