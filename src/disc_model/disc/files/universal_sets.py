"""Universal files: their datasets, and the numbers in records.

A dataset stands between two lines with -1 in columns 5 and 6, and its first line has its number.
Records have fields of fixed width, which neighbours may touch, and Fortran's exponents.
"""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from disc_model.disc.plate import Array
from disc_model.errors import Fault, ParameterError, as_text

if TYPE_CHECKING:
    import os

INTEGER_WIDTH = 10  # of a field with a whole number
REAL_WIDTH = 13  # of a field with a real number of single precision
_LINES = re.compile(r"\r\n|\n|\r")
_MARK = re.compile(r"-1 *(?=[\r\n]|\Z)")
_MARK_ANYWHERE = re.compile(r" {4}-1 *(?=[\r\n]|\Z)")
_KIND = re.compile(r" {0,5}(\d{1,6})")
_KIND_ALONE = re.compile(r" {1,5}\d{2,5}\s*?(?=[\r\n]|\Z)")  # as no comment between datasets is
_BINARY = re.compile(r"[\r\n]+ {0,5}\d+b(?: +\d+){2} +(\d+) +(\d+)[^\n]*\n", re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+|[-+]\d{3}(?![\d.]))?")
_WITHOUT_LETTER = re.compile(r"(?<=[\d.])(?=[-+]\d{3}$)")  # of an exponent of three digits


class DataSet(NamedTuple):
    """A dataset of a universal file.

    number : what it holds: 55 for data at nodes
    place : 1 for the first dataset of the file
    lines : its records, without the line with its number
    """

    number: int
    place: int
    lines: list[str]

    def fault(self, rule: str) -> ParameterError:
        """The error that something is wrong in this dataset."""
        name = f"dataset {self.number} (no. {self.place} of the file)"
        return ParameterError(Fault((), "", f"{name} {rule}"))


def read_sets(path: str | os.PathLike[str]) -> list[DataSet]:
    """Read all datasets of a universal file; raises `ParameterError` if it is none or is cut
    off."""
    try:
        raw = Path(path).read_bytes()
    except OSError as error:
        rule = f"must be a universal file that can be read ({error})"
        raise ParameterError(Fault((as_text(str(path)),), "", rule)) from None
    # each byte is one character, whatever the encoding of texts
    text = raw.removeprefix(b"\xef\xbb\xbf").decode("latin-1")

    sets: list[DataSet] = []
    start = _next_mark(text, 0)
    while start is not None:
        end = _end_mark(text, start.end())
        until = len(text) if end is None else end.start()
        records = text[start.end() : until].rstrip(" ").strip("\r\n")
        data = _data_set(_LINES.split(records), len(sets) + 1)
        if end is None:
            raise data.fault("must end with a line -1: the file is cut off")
        following = text[end.end() : end.end() + 80].lstrip("\r\n")
        if _KIND_ALONE.match(following):
            raise data.fault("must have a line -1 at its end and one before the next dataset")
        sets.append(data)
        start = _next_mark(text, end.end())
    if not sets:
        rule = "must be a universal file that can be read: it has no datasets between lines -1"
        raise ParameterError(Fault((), "", rule))
    return sets


def is_universal_file(path: str | os.PathLike[str]) -> bool:
    """Whether a file begins as a universal file does, with the mark of a dataset near its start."""
    try:
        with Path(path).open("rb") as file:
            begin = file.read(4000).removeprefix(b"\xef\xbb\xbf").decode("latin-1")
    except OSError:
        return False
    return _next_mark(begin, 0) is not None


def _next_mark(text: str, start: int) -> re.Match[str] | None:
    """The next line with -1 alone, in its first six columns; None if there is none."""
    for match in _MARK.finditer(text, start):
        before = text[max(0, match.start() - 5) : match.start()].lstrip("\r\n")
        begins = match.start() - len(before)
        if before.strip(" ") == "" and (begins == 0 or text[begins - 1] in "\r\n"):
            return match
    return None


def _end_mark(text: str, start: int) -> re.Match[str] | None:
    """The mark at the end of the dataset that begins at `start`; None if there is none. Data in
    bytes, which may look like anything, are passed over by their number."""
    if binary := _BINARY.match(text, start):
        lines = int(binary[1])
        count = int(binary[2])
        end = binary.end()
        for _ in range(lines):
            end = text.find("\n", end) + 1
        return _MARK_ANYWHERE.search(text, end + count)
    return _next_mark(text, start)


def _data_set(lines: list[str], place: int) -> DataSet:
    """The dataset of the lines between its marks; its number is 0 if it has none."""
    match = _KIND.match(lines[0])
    number = 0
    if match is not None:
        number = int(match[1])
    return DataSet(number, place, lines[1:])


def integers(data: DataSet, i: int, least: int = 0) -> list[int]:
    """The whole numbers of record `i` of a dataset, of which there must be `least`."""
    values = _fields(data, i, INTEGER_WIDTH, least)
    if not all(value.is_integer() for value in values):
        raise data.fault(f"must have whole numbers in record {i + 1}")
    return [int(value) for value in values]


def reals(data: DataSet, i: int, least: int = 0) -> list[float]:
    """The real numbers of record `i` of a dataset, of which there must be `least`; an empty field
    is 0."""
    return _fields(data, i, REAL_WIDTH, least)


def numbers_in(data: DataSet, first: int) -> Array:
    """All numbers of the records of a dataset from one on, shape (n,)."""
    text = "\n".join(data.lines[first:])
    with suppress(ValueError):
        return np.array(text.replace("D", "E").replace("d", "e").split(), dtype=float)
    # some numbers touch, or have exponents without a letter
    rest = _NUMBER.sub("", text).split()
    if rest:
        raise data.fault(f"must have numbers only in its records, and not {as_text(rest[0])}")
    return np.array([*map(_value, _NUMBER.findall(text))])


def _fields(data: DataSet, i: int, width: int, least: int) -> list[float]:
    """The numbers of a record, by fields of fixed width, or by what separates them."""
    if i >= len(data.lines):
        raise data.fault(f"must have {i + 1} or more records: it is cut off")
    line = data.lines[i].rstrip()
    cells = [line[j : j + width].strip() for j in range(0, len(line), width)]
    if not all(not cell or _NUMBER.fullmatch(cell) for cell in cells):
        cells = _NUMBER.findall(line)
        rest = _NUMBER.sub("", line).split()
        if rest:
            raise data.fault(
                f"must have numbers only in record {i + 1}, and not {as_text(rest[0])}"
            )
    if len(cells) < least:
        raise data.fault(f"must have {least} numbers in record {i + 1}, and not {len(cells)}")
    return [_value(cell or "0") for cell in cells]


def _value(text: str) -> float:
    """A number with the exponents of Fortran: 1.5D+03, 1.5-103."""
    return float(_WITHOUT_LETTER.sub("E", text.replace("D", "E").replace("d", "E")))
