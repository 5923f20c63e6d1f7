"""Modes of universal files: datasets 55 and 2414, and their scaling.

The shape phi of a real mode that is normalised by the modal mass is the same in each scaling of a
file: phi = psi / sqrt(m) with a modal mass m, and phi = Re(psi sqrt(2 i omega_d / A)) with a modal
A, where psi psi^T / (A (s - lambda)) is the mode's part of the receptance and omega_d the imaginary
part of its pole lambda.
"""

from __future__ import annotations

import cmath
import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.files.universal_sets import DataSet, integers, numbers_in, reals
from disc_model.errors import require
from disc_model.modal_disc import FREQUENCIES

NORMAL_MODE = 2
COMPLEX_MODE = 3  # of equations of the first order
COMPLEX_MODE_2 = 7  # of equations of the second order
ANALYSES = {
    0: "unknown analysis",
    1: "static analysis",
    NORMAL_MODE: "normal mode",
    COMPLEX_MODE: "complex mode",
    4: "transient analysis",
    5: "frequency response or deflection shape",
    6: "buckling",
    COMPLEX_MODE_2: "complex mode",
    9: "static analysis",
}
DATA = {
    2: "stress",
    3: "strain",
    4: "element forces",
    7: "strain energy",
    9: "reaction forces",
    10: "kinetic energy",
}
"""Kinds of data by their number, in messages."""
VECTORS = (2, 3)  # data characteristics: three displacements, with and without three rotations
KINDS = {
    0: ("data of no stated kind, taken for displacement", 0),
    1: ("data of no stated kind, taken for displacement", 0),
    8: ("displacement", 0),
    11: ("velocity", 1),
    12: ("acceleration", 2),
}
"""Motion by the number of its kind of data: its name, and the derivative of displacement in time
that it is."""
AT_NODES = 1  # location of the data of a dataset 2414
REAL_DATA = (2, 4)  # of single and double precision
COMPLEX_DATA = (5, 6)
AGREES = 0.02  # relative difference of two statements of the same frequency
UNIT_MASS = 1e-3  # relative difference of a modal mass from one unit
_FREQUENCY = re.compile(
    r"(?:FREQUENCY|FREQ|FR|F)\s*[:=]?\s*(\d+\.?\d*(?:[ED][-+]?\d+)?)(?![\d.])(?!\s*RAD)"
)


class Header(NamedTuple):
    """What the first records of a dataset of results say.

    analysis, characteristic, kind, type, width : numbers of record 6 of dataset 55
    at_nodes : whether the values are those of nodes
    reals : frequency, modal mass, viscous and hysteretic damping of a normal mode; real and
        imaginary parts of eigenvalue, modal A, modal B of a complex one
    texts : the lines for readers
    records : number of records before the data
    """

    analysis: int
    characteristic: int
    kind: int
    type: int
    width: int
    at_nodes: bool
    reals: list[float]
    texts: list[str]
    records: int


@dataclass(frozen=True)
class FileMode:
    """A mode as a file has it.

    Attributes
    ----------
    data : its dataset
    analysis : `NORMAL_MODE`, `COMPLEX_MODE` or `COMPLEX_MODE_2`
    nodes : (n,), numbers of nodes
    motion : (n, 3), complex, of this kind: displacement, velocity or acceleration
    order : derivative of displacement in time that `motion` is
    pole : 1/s, with a positive imaginary part
    scale : modal mass of a normal mode, modal A of a complex one
    modal_b : of a complex mode; 0 if there is none
    stated : frequency in the lines for readers, as it is written; nan if there is none
    """

    data: DataSet
    analysis: int
    nodes: NDArray[np.int64]
    motion: NDArray[np.complex128]
    kind: str
    order: int
    pole: complex
    scale: complex
    modal_b: complex
    stated: float

    @property
    def name(self) -> str:
        """Words for the mode in messages."""
        return f"the mode at {abs(self.pole) / math.tau:.6g} Hz"

    @property
    def may_have_mass(self) -> bool:
        """Whether the scale may be a modal mass, which dataset 2414 has in the place of modal A
        for equations of the second order."""
        return self.analysis == COMPLEX_MODE_2 and self.data.number == 2414


