"""What the head of a figure says: its title, and values of parameters."""

from collections.abc import Collection, Mapping
from textwrap import fill
from types import MappingProxyType
from typing import Any

from disc_model.data.variables import typeset, values_text
from disc_model.display import counted
from disc_model.figures.value_texts import MODELS
from disc_model.figures.words import MODES, OF_MODES, STAYS, UNITS

IN_WORDS = {
    "n_diameters = -1": "rigid disc",
    "n_diameters =": "nodal diameters up to",
    "n_circles =": "nodal circles up to",
    "contact_arc =": "a pad over",
    "contact_compliance =": "contact compliance",
    "friction_offset =": "friction above the middle plane by",
}
"""What heads of figures say for parameters without a symbol."""
OF_FRICTION = ("mu_s", "mu_k", "mu_k_over_mu_s", "friction_decay", "viscous_friction")
"""Parameters of the law of friction."""
OF_DAMPING = ("D_star", "damping_ratio", "c", "c_p", "c_p_over_c")
OF_CONTACT = ("friction_offset", "contact_arc", "contact_compliance")
FIRST = ("N", "Omega", "disc")
"""What is said where there is room for little else: a table of modes replaces the whole disc."""
IDENTIFYING = ("E", "h", "h_over_b", "m", "k")
"""What tells a disc and a slider from others first."""
OF_DISC = ("nu", "rho", "a", "b", "r_0", "a_over_b", "r_0_over_b")
"""The rest of the material and of the size of the disc."""
ORDERED = (*FIRST, *OF_FRICTION, *IDENTIFYING, *OF_DAMPING, *OF_CONTACT, *OF_DISC, *OF_MODES)
"""Parameters that have a place of their own in a title."""
CHARACTER = 0.06  # inch, mean width of a character of a figure's head


def what_case(values: Mapping[str, Any], selected: Mapping[str, str] = MappingProxyType({})) -> str:
    """Values of parameters for titles: N, Omega, and those that differ from Table 1; and the stays of a
    sweep, in words. What identifies a case comes first: a disc given by its modes, its friction, and what tells
    its disc and slider from others. How the disc is computed comes last, as a title may have no room for all.

    selected : words for others of the values, by their names
    """
    words = [
        MODELS[value] for value in values.values() if isinstance(value, str) and value in MODELS
    ]
    numbers = {name: value for name, value in values.items() if not isinstance(value, str)}
    said = [_numbers_text(numbers, (name,)) for name in FIRST]
    said.append(_numbers_text(numbers, OF_FRICTION))
    said += [text for name, text in selected.items() if name in values]
    said += words
    said += [_numbers_text(numbers, IDENTIFYING)]
    said += [_numbers_text(numbers, (*OF_DAMPING, *OF_CONTACT))]
    others = {*numbers} - {*ORDERED}
    said += [_numbers_text(numbers, others), values.get(STAYS, "")]
    said += [_numbers_text(numbers, OF_DISC), _numbers_text(numbers, OF_MODES)]
    if values.get("normalization") == "orthonormal":
        said.append(MODES["orthonormal"])
    return ", ".join(filter(None, said))


def _numbers_text(values: Mapping[str, Any], chosen: Collection[str]) -> str:
    """The chosen ones among values of parameters, for titles."""
    numbers = {name: value for name, value in values.items() if name in chosen}
    said = values_text(numbers, UNITS.get())
    for name, phrase in IN_WORDS.items():
        said = said.replace(name, phrase)
    return said


def head_text(width: float, title: str, values: str, most: int | None = None) -> str:
    """A title and values of parameters, in lines that fit a width in inches; a value stays on the
    line of its name. Of values that need more lines than `most`, the last ones are only counted."""
    unbroken = [value.replace(" ", "\u00a0") for value in typeset(values).split(", ")]
    length = round(width / CHARACTER)
    said = _in_lines(", ".join(unbroken), length)
    for count in range(len(unbroken) - 1, 0, -1):
        if most is None or said.count("\n") < most:
            break
        further = counted(len(unbroken) - count, "further parameter")
        rest = f"and {further}".replace(" ", "\u00a0")
        said = _in_lines(f"{', '.join(unbroken[:count])}, {rest}", length)
    lines = [fill(line, length) for line in title.splitlines()]
    lines = [text for text in (*lines, said) if text]
    return "\n".join(lines).replace("\u00a0", " ")


def _in_lines(values: str, length: int) -> str:
    """Values in lines of a number of characters; one that is longer has a line of its own."""
    return fill(values, max(length, 1), break_long_words=False, break_on_hyphens=False)
