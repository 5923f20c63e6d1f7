"""The validated parameters of the model, in SI units."""

from __future__ import annotations

import inspect
import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from importlib import import_module
from itertools import combinations, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, get_args

import pydantic
from pydantic import AfterValidator, BeforeValidator, Field, field_validator, model_validator

from disc_model.display import html_table
from disc_model.errors import Fault, as_text, raise_faults
from disc_model.units import (
    UNITS,
    Count,
    Finite,
    Positive,
    Real,
    Strict,
    canonical_json,
    content_key,
    in_si,
    is_number,
    limits_faults,
    must,
    number,
    within,
)

if TYPE_CHECKING:
    import os

    from disc_model.disc.given import DiscReport

AUTO = "auto"  # value of ``n_diameters`` in a file for which `disc_model.mode_choice` chooses the modes
CHOOSING = ("truncation_quantity", "truncation_tolerance")  # keys of files that control this choice
RESIDUAL = "residual"  # value of ``contact_compliance`` that stands for the static flexibility of the modes left out
SURFACE = "surface"  # value of ``friction_offset`` by which friction acts on the disc's surface

RELATED = (
    "mu_s",
    "mu_k",
    "a",
    "b",
    "r_0",
    "E",
    "h",
    "nu",
    "disc",
)  # parameters in rules that relate several
# parameters of the plate, which have no meaning for a disc that is given by its modes
PLATE = ("D_star", "E", "a", "b", "h", "nu", "rho", "n_diameters", "n_circles", "normalization")
RATIOS = {  # of two parameters, which may stand for the first one
    f"{upper}_over_{lower}": (upper, lower)
    for upper, lower in (
        ("mu_k", "mu_s"),
        ("k_p", "k"),
        ("c_p", "c"),
        ("a", "b"),
        ("r_0", "b"),
        ("h", "b"),
    )
}
MOST_MODES = 1000  # largest number of modes in the table of a disc
FREQUENCIES = (
    1e-3,
    1e7,
)  # limits of natural frequencies, rad/s; above them a cycle would take minutes to compute
AMPLITUDES = (
    1e-6,
    1e6,
)  # limits of the largest modal amplitude, kg^-1/2: the modal mass is 1e-12 to 1e12 kg

# words by which texts that identify cases and batches know the kinds of contact, and the field's
# own
CONTACTS = {"separable": "unilateral", "bonded": "bilateral"}
IDENTITIES = {own: word for word, own in CONTACTS.items()}
# added later: their defaults are left out of the canonical form, so that older hashes stay valid
_LATER = (
    "contact_compliance",
    "contact_force",
    "damping_ratio",
    "disc",
    "friction_offset",
    "friction_decay",
)


_ORDER = (
    ("mu_k", "<=", operator.le, "mu_s"),
    ("a", "<", operator.lt, "r_0"),
    ("r_0", "<=", operator.le, "b"),
)
_Distance = Annotated[
    Real, AfterValidator(must(lambda value: 0 <= value < math.inf, "must be a finite number >= 0"))
]
# Beyond, the start of slip is lost in rounding.
_DECAY = must(lambda value: value <= 1e12 or value == math.inf, "must be at most 1e12 s/m, or inf")
# What only files and the command line accept is refused with the name of the function to use
# instead.
_CHOSEN = must(
    lambda value: value != AUTO, "must be a whole number; disc_model.choose_modes finds one"
)
_READ = must(
    lambda value: not isinstance(value, str),
    "must be a Disc: disc_model.Disc.from_csv reads a table of modes",
)


def _field(default: Any, unit: str, description: str, **rules: Any) -> Any:
    """A field with a unit, "" for a choice; `rules` are pydantic's keywords such as `ge`, `gt`,
    `lt` and `le`."""
    return Field(default, description=description, json_schema_extra={"unit": unit}, **rules)


