"""Bases of classes that have methods from higher rooms.

A disc is read by `disc_model.disc`, and a result is drawn by `disc_model.figures`, but both
rooms need these classes themselves. `disc_model.attached` therefore attaches such methods to the
bases here, when `disc_model` is imported; type checkers find them by the assignments below.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from disc_model.attached import disc_files, run_pictures


class DiscFiles:
    """What a `disc_model.Disc` can read and write, see `disc_model.attached.disc_files`."""

    if TYPE_CHECKING:
        from_csv = classmethod(disc_files.from_csv)
        from_uff = classmethod(disc_files.from_uff)
        from_section = classmethod(disc_files.from_section)
        to_csv = disc_files.to_csv


class RunPictures:
    """What a `disc_model.Result` can draw, see `disc_model.attached.run_pictures`."""

    if TYPE_CHECKING:
        plot = run_pictures.plot
        plot_phase_portrait = run_pictures.plot_phase_portrait
        plot_spectrum = run_pictures.plot_spectrum
        plot_poincare = run_pictures.plot_poincare
        animate = run_pictures.animate
