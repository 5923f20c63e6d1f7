"""The circle of nodes under the slider: the axis of the disc, its centre, and the nodes around
it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from disc_model.disc.plate import Array
from disc_model.errors import Fault, ParameterError

SAME_RADIUS = 1e-3  # of r_0: difference of radii on one circle, and of heights on one face
ROUNDED = 0.01  # of half a turn over the spacing of nodes, whose coordinates have few digits
TRIPLES = 4000  # of nodes through which circles are laid
TRIED = 50  # centres of such circles that are tried
MOST_COMPARED = 1000  # nodes with which these are compared
MOST_NODES = 0.5  # least share of nodes that are on circles around the centre
FEWEST = 3  # nodes that determine a circle
MOST_LISTED = 8  # radii in a message
BANDS = (0.1, 0.03, 0.01, 3e-3)  # of r_0, within which nodes draw the centre to themselves


@dataclass(frozen=True)
class Frame:
    """Cylindrical coordinates around the axis of a disc.

    Attributes
    ----------
    axis : (3,), unit vector from the disc to the slider
    centre : (3,), m, a point on the axis
    across : (2, 3), two unit vectors that form a right-handed system with the axis
    """

    axis: Array
    centre: Array
    across: Array

    @classmethod
    def along(cls, axis: Array, centre: Array) -> Frame:
        """The frame of an axis through a point, with its centre at the height of the origin."""
        helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
        first = np.cross(helper, axis)
        first /= np.linalg.norm(first)
        level = centre - (centre @ axis) * axis
        return cls(axis, level, np.stack([first, np.cross(axis, first)]))

    def plane(self, places: Array) -> Array:
        """Coordinates in the plane of the disc (n, 2), m."""
        return (places - self.centre) @ self.across.T

    def radii(self, places: Array) -> Array:
        """Distances from the axis (n,), m."""
        return np.hypot(*self.plane(places).T)

    def angles(self, places: Array) -> Array:
        """Angles around the axis (n,), rad."""
        x, y = self.plane(places).T
        return np.arctan2(y, x)

    def heights(self, places: Array) -> Array:
        """Distances along the axis from the centre (n,), m."""
        return (places - self.centre) @ self.axis

    def components(self, places: Array, motion: Array) -> Array:
        """Radial, tangential and axial components of displacements (n, 3)."""
        angle = self.angles(places)[:, None]
        first, second = self.across
        radial = np.cos(angle) * first + np.sin(angle) * second
        tangential = np.cross(self.axis, radial)
        in_plane = [np.sum(motion * direction, axis=1) for direction in (radial, tangential)]
        return np.stack([*in_plane, motion @ self.axis], axis=1)

    @property
    def text(self) -> str:
        """Words for the axis: "z through (0, 0, 0) m"."""
        if np.abs(self.axis).max() > 1 - 1e-6:
            i = int(np.argmax(np.abs(self.axis)))
            name = "-" * bool(self.axis[i] < 0) + "xyz"[i]
        else:
            name = _numbers_text(self.axis)
        return f"{name} through {_numbers_text(self.centre)} m"


@dataclass(frozen=True)
class Circle:
    """The nodes of a disc around the slider's circle.

    Attributes
    ----------
    frame : axis and centre
    members : (n,), which of the nodes are on the circle, on the face under the slider
    height : m along the axis; nan if the nodes of a circle have different heights
    count : number of nodes at different angles
    spacing : rad, median angle from one node to the next
    gap : rad, largest such angle
    """

    frame: Frame
    members: NDArray[np.bool_]
    height: float
    count: int
    spacing: float
    gap: float

    @property
    def covers(self) -> bool:
        """Whether nodes are on at least half of the circle."""
        return self.gap <= math.pi + 1.5 * self.spacing

    def of_nodes(self, chosen: NDArray[np.bool_], places: Array) -> Circle | None:
        """The circle of some of its nodes; None of fewer than three."""
        angles = self.frame.angles(places)[chosen]
        if _count(angles) < FEWEST:
            return None
        return _with_gaps(self.frame, chosen, self.height, angles)

    @property
    def most_diameters(self) -> int:
        """Number of nodal diameters up to which the nodes tell modes apart."""
        return max(0, math.ceil(math.pi / self.spacing - ROUNDED) - 1)


def find_circle(
    places: Array, r_0: float, axis: Array | None, centre: Array | None, name: str
) -> Circle:
    """Find the nodes around the slider's circle.

    Parameters
    ----------
    places : (n, 3), m, positions of the nodes that move
    r_0 : m
    axis, centre : unit vector, and point in m; found if they are None
    name : text for the file's datasets, in errors

    Raises
    ------
    ParameterError
        If there are fewer than three nodes on the circle, or none on half of it.
    """
    best: Circle | None = None
    for frame in _frames(places, r_0, axis, centre):
        circle = _circle(places, r_0, frame)
        if circle is not None and (best is None or _merit(circle) > _merit(best)):
            best = circle
    if best is None:
        raise ParameterError(Fault((), "", _absence(places, r_0, axis, centre, name)))
    if not best.covers:
        covered = math.degrees(math.tau - best.gap)
        rule = f"must have nodes around the circle r_0={r_0:g} m, and has {best.members.sum()} on "
        rule += f"{covered:.0f} degrees of it (axis {best.frame.text})"
        raise ParameterError(Fault((), "", rule))
    return best


def _merit(circle: Circle) -> tuple[bool, float]:
    """What makes a circle better than another one: that it is covered, and by more nodes, above all
    of one face."""
    weight = 1.0
    if math.isnan(circle.height):
        weight = 0.5
    return circle.covers, weight * circle.count


def _frames(places: Array, r_0: float, axis: Array | None, centre: Array | None) -> Iterator[Frame]:
    """Frames in which the circle may be found, those that are most usual first. A centre that is
    neither given nor the origin must be that of circles on which most nodes are."""
    directions = _axes(places)
    if axis is not None:
        directions = iter([axis])
    for direction in directions:
        if centre is not None:
            yield Frame.along(direction, centre)
            continue
        origin = Frame.along(direction, np.zeros(3))
        yield origin
        for frame in _elsewhere(places, r_0, origin):
            on_rings = sum(_rings(frame.radii(places)).values())
            if on_rings >= MOST_NODES * len(places):
                yield frame


def _elsewhere(places: Array, r_0: float, origin: Frame) -> Iterator[Frame]:
    """Frames along the same axis whose centres may be those of the nodes."""
    mean = places.mean(axis=0)
    middle = (places.min(axis=0) + places.max(axis=0)) / 2
    yield from _drawn(places, r_0, origin, BANDS)
    for start in (mean, middle):
        frame = Frame.along(origin.axis, start)
        yield frame
        yield from _drawn(places, r_0, frame, BANDS)
    yield from _of_triples(places, r_0, origin)


def _axes(places: Array) -> Iterator[Array]:
    """Directions of the axis: z, y, x, then the main directions of all nodes."""
    yield from np.eye(3)[::-1]
    _, vectors = np.linalg.eigh(np.cov(places.T))
    for vector in vectors.T:
        largest = vector[int(np.argmax(np.abs(vector)))]
        if abs(largest) < 1 - 1e-9:
            yield vector * np.sign(largest)


def _drawn(places: Array, r_0: float, frame: Frame, bands: Sequence[float]) -> Iterator[Frame]:
    """The frame with its centre drawn to that of the nodes near the circle, if there are enough,
    within ever smaller bands (of r_0)."""
    plane = frame.plane(places)
    middle = np.zeros(2)
    for band in bands:
        distance = np.hypot(*(plane - middle).T)
        near = np.abs(distance - r_0) < band * r_0
        if near.sum() < FEWEST:
            return
        # least squares for the centre of a circle of this radius: its residual is distance - r_0
        towards = (plane[near] - middle) / distance[near][:, None]
        step, *_ = np.linalg.lstsq(towards, distance[near] - r_0, rcond=None)
        middle = middle + step
    yield Frame(frame.axis, frame.centre + middle @ frame.across, frame.across)


def _of_triples(places: Array, r_0: float, frame: Frame) -> Iterator[Frame]:
    """The frame around the centre of circles of radius r_0 through three nodes, on which most nodes
    are: for nodes on part of a circle whose centre is elsewhere."""
    plane = frame.plane(places)
    drawn = np.random.default_rng(0).integers(len(plane), size=(TRIPLES, 3))
    a, b, c = (plane[drawn[:, i]] for i in range(3))
    u = b - a
    v = c - a
    u_x, u_y = u.T
    v_x, v_y = v.T
    area = u_x * v_y - u_y * v_x
    with np.errstate(divide="ignore", invalid="ignore"):
        u_squared = np.sum(u * u, axis=1)
        v_squared = np.sum(v * v, axis=1)
        x = (v_y * u_squared - u_y * v_squared) / (2 * area)
        y = (u_x * v_squared - v_x * u_squared) / (2 * area)
        fits = np.abs(np.hypot(x, y) - r_0) < SAME_RADIUS * r_0
    centres = a[fits] + np.stack([x[fits], y[fits]], axis=1)
    if len(centres) == 0:
        return
    some = plane[:: max(1, len(plane) // MOST_COMPARED)]
    counts = [
        np.sum(np.abs(np.hypot(*(some - centre).T) - r_0) < SAME_RADIUS * r_0)
        for centre in centres[:TRIED]
    ]
    best = centres[int(np.argmax(counts))]
    around = Frame.along(frame.axis, frame.centre + best @ frame.across)
    yield from _drawn(places, r_0, around, [2 * SAME_RADIUS, SAME_RADIUS])


def _circle(places: Array, r_0: float, frame: Frame) -> Circle | None:
    """The circle in a frame: the nodes of the uppermost face that has about as many as any; None if
    there are fewer than three."""
    on_circle = np.abs(frame.radii(places) - r_0) < SAME_RADIUS * r_0
    if on_circle.sum() < FEWEST:
        return None
    angles = frame.angles(places)
    heights = frame.heights(places)
    faces = [*_faces(heights, on_circle, SAME_RADIUS * r_0)]
    counts = [_count(angles[face]) for face in faces]
    whole = _count(angles[on_circle])
    for face, count in zip(faces, counts, strict=True):
        if 2 * count >= whole and count >= FEWEST:
            return _with_gaps(frame, face, float(heights[face].mean()), angles[face])
    if whole < FEWEST:
        return None
    return _with_gaps(frame, on_circle, math.nan, angles[on_circle])


def _faces(
    heights: Array, on_circle: NDArray[np.bool_], same: float
) -> Iterator[NDArray[np.bool_]]:
    """Nodes on the circle at one height, from the uppermost face down."""
    levels = np.sort(heights[on_circle])[::-1]
    gaps = levels[:-1] - levels[1:]
    begins = np.concatenate([[True], gaps > same])
    starts = levels[begins]
    ends = np.append(starts[1:], -np.inf)
    for start, end in zip(starts, ends, strict=True):
        yield on_circle & (heights <= start) & (heights > end)


def _count(angles: Array) -> int:
    """Number of different angles."""
    if len(angles) == 0:
        return 0
    return len(_distinct(angles))


def _distinct(angles: Array) -> Array:
    """Different angles, ascending from 0 to 2 pi."""
    turned = np.sort(np.mod(angles, math.tau))
    apart = np.diff(turned, prepend=turned[-1] - math.tau) > SAME_RADIUS
    return turned[apart]


def _with_gaps(frame: Frame, members: NDArray[np.bool_], height: float, angles: Array) -> Circle:
    """A circle with the angles between its nodes."""
    distinct = _distinct(angles)
    gaps = np.diff(distinct, append=distinct[0] + math.tau)
    spacing = float(np.median(gaps))
    return Circle(frame, members, height, len(distinct), spacing, float(gaps.max()))


def _absence(places: Array, r_0: float, axis: Array | None, centre: Array | None, name: str) -> str:
    """That there is no circle of nodes, and where the nodes are."""
    frames = [*_frames(places, r_0, axis, centre)]
    if axis is None:  # that to which the nodes are flattest
        spread = [float(np.ptp(frame.heights(places))) for frame in frames]
        flattest = min(spread) + SAME_RADIUS * r_0
        frames = [frame for frame, size in zip(frames, spread, strict=True) if size <= flattest]
    rings = [_rings(frame.radii(places)) for frame in frames]
    fullest = [max(ring.values(), default=0) for ring in rings]
    most = fullest.index(max(fullest))
    listed = sorted(rings[most])
    where = ", ".join(f"{radius:.4g}" for radius in listed[:MOST_LISTED])
    if len(listed) > MOST_LISTED:
        where += f", ... {listed[-1]:.4g}"
    if not listed:
        radii = frames[most].radii(places)
        where = f"{radii.min():.4g} to {radii.max():.4g}, of which no three are equal,"
    rule = f"must have {FEWEST} or more nodes at r_0={r_0:g} m. Around the axis "
    return f"{rule}{frames[most].text} there are nodes at {where} m. {name}"


def _rings(radii: Array) -> dict[float, int]:
    """Radii that three or more nodes share, and how many do."""
    values = np.sort(radii)
    same = SAME_RADIUS * max(values[-1], 1e-12)
    groups = np.split(values, np.flatnonzero(np.diff(values) > same) + 1)
    return {round(float(group.mean()), 9): len(group) for group in groups if len(group) >= FEWEST}


def _numbers_text(values: Iterable[float]) -> str:
    rounded = np.round([*values], 6) + 0.0  # adding zero turns -0.0 into 0.0
    return f"({', '.join(f'{value:.4g}' for value in rounded)})"
