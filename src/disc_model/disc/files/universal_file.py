"""Discs from universal files of modal tests and finite elements."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from disc_model.disc.files.harmonics import grouped, origin_of
from disc_model.disc.files.place import Place
from disc_model.disc.files.universal_doubts import (
    far_face,
    few_nodes,
    more_than_a_pair,
    notes_on,
    single_halves,
    turned_halves,
)
from disc_model.disc.files.universal_geometry import read_units
from disc_model.disc.files.universal_modes import (
    FileMode,
    normalised,
    poles_in_hertz,
    read_modes,
    with_modal_mass,
    with_pole_in_radians,
)
from disc_model.disc.files.universal_motion import contents_of
from disc_model.disc.files.universal_sets import DataSet, read_sets
from disc_model.disc.files.universal_waves import (
    disc_of,
    have_motion_in_plane,
    placed_towards_slider,
    waves_of,
)
from disc_model.disc.given import DiscReport, doubts_of_halves
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Disc

FUNCTIONS = (58, 1858)  # numbers of datasets with measured functions at nodes and their properties


def read_uff(path: str | os.PathLike[str], place: Place) -> Disc:
    """Read a disc from a universal file, see `disc_model.Disc.from_uff`."""
    name = Path(path).name
    try:
        return _disc(read_sets(path), place, name)
    except ParameterError as error:
        raise ParameterError(*(_inside(fault, name) for fault in error.faults)) from None


def _inside(fault: Fault, name: str) -> Fault:
    """A fault with the name of the file in front of it."""
    return Fault((name,), "", str(fault))


def _disc(sets: list[DataSet], place: Place, name: str) -> Disc:
    """The disc of the datasets of a file, with its report."""
    units = read_units(sets, place.units)
    modes, left_out = read_modes(sets)
    if not modes:
        raise _nothing("must hold modes at nodes", sets, left_out)
    modes, doubts = _in_radians(modes, name)
    if place.modal_mass is not None:
        modes = [with_modal_mass(mode, place.modal_mass) for mode in modes]
    shapes = [normalised(mode, units.mass) for mode in modes]

    placed = placed_towards_slider(shapes, sets, place, units.length)
    waves, unresolved = waves_of(placed, left_out)
    if not waves:
        raise _nothing("must hold modes across the disc", sets, left_out)
    groups = grouped(waves)
    doubts += few_nodes(waves, placed.circle, unresolved)
    doubts += single_halves(groups)
    doubts += turned_halves(groups)
    doubts += more_than_a_pair(waves)
    doubts += far_face(waves, placed.circle)

    origins = tuple(origin_of(group) for group in groups)
    doubts += doubts_of_halves(origins)

    tangential = have_motion_in_plane(waves)
    report = DiscReport(
        source=name,
        modes=origins,
        left_out=dict(left_out),
        notes=tuple(notes_on(placed, units, modes, tangential)),
        doubts=tuple(doubts),
    )
    return disc_of(groups, tangential).with_report(report)


def _in_radians(modes: list[FileMode], name: str) -> tuple[list[FileMode], list[str]]:
    """The modes with poles in rad/s, and a doubt if the file seems to have them in Hz."""
    reason = poles_in_hertz(modes)
    if not reason:
        return modes, []
    doubt = f"the poles of {name} are taken to be in Hz: {reason}"
    return [with_pole_in_radians(mode) for mode in modes], [doubt]


def _nothing(rule: str, sets: Iterable[DataSet], left_out: Mapping[str, int]) -> ParameterError:
    """The error that a file does not hold what a disc needs, but other things."""
    text = f"{rule}. {contents_of(sets)}"
    if any(data.number in FUNCTIONS for data in sets):
        text += (
            "; dataset 58 has measured functions, such as frequency responses, and is not read: "
        )
        text += "modes are found from them by modal analysis"
    if left_out:
        others = ", ".join(f"{count} x {reason}" for reason, count in left_out.items())
        text += f"; left out: {others}"
    return ParameterError(Fault((), "", text))
