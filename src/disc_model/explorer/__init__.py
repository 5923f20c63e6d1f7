"""A page on which all points of studies can be looked at, in one file."""

from disc_model.explorer.contents import LEVELS, Stated, study_contents
from disc_model.explorer.document import Picture, page
from disc_model.explorer.embedding import PAGE_WIDTH, PICTURE_WIDTH

__all__ = ["LEVELS", "PAGE_WIDTH", "PICTURE_WIDTH", "Picture", "Stated", "page", "study_contents"]
