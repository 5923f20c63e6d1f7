"""Catalogue of the paper's figures, their contents and data, from `catalogue.yaml`. Studies are checked against it."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import yaml

from disc_model.data.variables import angles_text, values_text
from disc_model.figures.kinds import HIGHEST, OwnFigure, Recorded, spectrum_faults
from disc_model.parameters import Parameters
from disc_model.simulation.case import CaseSpec, Window


class Entry(NamedTuple):
    """A figure of the paper.

    Attributes
    ----------
    section : section of the paper
    title : short title for lists
    caption : description; `caption` fills in numbers and adds the parameters
    needs : required windows, by case; the Poincaré section is named ``poincare``
    plot : the drawing function, which takes the cases of `needs`, with its options
    """

    section: str
    title: str
    caption: str
    needs: Mapping[str, Sequence[str]]
    plot: OwnFigure

    @property
    def cases(self) -> tuple[str, ...]:
        return tuple(self.needs)


def _read() -> tuple[dict[str, str], dict[str, Entry]]:
    """Sections by their numbers, and figures by their names."""
    found = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
    entries = {}
    for name, given in found["figures"].items():
        caption = " ".join([given["caption"]] if isinstance(given["caption"], str) else given["caption"])
        plot = OwnFigure(by=f"paper.{given['drawn_by']}", options=given.get("options", {}))
        entries[name] = Entry(given["section"], given["title"], caption, given["needs"], plot)
    return found["sections"], entries


SECTIONS, CATALOGUE = _read()
ZOOM = 0.2
"""Length of a closer look, s."""


def lacking(figure: str, specs: Mapping[str, CaseSpec]) -> Iterator[tuple[str, str]]:
    """Reasons why a figure of the paper cannot be drawn, each with the case concerned."""
    for case, names in CATALOGUE[figure].needs.items():
        if case not in specs:
            yield case, f"needs a case {case}"
            continue
        for name in names:
            window = specs[case].sections.get(name)
            if isinstance(window, Window):
                faults = _faults_of(figure, name, window)
                yield from ((case, f"cases.{case}.record.windows.{name} {fault}") for fault in faults)
            elif window is None:
                place = f"cases.{case}.record"
                yield (
                    case,
                    f"needs {place}.poincare" if name == "poincare" else f"needs a window {name} in {place}.windows",
                )


def _faults_of(figure: str, name: str, window: Window) -> Iterator[str]:
    """Reasons why a window cannot be drawn in a figure, each as the end of a sentence."""
    if name == "history":  # it is drawn as ranges, all others as samples
        if window.envelope is None:
            yield "needs an envelope"
        elif window.count < 2 * window.envelope:
            yield "must be two envelopes long or more"
    elif window.envelope is not None:
        yield "must have no envelope"
    if name.startswith("spectrum"):
        yield from spectrum_faults(window, HIGHEST)
    for zoomed, start in CATALOGUE[figure].plot.options.get("zooms", ()):
        if zoomed == name and not (window.start <= start and start + ZOOM <= window.stop):
            yield f"must contain {start:g} to {start + ZOOM:g} s"


def number_of(name: str) -> str:
    """Name of a figure in the paper, such as "Fig. 5" or "Fig. A1"."""
    return f"Fig. {name.removeprefix('fig').lstrip('0')}"


def label(name: str) -> str:
    """Number and title, for lists sorted as text: numbers of one digit follow two spaces to come first."""
    return f"Fig. {number_of(name).removeprefix('Fig. '):>2}: {CATALOGUE[name].title}"


def caption(name: str, parameters: Mapping[str, Parameters], windows: Mapping[str, Recorded] | None = None) -> str:
    """A figure's caption with the parameters of its cases.

    Parameters
    ----------
    parameters : by case, at least those that the figure shows
    windows : by case and name, the Poincaré section as ``poincare``; if not given, times and angles are not named
    """
    entry = CATALOGUE[name]
    text = entry.caption.format(**_numbers(entry, windows or {}))
    texts = dict.fromkeys(values_text(dict(parameters[case])) for case in entry.cases)
    modes = {parameters[case].normalization for case in entry.cases}
    named = " and ".join(_MODES[mode] for mode in sorted(modes))
    return f"{text} {'; '.join(texts)}; everything else as in Table 1; {named}."


def _numbers(entry: Entry, windows: Mapping[str, Recorded]) -> dict[str, str]:
    """Times and angles for captions, from the windows that the figure shows."""
    needed = [(case, name) for case, names in entry.needs.items() for name in names]
    shown = [(name, window) for case, name in needed if (window := windows.get(case, {}).get(name)) is not None]
    theta = f"θ = {angles_text(window.theta for _, window in shown)}" if shown else "a fixed θ"
    words = {"theta": theta, "zoom": "a stretch", "orbit": "a stretch of the run"}
    for name, window in shown:
        if name == "zoom":
            words[name] = f"{1e3 * (window.stop - window.start):.3g} ms"
        if name == "orbit":
            words[name] = f"{window.start:g} to {window.stop:g} s"
    return words


_MODES = {
    "as_published": "modes scaled as in the published results",
    "orthonormal": "modes normalised as Eq. (17) says",
}
