"""What a reader should know of a disc from a universal file: doubts, and how the file was understood."""

import math
from collections.abc import Iterable, Sequence
from itertools import combinations, product

from disc_model.disc.files.circle import Circle
from disc_model.disc.files.harmonics import Wave, is_one_half
from disc_model.disc.files.universal_geometry import FileUnits
from disc_model.disc.files.universal_modes import FileMode
from disc_model.disc.files.universal_motion import Placed
from disc_model.disc.files.universal_waves import is_far_face
from disc_model.disc.given import SAME_PAIR
from disc_model.display import counted

TOLD_APART = 0.2  # relative difference of frequencies within which two single halves are doubted
ONE_FREQUENCY = 2e-4  # relative difference within which frequencies are one, told several times
MOST_TURNED = 20.0  # degrees of phase by which halves may miss the quarter of a wave between them


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
        if apart < SAME_PAIR:
            text += f"and {_turned_text(low, high)}"
        else:
            text += f"{100 * apart:.2g} % apart: the halves of one pair are within {100 * SAME_PAIR:g} %"
        doubts.append(text)
    return doubts


def turned_halves(groups: Iterable[Sequence[Wave]]) -> Iterable[str]:
    """Yield doubts about pairs whose antinodes do not lie between each other."""
    for group in groups:
        frequencies = _frequencies(group)
        if group[0].diameters == 0 or len(frequencies) != 2:
            continue
        lower, upper = frequencies
        combined = product(lower, upper)
        low, high = min(combined, key=lambda halves: abs(90 - _phase_apart(*halves)))
        if abs(90 - _phase_apart(low, high)) > MOST_TURNED:
            text = f"the shapes of {counted(low.diameters, 'nodal diameter')} at "
            text += f"{_in_hertz(frequencies)} Hz are taken for the halves of a pair, but "
            yield f"{text}{_turned_text(low, high)}"


def more_than_a_pair(waves: Iterable[Wave]) -> Iterable[str]:
    """Yield doubts about shapes of equal diameters that are more than the halves of one pair, or
    than one mode without nodal diameters, and close in frequency."""
    by_diameters: dict[int, list[Wave]] = {}
    for wave in waves:
        by_diameters.setdefault(wave.diameters, []).append(wave)
    for diameters, alike in sorted(by_diameters.items()):
        most = 2 if diameters > 0 else 1
        for close in _close_together(_frequencies(alike)):
            if len(close) > most:
                yield _more_than_a_pair(diameters, close)


def _more_than_a_pair(diameters: int, close: Sequence[Sequence[Wave]]) -> str:
    """The doubt about shapes of equal diameters at frequencies that are close together."""
    text = (
        f"{len(close)} shapes of {counted(diameters, 'nodal diameter')} at {_in_hertz(close)} Hz "
    )
    text += f"are within {100 * SAME_PAIR:g} %, "
    if diameters == 0:
        return f"{text}but a mode without nodal diameters is no pair: leave out what is no mode"
    return f"{text}but a pair has two halves: leave out what is no mode"


def _turned_text(one: Wave, other: Wave) -> str:
    """How far the antinodes of two waves are apart, and how far those of halves are."""
    apart = _phase_apart(one, other) / one.diameters
    right = 90 / one.diameters
    text = f"their antinodes are {apart:.2g} degrees apart: "
    return f"{text}those of the halves of one pair are {right:.3g} degrees apart"


def _phase_apart(one: Wave, other: Wave) -> float:
    """Degrees of phase between the antinodes of two waves, 0 to 90."""
    return math.degrees(math.acos(min(1.0, abs(math.cos(one.turn - other.turn)))))


def _frequencies(waves: Iterable[Wave]) -> list[list[Wave]]:
    """Waves in ascending order of frequency; those of one frequency together."""
    groups: list[list[Wave]] = []
    for wave in sorted(waves, key=lambda wave: wave.omega):
        if groups and wave.omega < (1 + ONE_FREQUENCY) * groups[-1][-1].omega:
            groups[-1].append(wave)
        else:
            groups.append([wave])
    return groups


def _close_together(frequencies: Iterable[list[Wave]]) -> list[list[list[Wave]]]:
    """Frequencies in ascending order; those within the range of a pair together."""
    ranges: list[list[list[Wave]]] = []
    for waves in frequencies:
        if ranges and waves[0].omega * (1 - SAME_PAIR) < ranges[-1][0][0].omega:
            ranges[-1].append(waves)
        else:
            ranges.append([waves])
    return ranges


def _in_hertz(frequencies: Iterable[Sequence[Wave]]) -> str:
    """Frequencies for a message, in Hz."""
    *first, last = [f"{waves[0].omega / math.tau:.5g}" for waves in frequencies]
    return f"{', '.join(first)} and {last}"


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
