"""Discs given by their modes: pairs of modes, and a report on what a disc was made of.

An axisymmetric disc has two modes of each shape with nodal diameters, cosine and sine, at one
frequency. A test finds two frequencies, because no real disc is quite axisymmetric, and a file may
hold the same mode several times.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from disc_model.display import Summarised, counted

if TYPE_CHECKING:
    import pandas as pd

SAME_PAIR = 0.05  # greatest relative difference of the frequencies of the two halves of a pair
# Relative differences of halves above which their mean is doubted: amplitudes by a factor of 1.5, and damping ratios by
# one of 2. A test knows amplitudes to 20 % and damping ratios to 30 %, and halves of a disc are alike but for that.
DOUBTED_AMPLITUDES = 0.4
DOUBTED_DAMPING = 0.7
ROUNDING = 1e-6  # %, difference of halves below which they are alike


@dataclass(frozen=True)
class ModeOrigin:
    """What one mode of a disc was made of.

    Attributes
    ----------
    diameters : number of nodal diameters
    lower, upper : rad/s, lowest and highest frequency of the shapes
    shapes : number of shapes of the file that were averaged; a pair has two, more if it was found
        from several references
    followed : share of the normal motion along the slider's circle that has these nodal diameters;
        nan for a table
    in_phase : share of the motion that is in phase, 1 for a real mode; nan for a table
    amplitude_split, damping_split : difference of the greatest and the least amplitude and damping
        ratio of the shapes over their mean; nan if they are not known, as of amplitudes at the point
        of a test
    """

    diameters: int
    lower: float
    upper: float
    shapes: int
    followed: float = math.nan
    in_phase: float = math.nan
    amplitude_split: float = math.nan
    damping_split: float = math.nan

    @property
    def omega(self) -> float:
        """The mean of both frequencies, rad/s."""
        return (self.lower + self.upper) / 2

    @property
    def split(self) -> float:
        """Relative difference of the two frequencies of the pair."""
        return (self.upper - self.lower) / self.omega


@dataclass(frozen=True)
class DiscReport(Summarised):
    """What was used of a file from which a disc was read, and what was left out.

    Attributes
    ----------
    source : name of the file
    modes : a `ModeOrigin` for each mode of the disc, in its order
    left_out : number of datasets or modes that were not used, by the reason
    notes : how the file was understood: axis, centre, circle of nodes, units; of a table each column, also those
        that were passed over
    doubts : what a reader should check; each was also given as a warning

    Examples
    --------
    >>> import disc_model as dm
    >>> heads = "diameters; f (Hz); amplitude (kg^-1/2)"
    >>> with open("split.csv", "w") as file:
    ...     print(heads, "2; 1209; 0.54", "2; 1215; 0.55", sep="\\n", file=file)
    >>> disc = dm.Disc.from_csv("split.csv", pairs="mean")
    >>> print(disc.report)
    split.csv: 1 mode
     diameters  lower (Hz)  upper (Hz)  split (%)  amplitude split (%)  shapes
         2        1209        1215    0.49505               1.8349       2
    read: 'diameters' as nodal diameters, 2
    read: 'f (Hz)' as frequency, 1212 Hz
    read: 'amplitude (kg^-1/2)' as amplitude, 0.545 kg^-1/2
    read: no damping
    read: amplitudes of pairs are the means of their halves; if both were measured at one point, give pairs='test'
    """

    source: str
    modes: tuple[ModeOrigin, ...]
    left_out: Mapping[str, int] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()

    @property
    def split(self) -> tuple[float, ...]:
        """Relative difference of the two frequencies of each mode of the disc, 0 where only one was
        found."""
        return tuple(mode.split for mode in self.modes)

    @property
    def has_shapes(self) -> bool:
        """Whether the file says more of its modes than a disc keeps: both halves of pairs, or
        shapes along the circle."""
        return any(mode.shapes > 1 or not math.isnan(mode.followed) for mode in self.modes)

    @property
    def table(self) -> pd.DataFrame:
        """A row for each mode: diameters, frequencies (Hz), their split and those of amplitude and
        damping (%), nan for a mode of one shape, shapes, and of a universal file the shares (%) of
        its motion that follow its nodal diameters and are in phase."""
        import pandas as pd

        columns = {
            "diameters": [mode.diameters for mode in self.modes],
            "lower (Hz)": [mode.lower / math.tau for mode in self.modes],
            "upper (Hz)": [mode.upper / math.tau for mode in self.modes],
            "split (%)": [_percent(mode, mode.split) for mode in self.modes],
            "amplitude split (%)": [_percent(mode, mode.amplitude_split) for mode in self.modes],
            "damping split (%)": [_percent(mode, mode.damping_split) for mode in self.modes],
            "shapes": [mode.shapes for mode in self.modes],
            "followed (%)": [100 * mode.followed for mode in self.modes],
            "in phase (%)": [100 * mode.in_phase for mode in self.modes],
        }
        return pd.DataFrame(columns).dropna(axis="columns", how="all")

    def _summary(self) -> Iterator[tuple[str, object]]:
        yield "source", f"{self.source}: {counted(len(self.modes), 'mode')}"
        for note in self.notes:
            yield "read", note
        for reason, count in self.left_out.items():
            yield "left out", f"{count} x {reason}"
        for doubt in self.doubts:
            yield "check", doubt

    def __str__(self) -> str:
        head, *lines = self.summary()
        texts = [head[1]]
        if self.has_shapes:
            texts += self.table.to_string(
                index=False, float_format="{:.5g}".format, na_rep="-"
            ).splitlines()
        texts += [f"{name}: {text}" for name, text in lines]
        return "\n".join(text.rstrip() for text in texts)


def _percent(mode: ModeOrigin, difference: float) -> float:
    """A relative difference of the shapes of a mode in %, 0 if it is one of rounding; nan of a mode
    that has but one shape."""
    if mode.shapes == 1:
        return math.nan
    percent = 100 * difference
    return 0.0 if percent < ROUNDING else percent


def relative_difference(values: Sequence[float]) -> float:
    """Difference of the greatest and the least of some values over their mean; 0 if all are zero."""
    mean = sum(values) / len(values)
    return (max(values) - min(values)) / mean if mean else 0.0


def doubts_of_halves(origins: Sequence[ModeOrigin], of_amplitudes: str = "") -> Iterator[str]:
    """Yield doubts whether halves of pairs, of which a disc has the mean, are one mode;
    `of_amplitudes`: advice on amplitudes that differ."""
    for i, origin in enumerate(origins, 1):
        for name, split, doubted, advice in (
            ("amplitudes", origin.amplitude_split, DOUBTED_AMPLITUDES, of_amplitudes),
            ("damping ratios", origin.damping_split, DOUBTED_DAMPING, ""),
        ):
            if split > doubted:
                head = f"the halves of mode {i}, {counted(origin.diameters, 'nodal diameter')} at "
                head += f"{origin.lower / math.tau:.5g} and {origin.upper / math.tau:.5g} Hz"
                apart = f"{name} {100 * split:.0f} % apart"
                yield f"{head}, have {apart}, and the disc has their mean{advice}"