class Shape(NamedTuple):
    """A shape that is normalised by its modal mass.

    place : place of its dataset in the file
    omega, damping_ratio : rad/s, 1
    nodes : (n,), numbers of nodes
    motion : (n, 3), kg^-1/2
    in_phase : share of the squared motion that is in phase
    """

    place: int
    omega: float
    damping_ratio: float
    nodes: NDArray[np.int64]
    motion: NDArray[np.float64]
    in_phase: float


def read_modes(sets: Iterable[DataSet]) -> tuple[list[FileMode], Counter[str]]:
    """Read the modes of a file, and count what else its datasets 55 and 2414 hold."""
    modes: list[FileMode] = []
    left_out: Counter[str] = Counter()
    for data in sets:
        if data.number not in (55, 2414):
            continue
        head = _header(data)
        reason = _other_than_modes(head)
        if reason:
            left_out[reason] += 1
            continue
        mode = _mode(data, head)
        if _oscillates(mode):
            modes.append(mode)
        else:
            left_out["mode at 0 Hz or without oscillation"] += 1
    return modes, left_out


def _header(data: DataSet) -> Header:
    """The header of a dataset 55 or 2414."""
    if data.number == 55:
        return _header_55(data)
    return _header_2414(data)


def _header_55(data: DataSet) -> Header:
    """The header of a dataset 55."""
    analysis, characteristic, kind, data_type, width = integers(data, 5, 6)[1:6]
    n_integers, n_reals = integers(data, 6, 2)[:2]
    first_reals = 6 + math.ceil((2 + max(n_integers, 0)) / 8)
    n_records = max(1, math.ceil(n_reals / 6))
    values: list[float] = []
    for i in range(n_records):
        values += reals(data, first_reals + i)
    return Header(
        analysis=analysis,
        characteristic=characteristic,
        kind=kind,
        type=data_type,
        width=width,
        at_nodes=True,
        reals=values,
        texts=data.lines[:5],
        records=first_reals + n_records,
    )


def _header_2414(data: DataSet) -> Header:
    """The header of a dataset 2414."""
    location = integers(data, 2, 1)[0]
    analysis, characteristic, kind, data_type, width = integers(data, 8, 6)[1:6]
    first = reals(data, 11)
    first += [0.0] * (6 - len(first))
    specific = reals(data, 12)
    if analysis == NORMAL_MODE:
        specific = [first[1], *first[3:6]]
    return Header(
        analysis=analysis,
        characteristic=characteristic,
        kind=kind,
        type=data_type,
        width=width,
        at_nodes=location == AT_NODES,
        reals=specific,
        texts=[data.lines[1], *data.lines[3:8]],
        records=13,
    )


def _other_than_modes(head: Header) -> str:
    """What a dataset holds if it is no mode of displacements at nodes; "" if it is one."""
    analysis = ANALYSES.get(head.analysis, f"analysis of type {head.analysis}")
    what = ""
    if head.analysis not in (NORMAL_MODE, COMPLEX_MODE, COMPLEX_MODE_2):
        what = analysis
    elif not head.at_nodes:
        what = f"{analysis} on elements"
    elif head.kind not in KINDS:
        what = f"{DATA.get(head.kind, f'data of type {head.kind}')} of a {analysis}"
    elif head.characteristic not in VECTORS and not _is_untold_vector(head):
        what = f"{analysis} without three displacements a node"
    elif head.type not in REAL_DATA + COMPLEX_DATA:
        what = f"{analysis} with data of type {head.type}"
    return what


def _is_untold_vector(head: Header) -> bool:
    """Whether data whose characteristic is not stated are vectors by their number."""
    return head.characteristic == 0 and head.width in (3, 6)


