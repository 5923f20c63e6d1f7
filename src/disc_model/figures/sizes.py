"""Sizes of figures: those of a column and of a page of a journal."""

INCH = 25.4  # mm
COLUMN = 84 / INCH  # width of one column, inch
PAGE = 174 / INCH  # width of both columns, inch
WIDTHS = {"column": COLUMN, "page": PAGE}