Quantity = float | str  # a number, or a text that stands for one, with or without its unit
Column = Iterable[float | str]  # numbers of the modes of a table


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
        pair that has its node there (kg^-1/2); in a plate, at the height z, -(z/r_0) diameters amplitude. Needed for
        ``friction_offset="surface"`` alone
    static_compliance : of the whole disc at the slider (m/N, > 0), from which the compliance of the modes that are left
        out follows; None if it is not known
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
    omega: tuple[Annotated[Finite, within(FREQUENCIES)], ...]
    amplitude: tuple[Finite, ...]
    damping_ratio: tuple[Annotated[Finite, Field(ge=0, lt=1)], ...] = Field(
        (), validate_default=True
    )
    circles: tuple[Annotated[Count, Field(ge=0)], ...] = Field((), validate_default=True)
    tangential: tuple[Finite, ...] = ()
    static_compliance: Positive | None = None
    radii: tuple[Positive, ...] = ()
    shapes: tuple[tuple[Finite, ...], ...] = ()

    _report: DiscReport | None = pydantic.PrivateAttr(None)
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

        def __init__(  # noqa: PLR0913
            self, *, diameters: Column, omega: Column, amplitude: Column, damping_ratio: Column = ...,
            circles: Column = ..., tangential: Column = ..., static_compliance: Quantity | None = ...,
            radii: Column = ..., shapes: Iterable[Column] = ...,
        ) -> None: ...  # fmt: skip

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between columns, and refuse modes that are given twice."""
        count = len(self.diameters)
        faults = list[str]()
        if not 1 <= count <= MOST_MODES:
            faults.append(
                Fault(("diameters",), f"{count} modes", f"must be 1 to {MOST_MODES} modes")
            )
        for name in self._columns:
            column = getattr(self, name)
            if len(column) != count and (column or name in ("omega", "amplitude")):
                faults.append(
                    Fault(
                        (name,), f"{len(column)} values", f"must be as many as diameters, {count}"
                    )
                )
        lengths = {len(self.radii)} if self.radii else set()
        if {*map(len, self.shapes)} != lengths or lengths == {1}:
            rule = "must be two or more, with a value of the shape of every mode at each"
            faults.append(Fault(("radii",), f"{len(self.radii)} radii", rule))
        elif any(a >= b for a, b in pairwise(self.radii)):
            faults.append(Fault.of(("radii",), [*self.radii], "must ascend"))
        raise_faults(
            faults or limits_faults("largest amplitude", max(map(abs, self.amplitude)), AMPLITUDES)
        )
        counted = (
            "circles" not in self.model_fields_set
        )  # by frequency: then modes 5 % apart are no pair
        same = self.diameters if counted else [*zip(self.diameters, self.circles, strict=True)]
        for i, j in combinations(range(count), 2):
            apart = abs(self.omega[j] - self.omega[i]) / max(self.omega[i], self.omega[j])
            if same[i] == same[j] and (apart < 0.05 or not counted):
                rule = f"modes {i + 1} and {j + 1} have as many diameters and are {100 * apart:.2g} % apart: "
                rule += "the disc must be axisymmetric, with each pair of modes given once, by its mean frequency"
                rule += " (Disc.from_csv averages halves with pairs='mean')"
                raise_faults([Fault.of(("omega", str(j)), self.omega[j], rule)])
        return self

    @pydantic.model_serializer(mode="wrap")
    def _older(self, handler: Any) -> dict[str, Any]:
        """Leave out what was added later where it is empty, so that older hashes stay valid."""
        return {name: x for name, x in handler(self).items() if x or name != "tangential"}

    @field_validator("damping_ratio", "circles")
    @classmethod
    def _complete(cls, column: tuple[float, ...], info: Any) -> tuple[float, ...]:
        """Fill in a column that is left out: no damping, and circles counted by frequency."""
        diameters, omega = (info.data.get(name, ()) for name in ("diameters", "omega"))
        if column or len(omega) != len(diameters) or len(omega) > MOST_MODES:
            return column
        if info.field_name == "damping_ratio":
            return (0.0,) * len(diameters)
        order = sorted(range(len(omega)), key=omega.__getitem__)
        return tuple(
            sum(diameters[j] == diameters[i] for j in order[: order.index(i)])
            for i in range(len(omega))
        )

    def __eq__(self, other: object) -> bool:
        """Whether all numbers are equal; reports do not count."""
        return isinstance(other, Disc) and dict(self) == dict(other)

    @property
    def report(self) -> DiscReport | None:
        """What was used of the file from which the disc was read, and what was left out: a
        `disc_model.disc.given.DiscReport`; None of a disc that was made of numbers."""
        return self._report

    def with_report(self, report: DiscReport) -> Disc:
        """The same disc with a report on its file."""
        disc = self.model_copy()
        disc._report = report
        return disc

    @classmethod
    def from_csv(
        cls, path: str | os.PathLike[str], pairs: Literal["given", "mean"] = "given"
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
            equal diameters within 5 % in frequency become their mean, and `report` has the split

        Raises
        ------
        ParameterError
            If the file cannot be read or breaks a rule; the message names the column or mode, its value and the rule.

        Warns
        -----
        ImplausibleValue
            If frequencies or amplitudes are implausible, such as one frequency in kHz among others in Hz.

        Returns
        -------
        Disc
        """
        file = import_module("disc_model.data.dataset").regular_file(path)
        disc = import_module("disc_model.disc.files.table").read_disc(file, pairs)
        import_module("disc_model.disc.plausibility").warn_of_disc(disc)
        return disc

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the table that `from_csv` reads, with enough digits to restore each number exactly.

        Raises `ParameterError` if the path is not that of a file,
        `disc_model.data.dataset.WriteError` if it cannot be written.

        Examples
        --------
        >>> import disc_model as dm
        >>> disc = dm.Disc(diameters=[0, 1, 2], omega=[1490, 1515, 1820], amplitude=[1.53, 2.16, 2.15])
        >>> disc.to_csv("disc.csv")
        >>> dm.Disc.from_csv("disc.csv") == disc
        True
        """
        dataset = import_module("disc_model.data.dataset")
        text = import_module("disc_model.disc.files.table").table_text(self)
        file = dataset.regular_file(path)
        dataset.write_atomically(file, lambda name: Path(name).write_text(text, encoding="utf-8"))

    @classmethod
    def from_uff(
        cls,
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
            If the nodes are too few for the modes, poles seem to be in Hz, or frequencies or amplitudes are
            implausible.
        """
        file = import_module("disc_model.data.dataset").regular_file(path)
        places = import_module("disc_model.disc.files.place")
        place = places.Place.of(
            r_0=r_0, axis=axis, centre=centre, units=units, modal_mass=modal_mass
        )
        disc = import_module("disc_model.disc.files.universal_file").read_uff(file, place)
        import_module("disc_model.disc.plausibility").warn_of_disc(disc)
        return disc

    @classmethod
    def from_section(  # noqa: PLR0913
        cls,
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

        Warns
        -----
        ImplausibleValue
            If E or rho is not within a hundredth and a hundred times that of Table 1.
        """
        sections = import_module("disc_model.disc.files.section")
        mesh = section if size is None else sections.section(section, size)
        material = {"E": E, "nu": nu, "rho": rho, "damping_ratio": damping_ratio}
        return sections.disc_of_section(mesh, material, clamped, slider, highest_Hz)

    def __repr__(self) -> str:
        low, high = (end(self.omega) / math.tau for end in (min, max))
        return f"Disc({len(self.omega)} modes, {low:.0f} to {high:.0f} Hz)"

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """The table of modes in a notebook."""
        columns = {
            "diameters": self.diameters,
            "circles": self.circles,
            "frequency (Hz)": [f"{omega / math.tau:.5g}" for omega in self.omega],
            "amplitude (kg^-1/2)": [f"{amplitude:.5g}" for amplitude in self.amplitude],
            "damping ratio": [f"{damping:.3g}" for damping in self.damping_ratio],
        }
        return html_table(columns, zip(*columns.values(), strict=True))

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the modes that may be uncertain, by names such as omega_2_0: two nodal
        diameters, no circle."""
        return {
            f"{column}_{l}_{c}": value
            for column in ("omega", "amplitude", "damping_ratio")
            for l, c, value in zip(self.diameters, self.circles, getattr(self, column), strict=True)
        }

    def with_numbers(self, **changes: float) -> Disc:
        """The disc with some of its `numbers` changed."""
        values = [*(self.numbers | changes).values()]
        n = len(self.omega)
        return self.replace(
            omega=values[:n], amplitude=values[n : 2 * n], damping_ratio=values[2 * n : 3 * n]
        )

    def first(self, count: int) -> Disc:
        """The disc with only the first `count` modes of its table."""
        return self.replace(**{name: getattr(self, name)[:count] for name in self._columns})


class Parameters(Strict):
    """One case of disc and slider, in SI units. Defaults are the paper's Table 1.

    The radii of the plate must ascend, a < r_0 <= b, and mu_k must not be above mu_s.
    `disc_model.choose_modes` finds how many modes a tolerance asks for. A ratio may stand for its
    first one: mu_k_over_mu_s, k_p_over_k, c_p_over_c, a_over_b, r_0_over_b, h_over_b; it stays what
    it is in changed copies.

    Raises
    ------
    ParameterError
        Naming every parameter that breaks a rule, its value and the rule, in one message. Rules between parameters are
        checked where each value by itself is right.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N="385 N", Omega="145 rpm", mu_k_over_mu_s=0.5)
    >>> round(case.Omega, 3), case.mu_k, case.replace(mu_s=0.5).mu_k
    (15.184, 0.2, 0.25)
    >>> dm.Parameters(N=-1, Omga=3)
    Traceback (most recent call last):
        ...
    disc_model.errors.ParameterError: N=-1: must be >= 0; Omega: is required; ... did you mean Omega?
    """

    _word: ClassVar[str] = "parameter"
    _ratios: dict[str, float] = pydantic.PrivateAttr(default_factory=dict)

    N: Finite = _field(..., "N", "preload pressing the slider onto the disc", ge=0)
    Omega: Finite = _field(..., "rad/s", "speed of the drive point", ge=0)
    D_star: Finite = _field(1e-5, "N m s", "Kelvin-Voigt damping of the disc", ge=0)
    c: Finite = _field(0.0, "N s/m", "damper of the slider, normal to the disc", ge=0)
    c_p: Finite = _field(0.0, "N s/m", "damper of the slider, in the disc's plane", ge=0)
    k: Finite = _field(5e4, "N/m", "spring of the slider, normal to the disc", ge=0)
    k_p: Finite = _field(2e4, "N/m", "spring of the slider, in the disc's plane", ge=0)
    E: Finite = _field(150e9, "Pa", "Young's modulus of the disc", gt=0)
    m: Finite = _field(0.1, "kg", "mass of the slider", gt=0)
    mu_s: Finite = _field(0.4, "1", "coefficient of static friction", ge=0)
    mu_k: Finite = _field(0.24, "1", "coefficient of kinetic friction", ge=0)
    a: Finite = _field(0.044, "m", "inner radius of the disc, clamped", gt=0)
    b: Finite = _field(0.12, "m", "outer radius of the disc, free", gt=0)
    r_0: Finite = _field(0.1, "m", "radius at which the slider runs", gt=0)
    h: Finite = _field(0.002, "m", "thickness of the disc", gt=0)
    nu: Finite = _field(0.211, "1", "Poisson's ratio of the disc", gt=-1, lt=0.5)
    rho: Finite = _field(7200.0, "kg/m^3", "density of the disc", gt=0)
    n_diameters: Annotated[Count, BeforeValidator(_CHOSEN)] = _field(
        4, "1", "highest number of nodal diameters, -1 for a rigid disc", ge=-1, le=60
    )
    n_circles: Count = _field(0, "1", "highest number of nodal circles", ge=0, le=20)
    normalization: Literal["as_published", "orthonormal"] = _field(
        "as_published", "", "scale of the mode shapes: coefficient of J_l equal to 1, or Eq. (17)"
    )
    contact: Annotated[
        Literal["unilateral", "bilateral"],
        BeforeValidator(lambda word: CONTACTS.get(word, word) if isinstance(word, str) else word),
    ] = _field(
        "unilateral",
        "",
        "whether the slider may leave the disc: bilateral contact holds it, but lets it slide",
    )
    contact_compliance: _Distance | Literal["residual"] = _field(
        0.0,
        "m/N",
        "compliance of the contact, 0 if it is rigid; residual: that of the modes left out",
    )
    contact_force: Literal["vertical", "normal"] = _field(
        "vertical",
        "",
        "direction of the contact force: vertical as in the paper, or normal to the bent disc",
    )
    friction_offset: _Distance | Literal["surface"] = _field(
        0.0,
        "m",
        "height above the disc's middle plane at which friction acts; surface: h/2, or by the table of a disc",
    )
    friction_decay: Annotated[Real, AfterValidator(_DECAY)] = _field(
        math.inf,
        "s/m",
        "d of friction mu_k + (mu_s - mu_k)/(1 + d v) at slip speed v; inf: mu_k at any speed",
        ge=0,
    )
    damping_ratio: Annotated[Real, Field(ge=0, lt=1, allow_inf_nan=False)] | None = _field(
        None, "1", "damping ratio of every mode of the plate, from 0 to below 1, instead of D_star"
    )
    disc: Annotated[Disc, BeforeValidator(_READ, json_schema_input_type=str)] | None = _field(
        None, "", "a disc given by its modes, instead of the plate"
    )

    if TYPE_CHECKING:  # for type checkers, which know no texts with units from the fields

        def __init__(  # noqa: PLR0913
            self, *, N: Quantity, Omega: Quantity, D_star: Quantity = ..., c: Quantity = ..., c_p: Quantity = ...,
            k: Quantity = ..., k_p: Quantity = ..., E: Quantity = ..., m: Quantity = ..., mu_s: Quantity = ...,
            mu_k: Quantity = ..., a: Quantity = ..., b: Quantity = ..., r_0: Quantity = ..., h: Quantity = ...,
            nu: Quantity = ..., rho: Quantity = ..., n_diameters: Quantity = ..., n_circles: Quantity = ...,
            normalization: str = ..., contact: str = ..., contact_compliance: Quantity = ..., contact_force: str = ...,
            friction_offset: Quantity = ..., friction_decay: Quantity = ..., damping_ratio: Quantity | None = ...,
            disc: Disc | None = ..., mu_k_over_mu_s: float = ..., k_p_over_k: float = ..., c_p_over_c: float = ...,
            a_over_b: float = ..., r_0_over_b: float = ..., h_over_b: float = ...,
        ) -> None: ...  # fmt: skip

    @model_validator(mode="wrap")
    @classmethod
    def _with_ratios(cls, data: Any, handler: Any) -> Any:
        """Find the parameters that follow from ratios, and remember these."""
        if cls is not Parameters or not isinstance(data, dict) or not (data.keys() & RATIOS.keys()):
            return handler(data)
        faults: list[Fault] = []
        ratios = {name: data[name] for name in RATIOS if name in data}
        ratios = in_si(ratios, "1", faults, ())
        for name, value in ratios.items():
            if RATIOS[name][0] in data:
                faults.append(
                    Fault.of((name,), value, f"must not be given beside {RATIOS[name][0]}")
                )
            elif not (is_number(value) and 0 <= value < math.inf):
                faults.append(Fault.of((name,), value, "must be a finite number >= 0"))
        data = in_si(
            {name: value for name, value in data.items() if name not in ratios}, UNITS, faults, ()
        )
        raise_faults(faults)
        with suppress(ValueError):  # of a wrong value, which the fields report
            lower = {name: number(data[name]) for _, name in RATIOS.values() if name in data}
            followed = with_ratios(lower | ratios)
            data |= {RATIOS[name][0]: followed[RATIOS[name][0]] for name in ratios}
        p = handler(data)
        p.__pydantic_private__["_ratios"] = {name: float(value) for name, value in ratios.items()}
        return p

    @pydantic.model_serializer(mode="wrap")
    def _with_ratios_in_json(
        self, handler: Any, info: pydantic.SerializationInfo
    ) -> dict[str, Any]:
        """In JSON, have the ratios by which the case was given, and not what follows from them."""
        values = handler(self)
        if info.mode != "json" or not self._ratios:
            return values
        follow = {RATIOS[name][0] for name in self._ratios}
        return {name: x for name, x in values.items() if name not in follow} | self._ratios

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Check the rules between parameters, what a disc excludes, and that the plate has one
        damping. A rule on a parameter that is absent, as in `SomeParameters`, does not count."""
        values = dict(self)
        fields = type(self).model_fields
        if self.disc is not None and self.friction_offset == SURFACE and not self.disc.tangential:
            need = "must be a number for a disc whose table has no column tangential_per_sqrt_kg"
            raise_faults([Fault.of(("friction_offset",), SURFACE, need)])
        unused = [*PLATE, "damping_ratio"]
        rule = "where a disc is given: it is a parameter of the plate"
        if self.disc is None:
            unused = ["D_star"] * (self.damping_ratio is not None)
            rule = "where damping_ratio is given"
        changed = [
            name for name in sorted(unused) if values[name] not in (fields[name].default, AUTO)
        ]
        faults = [Fault.of((name,), values[name], f"must be left out {rule}") for name in changed]
        # a disc that is given by its modes has other radii than the plate
        for low, sign, holds, high in _ORDER if self.disc is None else _ORDER[:1]:
            lower = values[low]
            upper = values[high]
            if lower is not None and upper is not None and not holds(lower, upper):
                faults.append(Fault.of((low,), lower, f"must be {sign} {high}={as_text(upper)}"))
        E = self.E
        h = self.h
        nu = self.nu
        if E is not None and h is not None and nu is not None:
            rigidity = (
                E * (h * h * h) / 12 / (1 - nu**2)
            )  # unlike a power, a product overflows to inf
            if not 0 < rigidity < math.inf:
                rule = f"must give a finite, positive E h^3/12/(1-nu^2), not {as_text(rigidity)}"
                faults.append(Fault.of(("h",), h, rule))
        raise_faults(faults)
        return self

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some values changed; for a disc given by its modes also its
        `Disc.numbers`.

        A ratio by which the case was given, such as mu_k_over_mu_s, stays what it is, unless its
        first one changes. Raises `ParameterError` as the constructor.
        """
        if self.disc is not None and "disc" not in changes:
            numbers = {
                name: changes.pop(name) for name in self.disc.numbers.keys() & changes.keys()
            }
            changes |= {"disc": self.disc.with_numbers(**numbers)} if numbers else {}
        ratios = {
            name: value for name, value in self._ratios.items() if RATIOS[name][0] not in changes
        }
        ratios |= {name: value for name, value in changes.items() if name in RATIOS}
        follow = {RATIOS[name][0] for name in ratios}
        values = {name: getattr(self, name) for name in self.model_fields_set if name not in follow}
        return type(self)(**values | changes | ratios)

    @property
    def numbers(self) -> dict[str, float]:
        """All numbers of the case that may change continuously, by name: parameters, ratios and
        `Disc.numbers`."""
        unused = (
            {"D_star"}
            if self.damping_ratio is not None
            else {*PLATE}
            if self.disc is not None
            else set()
        )
        others = {
            "contact_compliance": 0,
            "friction_offset": 0,
            "friction_decay": math.inf,
        }  # of other models
        unused |= {name for name, value in others.items() if getattr(self, name) == value}
        numbers = {
            name: value
            for name, value in dict(self).items()
            if isinstance(value, float) and name not in unused
        }
        ratios = {
            name: numbers[a] / numbers[b]
            for name, (a, b) in RATIOS.items()
            if a in numbers and numbers.get(b)
        }
        return numbers | ratios | ({} if self.disc is None else self.disc.numbers)

    @property
    def stated(self) -> dict[str, Any]:
        """The values by name, with the ratios by which the case was given instead of the numbers
        that follow them."""
        follow = {RATIOS[name][0] for name in self._ratios}
        return {
            name: value for name, value in dict(self).items() if name not in follow
        } | self._ratios

    def __repr_args__(self) -> Iterator[tuple[str, Any]]:
        """What is given, and not as in Table 1."""
        return (
            (name, value) for name, value in self.stated.items() if DEFAULTS.get(name, ...) != value
        )

    def _repr_html_(self) -> str:
        """The case as a table in a notebook."""
        values = {name: value for name, value in self if value is not None}
        texts = {
            name: f"{value:.15g}" if is_number(value) else value for name, value in values.items()
        }
        fields = type(self).model_fields
        rows = (
            (x, text, self.unit(x).removeprefix("1"), fields[x].description)
            for x, text in texts.items()
        )
        return html_table(("symbol", "value", "unit", "meaning"), rows)

    @property
    def D(self) -> float:
        """Flexural rigidity E h^3/12/(1 - nu^2), N m."""
        return self.E * self.h**3 / 12 / (1 - self.nu**2)

    @property
    def canonical(self) -> dict[str, Any]:
        """The values that identify a case: all, except defaults of parameters that the paper's
        model does not have."""
        fields = type(self).model_fields
        values = in_words(self.model_dump(), IDENTITIES)
        return {
            name: x for name, x in values.items() if name not in _LATER or x != fields[name].default
        }

    @property
    def canonical_json(self) -> str:
        """The values as JSON with sorted keys, equal for equal parameters however they were
        written."""
        return canonical_json(self.canonical)

    @property
    def json_in_words(self) -> str:
        """The same in the words of the field, as files have it."""
        return canonical_json(in_words(self.canonical))

    @property
    def key(self) -> str:
        """Stable content hash: the first 12 hexadecimal digits of the sha256 of
        `canonical_json`."""
        return content_key(self.canonical_json)

    @classmethod
    def unit(cls, name: str) -> str:
        """SI unit of a parameter: "1" for a dimensionless one, "" for a choice or an unknown
        name."""
        return UNITS.get(name, "")


UNITS.update(Parameters._units({}))  # type: ignore[arg-type]

DEFAULTS = {
    name: field.default
    for name, field in Parameters.model_fields.items()
    if not field.is_required()
}


def _documented() -> str:
    """The docstring with the fields: meaning, unit, range and default of each."""
    lines = ["\nParameters\n----------"]
    signs = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}
    for name, field in Parameters.model_fields.items():
        limits = [
            f"{signs[x]} {getattr(rule, x):g}"
            for rule in field.metadata
            for x in signs
            if hasattr(rule, x)
        ]
        words = " or ".join(word for word in get_args(field.annotation) if isinstance(word, str))
        default = (
            "required"
            if field.is_required()
            else f"default {field.default:{'g' * is_number(field.default)}}"
        )
        phrase = ", ".join(
            filter(None, [Parameters.unit(name).removeprefix("1"), *limits, words, default])
        )
        lines.append(f"{name} : {field.description} ({phrase})")
    return inspect.cleandoc(str(Parameters.__doc__)).replace(
        "\nRaises\n", "\n".join([*lines, "\nRaises\n"])
    )


