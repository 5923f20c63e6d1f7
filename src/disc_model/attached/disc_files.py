"""Methods of a `disc_model.Disc` that read and write files, and find modes by finite elements."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import os

    from disc_model.parameters import Disc, Quantity


def from_csv(cls: type[Disc], path: str | os.PathLike[str]) -> Disc:
    """Read a table of modes.

    Parameters
    ----------
    path : CSV file with a row for each mode, and for each pair of modes. Its columns, in any order, are
        ``diameters``, ``omega_rad_per_s`` or ``frequency_Hz``, and ``amplitude_per_sqrt_kg``; optional are
        ``circles``, ``tangential_per_sqrt_kg`` and ``damping_ratio``. Lines that begin with # are comments

    Raises
    ------
    ParameterError
        If the file cannot be read, has another column or a cell that is no number, or breaks a rule of
        `disc_model.Disc`.

    Warns
    -----
    ImplausibleValue
        If numbers are implausible.

    Examples
    --------
    >>> import disc_model as dm
    >>> disc = dm.Disc(diameters=[0, 1, 2], omega=[1490, 1515, 1820], amplitude=[1.53, 2.16, 2.15])
    >>> disc.to_csv("disc.csv")
    >>> dm.Disc.from_csv("disc.csv") == disc
    True
    """
    from disc_model.data.files import regular_file
    from disc_model.disc.plausibility import warn_of_disc
    from disc_model.disc.table import disc_of_table

    disc = disc_of_table(regular_file(path))
    warn_of_disc(disc)
    return disc


def to_csv(self: Disc, path: str | os.PathLike[str]) -> None:
    """Write the table that `from_csv` reads, with enough digits to restore each number exactly. Shapes and
    the static compliance, for which it has no columns, are left out.

    Raises `ParameterError` if the path is not that of a file,
    `disc_model.data.dataset.WriteError` if it cannot be written. `from_csv` has an example.
    """
    from disc_model.data.files import regular_file, write_atomically
    from disc_model.disc.table import table_of_disc

    write_atomically(regular_file(path), partial(table_of_disc(self).to_csv, index=False))


def from_uff(
    cls: type[Disc],
    path: str | os.PathLike[str],
    r_0: Quantity,
    *,
    axis: Iterable[Quantity],
    centre: Iterable[Quantity],
    units: Iterable[str],
) -> Disc:
    """Read normal modes at nodes from a universal file of a modal test or of finite elements (pyuff,
    extra ``uff``).

    Parameters
    ----------
    path : file with normal modes as datasets 55 or 2414, displacements in the global Cartesian system with
        modal masses, and with nodes, datasets 15 or 2411
    r_0 : radius of the slider's circle, in m or with its unit, "100 mm". Nodes must lie all around it; of
        several faces that towards the slider counts
    axis : three numbers, the direction from the disc to the slider
    centre : a point on the axis, m
    units : of length and force in the file, such as ("mm", "N")

    Returns
    -------
    Disc
        The number of nodal diameters of a mode is that of the harmonic with most of its normal motion along
        the circle, by least squares. Two modes of equal diameters within 5 % in frequency are the halves of a
        pair, which is their mean. Tangential amplitudes are those of the nodes on the circle, none if the file
        has motion along the axis alone. Modes that do not move the circle along the axis are left out.

    Raises
    ------
    ParameterError
        If an argument breaks its rule, or the file cannot be read or lacks scaled modes or nodes all around
        the circle; the message says what the file has.

    Warns
    -----
    ImplausibleValue
        If frequencies, amplitudes or damping are implausible.

    Notes
    -----
    A normal mode with the shape psi and the modal mass m has the amplitude psi/sqrt(m).
    """
    from disc_model.data.files import regular_file
    from disc_model.disc.plausibility import warn_of_disc
    from disc_model.disc.universal import disc_of_universal_file

    place = {"r_0": r_0, "axis": axis, "centre": centre, "units": units}
    disc = disc_of_universal_file(regular_file(path), **place)
    warn_of_disc(disc)
    return disc


def from_section(  # noqa: PLR0913
    cls: type[Disc],
    section: Iterable[tuple[float, float, float, float]],
    *,
    size: float,
    E: float,
    nu: float,
    rho: float,
    clamped: Callable[[Any], Any],
    slider: tuple[float, float],
    highest_Hz: float,
    damping_ratio: float = 0.0,
) -> Disc:
    """Find the modes of a solid of revolution by finite elements (scikit-fem, extra ``fe``).

    Parameters
    ----------
    section : rectangles (r from, r to, z from, z to) in m, whose union is the section
    size : m, largest edge of an element
    E, nu, rho : Pa, 1 and kg/m^3
    clamped : function that says which edges around the section are held, from the coordinates (r, z) of their
        middles, shape (2, k)
    slider : (r, z) of the point under the slider, m; a corner of a rectangle, on the upper or the lower face of
        the disc
    highest_Hz : modes up to this frequency are found
    damping_ratio : damping ratio of every mode

    Returns
    -------
    Disc
        Modes ordered by frequency; ``circles`` numbers the modes of equal nodal diameters. Shapes are those at the
        height of the slider, tangential amplitudes those of the surface there.

    Raises
    ------
    ParameterError
        If a number breaks its rule, the section is in pieces or not held, the slider is not at a node, or no mode
        moves under it.

    Warns
    -----
    ImplausibleValue
        If E or rho is not within a hundredth and a hundred times that of Table 1.
    """
    from disc_model.disc.section import disc_of_section

    material = {"E": E, "nu": nu, "rho": rho, "damping_ratio": damping_ratio}
    return disc_of_section(section, size, material, clamped, slider, highest_Hz)
