"""What a picture of a spectrum shows: amplitudes over the frequency, and the lines that have names."""

from typing import NamedTuple

import xarray as xr

from disc_model.analysis.spectra import RESOLVED, amplitude_spectrum, highest_line, lines
from disc_model.data.dataset import Missing
from disc_model.figures.peak_names import MOST_NAMED
from disc_model.figures.runs import sampled, span_of
from disc_model.figures.types import Array

FLOOR = -100.0  # least amplitude shown, dB below the greatest
WEAKEST = 0.01  # amplitude over that of the strongest line, of lines that have to be on the axis
ROOM_BEYOND = 1.15  # highest frequency shown over that of the highest such line


class Amplitudes(NamedTuple):
    """What is shown of a spectrum: frequencies, Hz, up to the highest, amplitudes in the unit of the
    axis, the resolution, Hz, all lines as frequencies and amplitudes, and the whole spectrum, of
    which more is seen beside another one that goes further."""

    frequency: Array
    amplitude: Array
    resolution: float
    peaks: list[tuple[float, float]]
    whole: tuple[Array, Array]

    @property
    def highest(self) -> float:
        return float(self.frequency[-1])

    @property
    def lowest(self) -> float:
        """Lower end of the axis."""
        greatest = self.amplitude.max()
        return float(max(self.amplitude.min(), 10 ** (FLOOR / 20) * greatest)) / 2


def amplitudes(samples: xr.Dataset, variable: str, highest: float | None = None) -> Amplitudes:
    """The spectrum of a variable up to a frequency in Hz, or to where its lines end; raises
    `Missing` if it does not vibrate."""
    time = samples["time"].values
    values = samples[variable].values
    least = 4 * RESOLVED
    if time.size < least:
        raise Missing(
            f"recorded {time.size} samples, and a spectrum takes {least}: a line is"
            f" {least // 2} bins wide"
        )
    _, factor, _ = sampled(variable, samples)
    frequency, amplitude = amplitude_spectrum(time, values)
    resolution = 1 / span_of(samples)
    if highest is None:
        highest = min(ROOM_BEYOND * highest_line(time, values, WEAKEST), float(frequency[-1]))
        least_shown = RESOLVED * resolution
        if highest < least_shown:
            raise Missing(
                f"lasts {span_of(samples):.3g} s, too short: lines show from {least_shown:.3g} Hz"
                f" on, and what vibrates is below {highest:.3g} Hz"
            )
        last_named = ROOM_BEYOND * _last_named(time, values, resolution)
        highest = min(max(highest, last_named), float(frequency[-1]))
    shown = (frequency > 0) & (frequency <= highest)
    whole = (frequency[1:], factor * amplitude[1:])
    amplitude = factor * amplitude[shown]
    if not amplitude.any():
        raise Missing(f"did not vibrate at up to {highest:g} Hz")
    found = lines(time, values, above=RESOLVED * resolution, below=highest)
    peaks = [(line.frequency, factor * line.amplitude) for line in found]
    return Amplitudes(frequency[shown], amplitude, resolution, peaks, whole)


def _last_named(time: Array, values: Array, resolution: float) -> float:
    """Frequency of the highest, Hz, of the strongest lines of the whole spectrum, which have names
    if they are on the axis; zero without any line."""
    found = lines(time, values, above=RESOLVED * resolution)
    strongest = sorted(found, key=lambda line: -line.amplitude)[:MOST_NAMED]
    return max((line.frequency for line in strongest), default=0.0)
