"""Symbols in texts of figures: upright letters, and how many characters are seen."""

import re
from collections.abc import Iterable
from textwrap import fill
from typing import Any

VALUE = re.compile(r"\S+ = [^,:]+")
"""The symbol of a quantity, its value and its unit."""
UNBROKEN = "\u00a0"  # a blank at which no line ends
MARKUP = re.compile(r"\\\w+|[${}_^]")  # of mathematical text; a symbol for a command


def seen(word: str) -> int:
    """Number of characters of a word that are seen, and the blank after it."""
    return len(MARKUP.sub(lambda found: "x" if found[0].startswith("\\") else "", word)) + 1


def set_upright(texts: Iterable[Any]) -> None:
    """Set symbols with an index, such as c_p, in upright letters, as all others are, whatever the
    setting of matplotlib when the texts are drawn."""
    for text in texts:
        said = text.get_text()
        if "$" in said:
            text.set_text(re.sub(r"\$([^$]+)\$", r"$\\mathrm{\1}$", without_font(said)))


def without_font(text: str) -> str:
    """A text with symbols in the letters that matplotlib's setting gives them."""
    return re.sub(r"\$\\mathrm\{([^$]+)\}\$", r"$\1$", text)


def broken(text: str, length: int) -> str:
    """A text in lines of a number of characters, in which a value stays with its symbol and its unit; one that
    is longer than a line begins with the equals sign."""

    def kept(found: re.Match[str]) -> str:
        """A symbol and its value on one line, or a longer value below its symbol."""
        whole = found[0].replace(" ", UNBROKEN)
        if len(MARKUP.sub("", whole)) > length:
            return whole.replace(f"{UNBROKEN}=", " =")
        return whole

    in_one_line = text.replace("\n", " ")
    return fill(VALUE.sub(kept, in_one_line), length, break_long_words=False).replace(UNBROKEN, " ")


def in_a_row(text: str) -> str:
    """A text without the letters of its symbols and the lines in which it stands."""
    return without_font(text).replace("\n", " ")
