"""The cases that claims are about: parameters that each must have, and how claims ask for them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from disc_model.claims.model import Needed

PARAMETERS: Mapping[str, Mapping[str, Any]] = {
    "F02": {"N": 200, "Omega": 20},
    "F04": {"N": 200, "Omega": 20, "contact": "bonded"},
    "F06": {"N": 300, "Omega": 20, "contact": "bonded"},
    "F07": {"N": 300, "Omega": 20},
    "F08": {"N": 200, "Omega": 50, "contact": "bonded"},
    "F09": {"N": 200, "Omega": 50},
    "F11": {"N": 385, "Omega": 15},
    "F13": {"N": 385, "Omega": 15.1},
    "F13bonded": {"N": 385, "Omega": 15.1, "contact": "bonded"},
    "F16": {"N": 50, "Omega": 15},
    "F17": {"N": 200, "Omega": 15},
    "F17bonded": {"N": 200, "Omega": 15, "contact": "bonded"},
    "F18": {"N": 200, "Omega": 10, "D_star": 0},
    "F19": {"N": 385, "Omega": 15, "c_p": 0.5},
    "F20": {"N": 200, "Omega": 20, "c": 0.5},
    "F21": {"N": 200, "Omega": 11, "E": 1e11},
    "F22": {"N": 300, "Omega": 50, "k_p": 2e3},
    "F23": {"N": 200, "Omega": 20, "m": 0.01},
    "C4cp01": {"N": 385, "Omega": 15, "c_p": 0.1},
    "C4cp1": {"N": 385, "Omega": 15, "c_p": 1},
    "C4cpN50": {"N": 50, "Omega": 15, "c_p": 0.5},
    "P03l5": {"N": 385, "Omega": 15.1, "n_diameters": 5},
    "P03l6": {"N": 385, "Omega": 15.1, "n_diameters": 6},
    "P03l8": {"N": 385, "Omega": 15.1, "n_diameters": 8},
    "P03l8c2": {"N": 385, "Omega": 15.1, "n_diameters": 8, "n_circles": 2},
    "S43N0": {"N": 1e-6, "Omega": 15},
    "S43N550": {"N": 550, "Omega": 15},
    "S43N600": {"N": 600, "Omega": 15},
    "S43N3e3": {"N": 3000, "Omega": 15},
    "S43Ninf": {"N": 8e4, "Omega": 15},
    "S43a10": {"N": 200, "Omega": 10, "D_star": 2e-5},
    "S43a126": {"N": 200, "Omega": 12.6, "D_star": 2e-5},
    "S43c10": {"N": 200, "Omega": 10},
    "S43c11": {"N": 200, "Omega": 11},
    "S43c12": {"N": 200, "Omega": 12},
    "S43c122": {"N": 200, "Omega": 12.2},
    "S43c124": {"N": 200, "Omega": 12.4},
    "S43c126": {"N": 200, "Omega": 12.6},
    "S43c14": {"N": 200, "Omega": 14},
    "S43c145": {"N": 200, "Omega": 14.5},
    "S43E100": {"N": 200, "Omega": 20, "E": 1e11},
    "S43E200": {"N": 200, "Omega": 20, "E": 2e11},
    "S43k2e4": {"N": 200, "Omega": 20, "k": 2e4},
    "S43k3e4": {"N": 200, "Omega": 20, "k": 3e4},
    "S43k2e5": {"N": 200, "Omega": 20, "k": 2e5},
    "S43kp2e4": {"N": 300, "Omega": 50},
    "S43kp2e5": {"N": 300, "Omega": 50, "k_p": 2e5},
    "S43z4": {"N": 200, "Omega": 4, "D_star": 0},
    "T2kp18": {"N": 385, "Omega": 15.1, "k_p": 1.8e4},
    "T2kp22": {"N": 385, "Omega": 15.1, "k_p": 2.2e4},
    "T2Om12": {"N": 385, "Omega": 12},
}
"""Values beside base values, by case."""
REPEATS = {name: tuple(f"{name}{letter}" for letter in "abc") for name in ("S43N550", "S43z4")}
"""The same cases with other tolerances: their first separations follow a wandering whose details no method keeps."""
SEPARATED = {"N": 385, "Omega": 15.1}
OTHERS = {name: f"{name}free" for name in ("F02", "F07", "F17")}
"""The same cases begun in the last state of `SEPARATED`, which may lead to another motion."""
AGAIN = {*OTHERS.values(), *(again for names in REPEATS.values() for again in names)}
"""Parameters of a case of the paper once more."""


def asked(*, separates: bool = False, steady: bool = False, **until: float) -> dict[str, Needed]:
    """Some of these cases, each with the time in s to which it must have run; for the rest see `Needed`.

    Cases in which separation is ignored need not separate.
    """
    return {
        name: Needed(own := PARAMETERS[name], time, separates and "contact" not in own, steady)
        for name, time in until.items()
    }


def repeated(name: str) -> dict[str, Needed]:
    """A case, and those that repeat it."""
    return {each: Needed(PARAMETERS[name]) for each in (name, *REPEATS[name])}


def others(*names: str) -> dict[str, Needed]:
    """What the same parameters lead to from another start."""
    return {OTHERS[name]: Needed(PARAMETERS[name], 790, after=SEPARATED) for name in names}