def _mode(data: DataSet, head: Header) -> FileMode:
    """The mode of a dataset."""
    nodes, motion = _node_values(data, head)
    name, order = KINDS[head.kind]
    values = head.reals + [0.0] * (6 - len(head.reals))
    if head.analysis == NORMAL_MODE:
        frequency, mass, viscous, hysteretic = values[:4]
        ratio = viscous + hysteretic / 2  # the same loss at resonance
        if not abs(ratio) < 1:
            raise data.fault(f"must have a damping ratio below 1, and not {ratio:g}")
        pole = math.tau * frequency * complex(-ratio, math.sqrt(1 - ratio**2))
        scale = complex(mass)
        modal_b = 0j
    else:
        pole = complex(values[0], values[1])
        scale = complex(values[2], values[3])
        modal_b = complex(values[4], values[5])
    if pole.imag < 0:  # the conjugate mode
        pole, scale, modal_b = pole.conjugate(), scale.conjugate(), modal_b.conjugate()
        motion = motion.conj()
    return FileMode(
        data=data,
        analysis=head.analysis,
        nodes=nodes,
        motion=motion,
        kind=name,
        order=order,
        pole=pole,
        scale=scale,
        modal_b=modal_b,
        stated=_stated_frequency(head.texts),
    )


def _node_values(data: DataSet, head: Header) -> tuple[NDArray[np.int64], NDArray[np.complex128]]:
    """Numbers of the nodes of a dataset, and their three displacements (n, 3)."""
    is_complex = head.type in COMPLEX_DATA
    count = head.width * (1 + is_complex)
    values = numbers_in(data, head.records)
    if head.width < 3 or values.size % (1 + count):
        rule = f"must have a number and {count} values for each node, and has {values.size} numbers"
        raise data.fault(rule)
    table = values.reshape(-1, 1 + count)
    nodes = table[:, 0].astype(np.int64)
    if not (np.all(np.isfinite(table)) and np.array_equal(nodes, table[:, 0])):
        raise data.fault(f"must have a whole number and {count} finite values for each node")
    parts = table[:, 1:]
    motion = parts.astype(np.complex128)
    if is_complex:
        motion = parts[:, ::2] + 1j * parts[:, 1::2]
    return nodes, motion[:, :3]


def _stated_frequency(texts: Iterable[str]) -> float:
    """The frequency that a line for readers states; nan if none does."""
    for text in texts:
        match = _FREQUENCY.search(text.upper())
        if match:
            return float(match[1].replace("D", "E"))
    return math.nan


def _oscillates(mode: FileMode) -> bool:
    """Whether a mode is neither a motion of the free body nor overdamped."""
    return abs(mode.pole) >= FREQUENCIES[0] and mode.pole.imag > 0


# ---- Poles


class Evidence(NamedTuple):
    """What tells the unit of poles.

    ratios : of each mode
    in_radians, in_hertz : what they are with either unit
    error : their relative error
    reason : words for the second case
    """

    ratios: list[float]
    in_radians: float
    in_hertz: float
    error: float
    reason: str


def poles_in_hertz(modes: Iterable[FileMode]) -> str:
    """Why the poles of complex modes seem to be in Hz; "" if they are in rad/s or nothing tells.

    Modal B is -pole times modal A, lines for readers may state frequencies, and most programs scale
    shapes to a modal mass of 1.
    """
    scaled = [mode for mode in modes if _has_modal_a(mode)]
    by_b = [abs(mode.modal_b / mode.scale / mode.pole) for mode in scaled if mode.modal_b != 0]
    by_text = [mode.stated / abs(mode.pole) for mode in scaled if mode.stated > 0]
    by_mass = [abs(mode.scale) / (2 * mode.pole.imag) for mode in scaled]
    told = "texts of the file state these frequencies"
    unit_mass = "with them modal A gives each mode a modal mass of 2 pi"
    for evidence in (
        Evidence(by_b, 1.0, math.tau, AGREES, "modal A and modal B say so"),
        Evidence(by_text, 1 / math.tau, 1.0, AGREES, told),
        Evidence(by_mass, 1.0, math.tau, UNIT_MASS, unit_mass),
    ):
        if _all_near(evidence.ratios, evidence.in_radians, evidence.error):
            return ""
        if _all_near(evidence.ratios, evidence.in_hertz, evidence.error):
            return evidence.reason
    return ""


