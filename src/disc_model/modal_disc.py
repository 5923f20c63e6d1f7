"""A disc that is given by its modes, checked, in SI units."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

from pydantic import Field, field_validator, model_validator

from disc_model.display import modes_text
from disc_model.errors import Check, require
from disc_model.units import Count, Finite, Natural, Positive, Strict, Unit, between

if TYPE_CHECKING:
    import os

MOST_MODES = 1000  # largest number of modes in the table of a disc
# of natural frequencies, rad/s; above them a cycle would take minutes to compute
FREQUENCIES = (1e-3, 1e7)
# of the largest modal amplitude, kg^-1/2: the modal mass is 1e-12 to 1e12 kg
AMPLITUDES = (1e-6, 1e6)
SAME_FREQUENCY = 0.05  # relative distance below which modes of as many diameters are one pair
GIVEN_ONCE = (
    "the disc must be axisymmetric, with each pair of modes given once, by its mean frequency"
)
NO_PAIR = "a mode without nodal diameters is no half of a pair, and must be given once"

Quantity = float | str  # a number, or a text that stands for one, with or without its unit


class Disc(Strict):
    """An axisymmetric disc given by its modes, from finite elements or a modal test.

    Modes with nodal diameters are pairs (cosine and sine), each given once. `from_csv`, `from_uff`
    and `from_section` make one.

    Parameters
    ----------
    diameters : number of nodal diameters of each mode (whole numbers, 0 to 60)
    omega : natural frequencies (rad/s, 1e-3 to 1e7)
    amplitude : mass-normalised displacement under the slider, at an antinode of the pair (kg^-1/2)
    damping_ratio : of each mode (0 to 1; 0 if left out)
    circles : number of nodal circles of each mode; if left out, modes of as many diameters are counted by frequency
    tangential : displacement of the friction surface along the slider's path, under the slider, of the half of each
        pair that has its node there (kg^-1/2), 0 without nodal diameters; in a plate, at the height z, -(z/r_0)
        diameters amplitude. Needed for ``friction_offset="surface"`` alone
    static_compliance : of the whole disc under a point load at the slider (m/N, > 0), from which the compliance of
        the modes that are left out follows; None if it is not known
    radii : where shapes are known (m, ascending, two or more); none if they are not
    shapes : of each mode, its displacement at these radii, in sign and scale that of the amplitude (kg^-1/2)

    Raises
    ------
    ParameterError
        Naming everything that breaks a rule, its value and the rule, in one message.

    Examples
    --------
    >>> import disc_model as dm
    >>> disc = dm.Disc(diameters=[0, 1], omega=[1490, 1515], amplitude=[1.53, 2.16], damping_ratio=[1e-3] * 2)
    >>> dm.simulate(dm.Parameters(N=385, Omega=15.1, disc=disc, r_0=0.1), 0.1).status.value
    'ok'
    """

    diameters: tuple[Annotated[Count, Field(ge=0, le=60)], ...]
    omega: tuple[Annotated[Finite, between(FREQUENCIES)], ...]
    amplitude: tuple[Finite, ...]
    damping_ratio: tuple[Annotated[Finite, Field(ge=0, lt=1)], ...] = Field(
        (), validate_default=True
    )
    circles: tuple[Natural, ...] = Field((), validate_default=True)
    tangential: tuple[Finite, ...] = ()
    static_compliance: Annotated[Positive, Unit("m/N")] | None = None
    radii: tuple[Annotated[Positive, Unit("m")], ...] = ()
    shapes: tuple[tuple[Finite, ...], ...] = ()

    _columns: ClassVar = (
        "diameters",
        "omega",
        "amplitude",
        "damping_ratio",
        "circles",
        "tangential",
        "shapes",
    )

    if TYPE_CHECKING:  # for type checkers: any sequence of numbers will do

        def __init__(self, **columns: Any) -> None: ...

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between columns, and refuse modes that are given twice."""
        count = len(self.diameters)
        rule = f"must be 1 to {MOST_MODES} modes"
        require((1 <= count <= MOST_MODES, "diameters", count, rule))
        rules: list[Check] = []
        for name in self._columns:
            length = len(getattr(self, name))
            good = length == count or not (length or name in ("omega", "amplitude"))
            rules.append((good, name, length, f"must be as many as diameters, {count}"))
        require(*rules)

        lengths = {len(shape) for shape in self.shapes}
        known = lengths == {len(self.radii)} and len(self.radii) > 1
        rule = "must be two or more that ascend, with a value of the shape of every mode at each"
        ascend = all(inner < outer for inner, outer in pairwise(self.radii))
        still = all(value == 0 for l, value in zip(self.diameters, self.tangential) if l == 0)  # noqa: B905
        at_axis = "must be 0 for a mode without nodal diameters"
        require(
            (ascend and (known or not (lengths or self.radii)), "radii", [*self.radii], rule),
            # no half of a pair has its node under the slider
            (still, "tangential", [*self.tangential], at_axis),
        )
        low, high = AMPLITUDES
        largest = max(map(abs, self.amplitude))
        rule = f"must be within {low:g} and {high:g}"
        require((low <= largest <= high, "largest amplitude", largest, rule))
        self._refuse_repeated_modes()
        return self

    def _refuse_repeated_modes(self) -> None:
        """Raise `ParameterError` if a mode is given twice, or as the two halves of a pair."""
        counted = "circles" not in self.model_fields_set  # by frequency: no two are alike
        modes = enumerate(zip(self.diameters, self.circles, self.omega, strict=True))
        for (i, (l, circles, omega)), (j, (other, its_circles, its_omega)) in combinations(
            modes, 2
        ):
            if l != other:
                continue
            apart = abs(its_omega - omega) / max(omega, its_omega)
            same = apart < SAME_FREQUENCY if counted else circles == its_circles
            rule = f"modes {i + 1} and {j + 1} have as many diameters and are {100 * apart:.2g} % apart: "
            rule += GIVEN_ONCE if l else NO_PAIR
            require((not same, f"omega.{j}", its_omega, rule))

    @field_validator("damping_ratio", "circles")
    @classmethod
    def _complete(cls, column: tuple[float, ...], info: Any) -> tuple[float, ...]:
        """Fill in a column that is left out: no damping, and circles counted by frequency."""
        diameters = info.data.get("diameters", ())
        omega = info.data.get("omega", ())
        if column or len(omega) != len(diameters):
            return column
        if info.field_name == "damping_ratio":
            return (0.0,) * len(omega)
        modes = [*zip(diameters, omega, strict=True)]
        return tuple(sum(l == own and w < at for l, w in modes) for own, at in modes)

    def __repr__(self) -> str:
        return f"Disc({modes_text(self.omega)})"

    __str__ = __repr__

    # ---- Files

    @classmethod
    def from_csv(cls, path: str | os.PathLike[str]) -> Disc:
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

        Examples
        --------
        >>> import disc_model as dm
        >>> disc = dm.Disc(diameters=[0, 1, 2], omega=[1490, 1515, 1820], amplitude=[1.53, 2.16, 2.15])
        >>> disc.to_csv("disc.csv")
        >>> dm.Disc.from_csv("disc.csv") == disc
        True
        """
        from disc_model.data.files import regular_file
        from disc_model.disc.table import disc_of_table

        return disc_of_table(regular_file(path))

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the table that `from_csv` reads, with enough digits to restore each number exactly. Shapes and
        the static compliance, for which it has no columns, are left out.

        Raises `ParameterError` if the path is not that of a file,
        `disc_model.data.dataset.WriteError` if it cannot be written. `from_csv` has an example.
        """
        from disc_model.data.files import regular_file, write_atomically
        from disc_model.disc.table import table_of_disc

        write_atomically(regular_file(path), partial(table_of_disc(self).to_csv, index=False))

    @classmethod
    def from_uff(
        cls,
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

        Notes
        -----
        A normal mode with the shape psi and the modal mass m has the amplitude psi/sqrt(m).
        """
        from disc_model.data.files import regular_file
        from disc_model.disc.universal import disc_of_universal_file

        return disc_of_universal_file(
            regular_file(path), r_0=r_0, axis=axis, centre=centre, units=units
        )

    @classmethod
    def from_section(  # noqa: PLR0913
        cls,
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
        """
        from disc_model.disc.section import disc_of_section

        material = {"E": E, "nu": nu, "rho": rho, "damping_ratio": damping_ratio}
        return disc_of_section(section, size, material, clamped, slider, highest_Hz)