Parameters.__doc__ = _documented()


def in_words(values: Mapping[str, Any], words: Mapping[str, str] = CONTACTS) -> dict[str, Any]:
    """Values from a text that identifies a case, in the words of the field, as files and readers
    have them; or, by `IDENTITIES`, those of a case in the words of such a text."""
    return {
        name: words.get(value, value) if name == "contact" else value
        for name, value in values.items()
    }


def with_ratios(values: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a case, with the parameters that follow from the `RATIOS` among them."""
    completed = dict(values)
    for ratio in values.keys() & RATIOS.keys():
        name, other = RATIOS[ratio]
        completed[name] = values[ratio] * values.get(other, Parameters.model_fields[other].default)
    return completed


def case_of(values: Mapping[str, Any], discs: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a point that belong to its case, without starts and samples; a disc's name
    becomes its table. Ratios stay ratios, so that they are kept where the case is varied further."""
    known = (*Parameters.model_fields, *CHOOSING, *RATIOS)
    case = {name: value for name, value in values.items() if name in known}
    return case | ({"disc": discs[case["disc"]]} if isinstance(case.get("disc"), str) else {})


def foreign_case(p: object, name: str = "p") -> list[str]:
    """Faults of an argument that must be `Parameters`."""
    return [] if isinstance(p, Parameters) else [Fault.of((name,), p, "must be Parameters")]
