"""A writer of universal files in the dialects of modal software and finite elements, and a disc
whose modes are known."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

RADII = (0.08, 0.1, 0.13)
R_0 = 0.1


@dataclass(frozen=True)
class Half:
    """One half of a mode: rad/s, damping ratio, and motion in kg^-1/2 along the slider's circle, of
    which that on other circles is a multiple."""

    diameters: int
    omega: float
    damping_ratio: float
    amplitude: float
    tangential: float
    turn: float = 0.3
    radial: float = 0.1

    def motion(self, r: Any, angle: Any) -> Any:
        """Radial, tangential and axial displacement (n, 3), seen against the axis."""
        phase = self.diameters * angle - self.turn
        axial = self.amplitude * np.cos(phase)
        # the half whose normal motion is sin(l theta) moves by t cos(l theta)
        along = -self.tangential * np.sin(phase)
        growth = (r / R_0) ** 2
        across = self.radial * np.cos(phase)
        return growth[:, None] * np.stack([across, along, axial], axis=1)


def halves(
    modes: Iterable[tuple[int, float, float, float]], split: float = 1e-3, damping: float = 2e-3
) -> list[Half]:
    """Both halves of pairs of (diameters, Hz, amplitude, tangential), turned, with frequencies
    apart by `split`."""
    found = []
    for l, frequency, amplitude, tangential in modes:
        omega = 2 * np.pi * frequency
        if l == 0:
            found.append(Half(0, omega, damping, amplitude, 0.0, turn=0.0))
            continue
        for side, turn in ((-1, 0.3 * l), (1, 0.3 * l + np.pi / 2)):
            shifted = omega * (1 + side * split / 2)
            found.append(Half(l, shifted, damping, amplitude, tangential, turn=turn))
    return found


MODES = [
    (1, 551.0, 0.55, -0.27),
    (0, 929.0, 0.43, 0.0),
    (2, 1212.0, 0.54, -0.13),
    (3, 1920.0, 0.5, -0.1),
]


@dataclass
class Dialect:
    """How a file is written.

    results, nodes : numbers of datasets, 55 or 2414, 15 or 2411
    axis, centre : m, of the disc in the file's coordinates
    length, force : file units per m and N; `units`: whether dataset 164 states them
    complex : whether modes are complex, of this analysis type
    scale : modal mass of normal modes; of complex ones psi is phi times its root
    stated : whether the file has the scale, or 0 in its place
    mass : whether a complex mode has its modal mass in the place of modal A
    conjugate : whether poles have negative imaginary parts
    turned_by : rad, phase of complex shapes that modal A does not have
    modal_b : whether modal B is there; `in_hertz`: whether poles are in Hz
    order : displacement, velocity, acceleration
    exponent : letter of exponents
    values : numbers of values at each node, 3 or 6
    angles : number of nodes on a circle; `arc`: rad, part of it
    heights : m, of the faces with nodes
    local : displacements in a cylindrical system around the axis, dataset 2420
    texts : lines for readers, in which {pole} is the imaginary part of the pole
    """

    results: int = 55
    nodes: int = 15
    axis: Sequence[float] = (0.0, 0.0, 1.0)
    centre: Sequence[float] = (0.0, 0.0, 0.0)
    length: float = 1.0
    force: float = 1.0
    units: bool = False
    complex: int = 0
    scale: complex = 1.0
    stated: bool = True
    mass: bool = False
    turned_by: float = 0.0
    conjugate: bool = False
    modal_b: bool = False
    in_hertz: bool = False
    order: int = 0
    hysteretic: bool = False
    exponent: str = "E"
    values: int = 3
    angles: int = 24
    arc: float = 2 * np.pi
    heights: Sequence[float] = (0.006,)
    axial_only: bool = False
    local: bool = False
    texts: str = "NONE"
    newline: str = "\n"
    extra: Sequence[str] = field(default_factory=list)

    def write(self, path: Path, modes: Iterable[Half]) -> Path:
        """Write a file with these modes."""
        lines: list[str] = []
        if self.units:
            lines += self.unit_lines()
        r, angle, height = self.grid()
        if self.local:
            lines += self.system_lines()
        lines += self.node_lines(r, angle, height)
        lines += self.extra
        lines += self.all_mode_lines(modes)
        path.write_bytes(self.newline.join([*lines, ""]).encode("latin-1"))
        return path

    def all_mode_lines(self, modes: Iterable[Half]) -> list[str]:
        """Datasets of all modes."""
        lines = []
        r, angle, height = self.grid()
        for number, half in enumerate(modes, 1):
            motion = half.motion(r, angle)
            # the lower face of a plate moves tangentially the other way
            if len(self.heights) > 1:
                motion[:, 1] *= np.sign(height)
            lines += self.mode_lines(number, half, self.turned(motion, angle))
        return lines

    def grid(self) -> tuple[Any, Any, Any]:
        """Cylindrical coordinates of all nodes."""
        step = self.arc / self.angles
        grids = np.meshgrid(RADII, np.arange(self.angles) * step, self.heights, indexing="ij")
        r, angle, height = (grid.ravel() for grid in grids)
        return r, angle, height

    def basis(self) -> Any:
        """Directions of x, y, z of the disc in the file, in rows."""
        z = np.array(self.axis) / np.linalg.norm(self.axis)
        x = np.cross([0.2, 1.0, 0.3], z)
        x /= np.linalg.norm(x)
        if np.allclose(z, [0, 0, 1]):
            x = np.array([1.0, 0.0, 0.0])
        return np.stack([x, np.cross(z, x), z])

    def turned(self, motion: Any, angle: Any) -> Any:
        """Displacements in the file's directions."""
        if self.axial_only:
            motion = motion * [0.0, 0.0, 1.0]
        if self.local:
            return motion
        cosine = np.cos(angle)
        sine = np.sin(angle)
        x = motion[:, 0] * cosine - motion[:, 1] * sine
        y = motion[:, 0] * sine + motion[:, 1] * cosine
        return np.stack([x, y, motion[:, 2]], axis=1) @ self.basis()

    def real(self, *values: float, width: int = 13, digits: int = 5) -> str:
        """Real numbers in fields of fixed width."""
        text = "".join(f"{value:{width}.{digits}E}" for value in values)
        return text.replace("E", self.exponent)

    def unit_lines(self) -> list[str]:
        """Dataset 164."""
        factors = self.real(self.length, self.force, 1.0, width=25, digits=17)
        return [*begin(164), whole(9) + "user-defined        " + whole(2), factors, END]

    def system_lines(self) -> list[str]:
        """Dataset 2420 with a cylindrical system, number 7."""
        rows = [*self.basis(), np.array(self.centre) * self.length]
        written = [self.real(*row, width=25, digits=16) for row in rows]
        return [*begin(2420), whole(1), "Part1", whole(7, 1, 8), "disc", *written, END]

    def node_lines(self, r: Any, angle: Any, height: Any) -> list[str]:
        """Dataset 15 or 2411."""
        local = np.stack([r * np.cos(angle), r * np.sin(angle), height], axis=1)
        places = (local @ self.basis() + self.centre) * self.length
        lines = begin(self.nodes)
        moves_in = 0
        if self.local:
            moves_in = 7
        for number, place in enumerate(places, 1):
            head = whole(number, 0, moves_in, 8)
            if self.nodes == 15:
                lines.append(head + self.real(*place))
            else:
                lines += [head, self.real(*place, width=25, digits=16)]
        return [*lines, END]

    def mode_lines(self, number: int, half: Half, motion: Any) -> list[str]:
        """Dataset 55 or 2414 of a mode."""
        pole = half.omega * complex(-half.damping_ratio, np.sqrt(1 - half.damping_ratio**2))
        # modal mass in the file's unit, of which this is one kg
        unit_mass = self.force / self.length
        if self.complex:
            motion = motion * np.sqrt(complex(self.scale)) * pole**self.order
            motion = motion * np.exp(1j * self.turned_by)
            if self.mass:
                of_mass = 1
            else:
                of_mass = 2j * pole.imag
            modal_a = of_mass * self.scale * unit_mass * self.stated
            modal_b = -pole * modal_a * self.modal_b
            written = pole
            if self.in_hertz:
                written = pole / (2 * np.pi)
            if self.conjugate:
                motion = motion.conj()
                written, modal_a, modal_b = np.conj([written, modal_a, modal_b]).tolist()
            reals = [*parts(written), *parts(modal_a), *parts(modal_b)]
            kind = 5
        else:
            mass = complex(self.scale).real
            motion = motion * np.sqrt(mass) * half.omega**self.order
            viscous = half.damping_ratio
            hysteretic = 0.0
            if self.hysteretic:
                viscous = 0.0
                hysteretic = 2 * half.damping_ratio
            reals = [half.omega / (2 * np.pi), mass * unit_mass * self.stated, viscous, hysteretic]
            kind = 2
        analysis = self.complex or 2
        if self.order == 0:
            data = 8
        else:
            data = 10 + self.order
        characteristic = 3
        if self.values == 3:
            characteristic = 2
        head = [1, analysis, characteristic, data, kind, self.values]
        texts = [self.texts.format(pole=reals[1])] * 5
        if self.results == 55:
            lines = [*begin(55), *texts, whole(*head)]
            lines += [whole(2, len(reals), 1, number), self.real(*reals)]
        else:
            lines = [*begin(2414), whole(number), f"mode {number}", whole(1), *texts]
            lines += [whole(*head), whole(0, 0, 1, 0, 0, number, 0, 0), whole(0, 0)]
            if not self.complex:
                normal = [0.0, reals[0], 0.0, *reals[1:4]]
            else:
                normal = [0.0] * 6
            if self.complex:
                eigen = reals
            else:
                eigen = [0.0] * 6
            lines += [self.real(*normal), self.real(*eigen)]
        for i, row in enumerate(motion, 1):
            row = np.concatenate([row, np.zeros(self.values - 3)])
            if self.complex:
                cells = [x for value in row for x in parts(value)]
            else:
                cells = [*row]
            lines.append(whole(i))
            lines += [self.real(*cells[j : j + 6]) for j in range(0, len(cells), 6)]
        return [*lines, END]


END = "    -1"


def begin(number: int) -> list[str]:
    """The first lines of a dataset."""
    return [END, f"{number:6d}"]


def whole(*values: int) -> str:
    """Whole numbers in fields of ten columns."""
    return "".join(f"{value:10d}" for value in values)


def parts(value: complex) -> list[float]:
    """Real and imaginary part."""
    return [complex(value).real, complex(value).imag]
