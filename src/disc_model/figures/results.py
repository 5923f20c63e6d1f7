"""Pictures that results draw of themselves, by the names under which they ask for them."""

from disc_model.figures.branch import plot_branch
from disc_model.figures.campbell_picture import plot_campbell
from disc_model.figures.critical import plot_critical
from disc_model.figures.eigenvalues import plot_eigenvalues
from disc_model.figures.exponents import plot_exponents
from disc_model.figures.film import animate, film_writer
from disc_model.figures.history import plot_run
from disc_model.figures.modes import plot_modes
from disc_model.figures.multipliers import plot_multipliers
from disc_model.figures.neutral_curves import plot_neutral_curves
from disc_model.figures.poincare import plot_poincare
from disc_model.figures.portrait import plot_phase_portrait
from disc_model.figures.runs import window_of
from disc_model.figures.spectrum import plot_spectrum
from disc_model.figures.sweep import plot_sweep

__all__ = [
    "animate",
    "film_writer",
    "plot_branch",
    "plot_campbell",
    "plot_critical",
    "plot_eigenvalues",
    "plot_exponents",
    "plot_modes",
    "plot_multipliers",
    "plot_neutral_curves",
    "plot_phase_portrait",
    "plot_poincare",
    "plot_run",
    "plot_spectrum",
    "plot_sweep",
    "window_of",
]
