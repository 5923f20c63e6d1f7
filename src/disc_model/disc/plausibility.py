"""Warnings of what a reader should check of a disc from a file."""

import warnings

from disc_model.errors import ImplausibleValue
from disc_model.parameters import Disc


def warn_of_disc(disc: Disc) -> None:
    """Warn of the doubts of the report of a disc that was read from a file."""
    for text in disc.report.doubts if disc.report else ():
        warnings.warn(text, ImplausibleValue, stacklevel=3)