def _has_modal_a(mode: FileMode) -> bool:
    """Whether a mode is complex and its scale is a modal A for certain."""
    return mode.analysis != NORMAL_MODE and not mode.may_have_mass and mode.scale != 0


def _all_near(ratios: Sequence[float], value: float, relative: float) -> bool:
    """Whether all ratios are close to a value; not if there are none."""
    return bool(ratios) and all(abs(ratio / value - 1) < relative for ratio in ratios)


def with_pole_in_radians(mode: FileMode) -> FileMode:
    """A mode with its pole in rad/s where the file has it in Hz."""
    if mode.analysis == NORMAL_MODE:
        return mode
    return replace(mode, pole=math.tau * mode.pole)


# ---- Scaling


def with_modal_mass(mode: FileMode, modal_mass: float) -> FileMode:
    """A mode with this modal mass, in the file's unit, if the file has no scale."""
    if mode.scale != 0:
        return mode
    scale = complex(modal_mass)
    if mode.analysis != NORMAL_MODE:
        scale *= 2j * mode.pole.imag
    return replace(mode, scale=scale)


def normalised(mode: FileMode, unit_mass: float) -> Shape:
    """Normalise the shape of a mode by its modal mass; `unit_mass`: kg in the file's unit.

    Raises `ParameterError` if the file does not scale it, or the mode grows.
    """
    if mode.pole.real > 0:
        rule = f"has a pole with a positive real part, {mode.name}: the disc alone cannot grow"
        raise mode.data.fault(rule)
    omega = abs(mode.pole)
    where = f"{mode.name}, dataset no. {mode.data.place}"
    need = f"({where}): shapes need a scale; modal_mass=1 if they are mass-normalised"
    if mode.analysis == NORMAL_MODE:
        require((mode.scale.real > 0, "modal mass", mode.scale.real, f"must be > 0 {need}"))
        phi, in_phase = _normal(mode.motion / omega**mode.order, mode.scale.real)
    else:
        require((mode.scale != 0, "modal A", abs(mode.scale), f"must not be 0 {need}"))
        phi, in_phase = _complex(mode, mode.motion / mode.pole**mode.order)
    damping_ratio = max(0.0, -mode.pole.real / omega)
    motion = phi / math.sqrt(unit_mass)
    return Shape(mode.data.place, omega, damping_ratio, mode.nodes, motion, in_phase)


def _normal(motion: NDArray[np.complex128], mass: float) -> tuple[NDArray[np.float64], float]:
    """A normal mode over the root of its mass, and its share in phase; values with phases are
    turned to be as real as possible."""
    turn = cmath.phase(complex(np.sum(motion**2))) / 2
    return _in_phase(motion * cmath.exp(-1j * turn) / math.sqrt(mass))


def _complex(mode: FileMode, motion: NDArray[np.complex128]) -> tuple[NDArray[np.float64], float]:
    """A complex mode scaled by its modal A, and its share in phase. Where the file may have a modal
    mass instead, the scale that makes the shape real is taken: both differ by 45 degrees."""
    by_a = _in_phase(motion * cmath.sqrt(2j * mode.pole.imag / mode.scale))
    if not mode.may_have_mass:
        return by_a
    by_mass = _in_phase(motion / cmath.sqrt(mode.scale))
    return max(by_a, by_mass, key=lambda found: found[1])


def _in_phase(motion: NDArray[np.complex128]) -> tuple[NDArray[np.float64], float]:
    """The real part of a shape, and its share of the sum of squares; 1 of nothing."""
    total = float(np.sum(np.abs(motion) ** 2))
    if total == 0:
        return motion.real, 1.0
    return motion.real, float(np.sum(motion.real**2)) / total
