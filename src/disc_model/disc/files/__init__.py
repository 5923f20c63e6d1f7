"""Discs from files: tables, universal files of modal tests and finite elements, and the section of
a drawing."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from disc_model.disc.files.mesh import mesh_of
from disc_model.disc.files.pairs import Pairs
from disc_model.disc.files.place import Place
from disc_model.disc.files.section import disc_of_section
from disc_model.disc.files.table import read_disc, table_text
from disc_model.disc.files.universal_file import read_uff
from disc_model.disc.plausibility import warn_of_disc
from disc_model.parameters import Disc


def disc_of_table(path: str | os.PathLike[str], pairs: Pairs) -> Disc:
    """Read a table and warn of what is implausible in it, see `disc_model.Disc.from_csv`."""
    disc = read_disc(path, pairs)
    warn_of_disc(disc)
    return disc


def write_table(disc: Disc, path: str) -> None:
    """Write the table that `disc_of_table` reads."""
    Path(path).write_text(table_text(disc), encoding="utf-8")


def disc_of_universal_file(path: str | os.PathLike[str], **place: Any) -> Disc:
    """Read a universal file and warn of what is implausible in it, see `disc_model.Disc.from_uff`."""
    disc = read_uff(path, Place.of(**place))
    warn_of_disc(disc)
    return disc


def disc_of_drawing(
    section: Any, size: float | None, material: Mapping[str, float], *held: Any
) -> Disc:
    """Find the modes of a section, which has a mesh or gets one, see `disc_model.Disc.from_section`."""
    mesh = section
    if size is not None:
        mesh = mesh_of(section, size)
    return disc_of_section(mesh, material, *held)
