"""What a reader should know of a disc from a universal file: doubts, and how the file was understood."""

import math
from collections.abc import Iterable, Sequence
from itertools import combinations

from disc_model.disc.files.circle import Circle
from disc_model.disc.files.harmonics import Wave, is_one_half
from disc_model.disc.files.universal_geometry import FileUnits
from disc_model.disc.files.universal_modes import FileMode
from disc_model.disc.files.universal_motion import Placed
from disc_model.disc.files.universal_waves import is_far_face
from disc_model.disc.given import SAME_PAIR
from disc_model.display import counted

TOLD_APART = 0.2  # relative difference of frequencies within which two single halves are doubted


def few_nodes(waves: Sequence[Wave], circle: Circle, unresolved: Sequence[float]) -> list[str]:
    """Doubts whether the nodes are enough for the modes."""
    most = circle.most_diameters
    text = f"{circle.count} nodes on the circle tell modes of up to "
    text += f"{counted(most, 'nodal diameter')} apart"
    if unresolved:
        frequencies = ", ".join(f"{frequency:.5g}" for frequency in unresolved)
        return [f"{text}: the modes at {frequencies} Hz, which follow none of these, are left out"]
    if max(wave.diameters for wave in waves) >= most:
        return [f"{text}: modes of more may be taken for modes of fewer"]
    return []


def single_halves(groups: Sequence[Sequence[Wave]]) -> list[str]:
    """Doubts about pairs whose halves are too far apart, so that each half became a mode."""
    doubts = []
    for first, second in combinations(groups, 2):
        low = first[0]
        high = second[0]
        apart = abs(high.omega - low.omega) / max(high.omega, low.omega)
        single = low.diameters > 0 and is_one_half(first) and is_one_half(second)
        if low.diameters != high.diameters or not single or apart > TOLD_APART:
            continue
        lower = low.omega / math.tau
        upper = high.omega / math.tau
        text = f"modes of {counted(low.diameters, 'nodal diameter')} at "
        text += f"{lower:.5g} and {upper:.5g} Hz are kept as two, "
        text += f"{100 * apart:.2g} % apart: the "
        doubts.append(f"{text}halves of one pair are within {100 * SAME_PAIR:g} %")
    return doubts


def far_face(waves: Sequence[Wave], circle: Circle) -> list[str]:
    """Doubts whether the axis points to the slider."""
    if not is_far_face(waves):
        return []
    text = "the surface moves as that of a face away from the slider: "
    return [f"{text}the axis {circle.frame.text} must point from the disc to the slider"]


def notes_on(
    placed: Placed, units: FileUnits, modes: Sequence[FileMode], tangential: bool
) -> Iterable[str]:
    """How the file was understood."""
    circle = placed.circle
    yield f"units of length and force: {units.source}"
    yield f"axis of the disc, towards the slider: {circle.frame.text}"
    height = "at different heights"
    if math.isfinite(circle.height):
        height = f"at the height {circle.height:.4g} m"
    nodes = f"{circle.count} nodes on the slider's circle, {height}"
    yield f"{nodes}, for up to {circle.most_diameters} nodal diameters"
    if placed.systems:
        yield placed.systems
    kinds = dict.fromkeys(mode.kind for mode in modes)
    yield f"shapes of {' and '.join(kinds)}"
    if tangential:
        yield "tangential amplitudes from the motion of these nodes along the circle"
    else:
        yield "no tangential amplitudes: the file has no motion along the circle"
