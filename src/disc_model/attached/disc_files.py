"""Methods of a `disc_model.Disc` that read and write files, and find modes by finite elements."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    import os

    from disc_model.parameters import Disc, Quantity


def from_csv(
    cls: type[Disc], path: str | os.PathLike[str], pairs: Literal["given", "mean", "test"] = "given"
) -> Disc:
    """Read a table of modes.

    Parameters
    ----------
    path : CSV file, with commas, semicolons or tabs. Its columns, in any order, are ``diameters``,
        ``frequency_Hz`` or ``omega_rad_per_s``, and ``amplitude_per_sqrt_kg``; optional are ``damping_ratio``,
        ``circles``, ``tangential_per_sqrt_kg``, and shapes at radii, such as ``shape_at_0.08_m``. Heads may also
        give a name and its unit, such as "frequency (kHz)", "damping [%]" or "pole (rad/s)". Lines that begin
        with # are comments; one may give ``static_compliance_m_per_N: ...``
    pairs : "given" if each pair of modes is given once; "mean" if both halves of a pair may be given: two modes of
        equal diameters within 5 % in frequency become their mean, and `report` has the splits; "test" if both halves
        were measured at one point, as in a driving-point test: the amplitude is then the root of the sum of squares

    Raises
    ------
    ParameterError
        If the file cannot be read or breaks a rule; the message names the column or mode, its value and the rule.

    Warns
    -----
    ImplausibleValue
        If halves of a pair differ by more than a test errs.

    Returns
    -------
    Disc
        `report` says how each column was understood, and within which values it lies.

    Examples
    --------
    >>> import disc_model as dm
    >>> disc = dm.Disc(diameters=[0, 1, 2], omega=[1490, 1515, 1820], amplitude=[1.53, 2.16, 2.15])
    >>> disc.to_csv("disc.csv")
    >>> dm.Disc.from_csv("disc.csv") == disc
    True
    """
    from disc_model.data.files import regular_file
    from disc_model.disc.files.table import read_disc
    from disc_model.disc.plausibility import warn_of_disc

    disc = read_disc(regular_file(path), pairs)
    warn_of_disc(disc)
    return disc


def to_csv(self: Disc, path: str | os.PathLike[str]) -> None:
    """Write the table that `from_csv` reads, with enough digits to restore each number exactly.

    Raises `ParameterError` if the path is not that of a file,
    `disc_model.data.dataset.WriteError` if it cannot be written. `from_csv` has an example.
    """
    from disc_model.data.files import regular_file, write_atomically
    from disc_model.disc.files.table import table_text

    text = table_text(self)
    file = regular_file(path)
    write_atomically(file, lambda name: Path(name).write_text(text, encoding="utf-8"))


def from_uff(
    cls: type[Disc],
    path: str | os.PathLike[str],
    r_0: Quantity,
    *,
    axis: str | Iterable[float] | None = None,
    centre: Iterable[Quantity] | None = None,
    units: Iterable[str] | None = None,
    modal_mass: Quantity | None = None,
) -> Disc:
    """Read mode shapes from a universal file of modal tests or finite elements.

    Parameters
    ----------
    path : file with normal or complex modes at nodes as datasets 55 or 2414, scaled by modal masses or modal A,
        and the nodes' coordinates, datasets 15 or 2411 (coordinate systems: 18 or 2420, units: 164). Motion may
        be displacement, velocity or acceleration
    r_0 : radius of the circle of nodes under the slider, in m or with its unit: 0.1, "100 mm". Other circles at
        the same height give the shapes
    axis : direction of the disc's axis, from the disc to the slider: "x", "-z" or three numbers; if left out, it is
        found. Its sense is then that in which the nodes move as on the face under the slider; without motion in
        the plane its largest part is positive
    centre : a point on the axis (m); if left out, it is found
    units : of length and force in a file without dataset 164, such as ("mm", "N"); ("m", "N") if left out
    modal_mass : of modes whose modal mass or modal A is 0 in the file, in its unit of mass: 1 for shapes that
        finite elements have mass-normalised

    Returns
    -------
    Disc
        The number of nodal diameters of a mode is that of the harmonic with most of its motion along the circle.
        Two modes of equal diameters within 5 % in frequency are the halves of a pair, which is their mean; a mode
        that the file has several times is one. Tangential amplitudes are those of the nodes on the circle, None
        if the file has motion along the axis alone. Modes in the plane of the disc, and with less than half of
        their motion in one harmonic, are left out. `report` says what was used and left out.

    Raises
    ------
    ParameterError
        If the file cannot be read, is cut off, or lacks scaled modes, or nodes around the circle; the message
        names the axis, the radii of the nodes and the datasets of the file.

    Warns
    -----
    ImplausibleValue
        If the nodes are too few for the modes, antinodes of the halves of a pair do not lie between each other,
        more than two shapes of equal diameters are within 5 %, or poles seem to be in Hz.
    """
    from disc_model.data.files import regular_file
    from disc_model.disc.files.place import Place
    from disc_model.disc.files.universal_file import read_uff
    from disc_model.disc.plausibility import warn_of_disc

    file = regular_file(path)
    place = Place.of(r_0=r_0, axis=axis, centre=centre, units=units, modal_mass=modal_mass)
    disc = read_uff(file, place)
    warn_of_disc(disc)
    return disc


def from_section(  # noqa: PLR0913
    cls: type[Disc],
    section: Any,
    *,
    E: float,
    nu: float,
    rho: float,
    clamped: Callable[[Any], Any],
    slider: tuple[float, float],
    highest_Hz: float,
    damping_ratio: float = 0.0,
    size: float | None = None,
) -> Disc:
    """Find the modes of a solid of revolution by finite elements (scikit-fem, extra ``fe``).

    Parameters
    ----------
    section : rectangles (r from, r to, z from, z to) in m, whose union is the section; or a mesh of quadrilaterals
        of scikit-fem with coordinates (r, z)
    size : m, largest edge of an element; not for a mesh
    E, nu, rho : Pa, 1 and kg/m^3
    clamped : function that says which edges around the section are held, from the coordinates (r, z) of their
        middles, shape (2, k)
    slider : (r, z) of the point under the slider, m; a corner of a rectangle, or a node of the mesh; on the upper
        or the lower face of the disc
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

    """
    from disc_model.disc.files.mesh import mesh_of
    from disc_model.disc.files.section import disc_of_section

    mesh = section
    if size is not None:
        mesh = mesh_of(section, size)
    material = {"E": E, "nu": nu, "rho": rho, "damping_ratio": damping_ratio}
    return disc_of_section(mesh, material, clamped, slider, highest_Hz)
