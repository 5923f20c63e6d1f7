"""The paper's figures: what each shows and needs. Imports nothing heavy: studies are checked against it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from disc_model.data.variables import said_values
from disc_model.figures.kinds import HIGHEST, OwnFigure, spectrum_faults
from disc_model.parameters import Parameters
from disc_model.simulation.case import CaseSpec, Poincare, Window

Windows = Mapping[str, Mapping[str, Window | Poincare | None]]


class Entry(NamedTuple):
    """A figure.

    Attributes
    ----------
    section : of the paper
    title : a few words for lists
    caption : what it shows; `caption` fills in numbers and adds the parameters
    needs : the windows it needs, by case; the Poincare section goes by the name ``poincare``
    drawn_by : a module beside this one and its function, such as ``"spectra.response"``, which takes cases by name
    options : keyword arguments of that function
    """

    section: str
    title: str
    caption: str
    needs: Mapping[str, tuple[str, ...]]
    drawn_by: str
    options: Mapping[str, Any] = {}

    @property
    def cases(self) -> tuple[str, ...]:
        return tuple(self.needs)

    @property
    def plot(self) -> OwnFigure:
        """What draws it."""
        return OwnFigure(by=f"paper.{self.drawn_by}", options=dict(self.options))


SECTIONS = {
    "2": "2 The model",
    "4.1": "4.1 Separation during vibration",
    "4.2": "4.2 The critical speed",
    "4.3": "4.3 Influence of parameters",
    "4.4": "4.4 Frequencies that change with time",
    "A": "Appendix",
    "B": "Beyond the paper",
}


def _section(section: str, case: str, title: str, what: str) -> Entry:
    text = (
        "Poincare sections, one point each drive period 2π/Ω: (a) in-plane motion of the slider relative to the drive "
        f"point, (b) disc at r_0 and {{theta}}. {what}"
    )
    return Entry(section, f"Poincare sections, {title}", text, {case: ("poincare",)}, "sections.sections")


def _ranges(case: str, title: str, **options: Any) -> Entry:
    text = "(a) Contact force, (b) disc at r_0 and {theta}, as ranges."
    options |= {"window": "history", "variables": ("P", "w_point")}
    return Entry("4.2", title, text, {case: ("history",)}, "histories.history", options)


def _response(case: str, title: str, text: str, variable: str, window: str, **options: Any) -> Entry:
    windows = ("history", window, *(name for name, _ in options.get("zooms", ())))
    options |= {"variable": variable, "window": window}
    return Entry("4.4", title, text, {case: tuple(dict.fromkeys(windows))}, "spectra.response", options)


def _portrait(case: str, title: str, what: str) -> Entry:
    text = f"Phase portrait of the slider relative to the drive point, {{orbit}}, {what}."
    return Entry("A", f"Phase portrait, {title}", text, {case: ("orbit",)}, "sections.portrait")


BEFORE = (
    "Light blue crosses: in contact before the first separation; black dots: in contact after it; vermilion triangles: "
    "apart."
)
HALVES = "Light blue crosses: first half of the run; black dots: second half."
IGNORED = f"Separation ignored. {HALVES}"
STAGES = f"Stages: {BEFORE}"
QUIET = f"No separation occurs. {HALVES}"

SLIDER = (
    "In-plane motion of the slider: (a) range of ψ over the run and two tenths of a second of it before and after "
    "the first separation, (b) its time-frequency spectrum in the shaded stretch. Dashed: first separation."
)
DISC = "Disc at r_0 and {theta}: (a) range of its displacement, (b) its time-frequency spectrum in the"

AROUND = tuple(f"around{i}" for i in range(9))
"""Windows with the disc at so many angles as nine modes need."""
ABOVE = {"until": 120.0}
"""Histories of N = 385 N, 15.1 rad/s end where the paper's do; the run goes on for the section's sake."""

CATALOGUE: Mapping[str, Entry] = {
    "fig01": Entry(
        "2",
        "The model",
        "Disc and slider: (a) from the side, with springs, dampers and preload, (b) from above, radii to scale, (c) "
        "forces at the contact. The displacement Δ, kept, gives the preload N; u_0 is the height at the static start, "
        "f = dφ/dt, F = k_p ψ + c_p (Ω - f), B = ∂w/∂θ under the slider.",
        {"F02": ()},
        "model.schematic",
    ),
    "fig02": Entry(
        "4.1",
        "Contact force",
        "Contact force: (a) its range over the whole run, (b) {zoom} of it, separations shaded.",
        {"F02": ("history", "zoom")},
        "separations.contact_force",
    ),
    "fig03": Entry(
        "4.1",
        "One separation",
        "Disc and slider during one separation and reattachment: (a) displacements from static equilibrium, (b) the "
        "gap between them.",
        {"F02": ("zoom",)},
        "separations.one_separation",
    ),
    "fig04": _section("4.1", "F04", "separation ignored", IGNORED),
    "fig05": _section("4.1", "F02", "with separation", STAGES),
    "fig06": _section("4.1", "F06", "separation ignored, larger preload", IGNORED),
    "fig07": _section("4.1", "F07", "with separation, larger preload", STAGES),
    "fig08": _section("4.1", "F08", "separation ignored, higher speed", IGNORED),
    "fig09": _section("4.1", "F09", "with separation, higher speed", STAGES),
    "fig10": Entry(
        "4.1",
        "Disc, with separation and without",
        "Range of the disc's displacement at r_0 and {theta}, with separation ignored and with separation.",
        {"F02": ("history",), "F04": ("history",)},
        "histories.with_and_without",
    ),
    "fig11": _ranges("F11", "Histories below the critical speed"),
    "fig12": _section("4.2", "F11", "below the critical speed", QUIET),
    "fig13": _ranges("F13", "Histories above the critical speed", **ABOVE),
    "fig14": _section("4.2", "F13", "above the critical speed", STAGES),
    "fig16": _section("4.3", "F16", "small preload", QUIET),
    "fig17": _section("4.3", "F17", "intermediate preload", STAGES),
    "fig18": _section("4.3", "F18", "undamped disc", STAGES),
    "fig19": _section("4.3", "F19", "in-plane damping", STAGES),
    "fig20": _section("4.3", "F20", "damping normal to the disc", QUIET),
    "fig21": _section("4.3", "F21", "soft disc", QUIET),
    "fig22": _section("4.3", "F22", "soft in-plane spring", STAGES),
    "fig23": Entry(
        "4.3",
        "Separations of a light slider",
        "Disc and slider around separations of a light slider, displacements from static equilibrium; separations "
        "shaded.",
        {"F23": ("zoom",)},
        "separations.light_slider",
    ),
    "fig24": Entry(
        "4.4",
        "Disc's vibration above the critical speed",
        "Range of the disc's displacement at r_0 and {theta}; the stretches of Fig. 25 are marked.",
        {"F13": ("history", "spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")},
        "spectra.with_stretches",
        options=ABOVE,
    ),
    "fig25": Entry(
        "4.4",
        "Disc's spectrum in time above the critical speed",
        "Time-frequency spectrum of the disc's displacement at r_0 and {theta} in four stretches of the run, relative "
        "to the strongest line of all four; below, the same up to 300 Hz, the lines of Table 2 named. The "
        "first half second, half a window, is left out. Dashed: first separation. Ticks without a name: the lines of a "
        "pair.",
        {"F13": ("spectrum_a", "spectrum_b", "spectrum_c", "spectrum_d")},
        "spectra.four_stretches",
    ),
    "fig26": _response(
        "F13",
        "Slider's motion above the critical speed",
        SLIDER,
        "psi",
        "spectrum_c",
        zooms=[["spectrum_c", 52.0], ["spectrum_d", 105.0]],
        **ABOVE,
    ),
    "fig27": _response(
        "F07",
        "Disc's vibration, smaller preload",
        f"{DISC} shaded stretch. Dashed: first separation.",
        "w_point",
        "spectrum_d",
        until=200.0,
    ),
    "fig28": _response(
        "F07",
        "Slider's motion, smaller preload",
        SLIDER,
        "psi",
        "spectrum_d",
        zooms=[["spectrum_d", 143.1], ["spectrum_d", 152.0]],
        until=200.0,
    ),
    "fig29": _response(
        "F21",
        "Disc's vibration, soft disc",
        f"{DISC} stretch marked there. Dotted: the disc's highest natural frequency.",
        "w_point",
        "spectrum_d",
        highest=True,
    ),
    "figA1": _portrait("F04", "separation ignored", "separation ignored"),
    "figA2": _portrait("F02", "with separation", "by phase"),
    "figB1": Entry(
        "B",
        "The whole disc while the slider leaves it",
        "Deflection of the disc from the plane of the disc at rest at four instants, equally far apart, from one loss "
        "of contact to the next: (a) to (d) from above, the slider as a dot, with a tick at θ = 0 and an arrow in the "
        "sense of θ and of the drive's rotation, (e) along its circle, the slider as a square.",
        {"F02": AROUND},
        "disc.instants",
    ),
}


RANGES = ("history",)
"""Windows that are drawn as ranges and need an envelope; all others are drawn as samples and must have none."""
ZOOM = 0.2
"""Length of a closer look, s."""


def lacking(figure: str, specs: Mapping[str, CaseSpec]) -> Iterator[tuple[str, str]]:
    """What keeps one of the paper's figures from being drawn: the case that it is about, and why."""
    for case, windows in CATALOGUE[figure].needs.items():
        if case not in specs:
            yield case, f"needs a case {case}"
            continue
        recorded = dict(specs[case].windows)
        for window in windows:
            if window == "poincare":
                if specs[case].poincare is None:
                    yield case, f"needs cases.{case}.record.poincare"
            elif window not in recorded:
                yield case, f"needs a window {window} in cases.{case}.record.windows"
            else:
                for fault in _faults_of(figure, window, recorded[window]):
                    yield case, f"cases.{case}.record.windows.{window} {fault}"


def _faults_of(figure: str, name: str, window: Window) -> Iterator[str]:
    """What keeps a window from being drawn in a figure, each as the end of a sentence."""
    if name in RANGES:
        if window.envelope is None:
            yield "needs an envelope"
        elif window.count < 2 * window.envelope:
            yield "must be two envelopes long or more"
    elif window.envelope is not None:
        yield "must have no envelope"
    if name.startswith("spectrum"):
        yield from spectrum_faults(window, HIGHEST)
    for zoomed, start in CATALOGUE[figure].options.get("zooms", ()):
        if zoomed == name and not (window.start <= start and start + ZOOM <= window.stop):
            yield f"must contain {start:g} to {start + ZOOM:g} s"


def number_of(name: str) -> str:
    """What the paper calls a figure, such as "Fig. 5" or "Fig. A1"."""
    return f"Fig. {name.removeprefix('fig').lstrip('0')}"


def label(name: str) -> str:
    """Number and title, for lists that are sorted as text: one digit after two spaces comes before two digits."""
    number = number_of(name)
    spaced = number.replace(" ", "  ") if len(number) == len("Fig. 1") else number
    return f"{spaced}: {CATALOGUE[name].title}"


def caption(name: str, parameters: Mapping[str, Parameters], windows: Windows | None = None) -> str:
    """A figure's caption with the parameters of its cases.

    Parameters
    ----------
    parameters : by case, at least those that the figure shows
    windows : by case and name, the Poincare section as ``poincare``; if not given, times and angles are not named
    """
    entry = CATALOGUE[name]
    text = entry.caption.format(**_numbers(entry, windows or {}))
    said: list[str] = []
    for case in entry.cases:
        values = said_parameters(parameters[case])
        if values not in said:
            said.append(values)
    modes = {parameters[case].normalization for case in entry.cases}
    named = " and ".join(_MODES[mode] for mode in sorted(modes))
    return f"{text} {'; '.join(said)}; everything else as in Table 1; {named}."


def _numbers(entry: Entry, windows: Windows) -> dict[str, str]:
    """What captions say of times and angles, from the windows that the figure shows."""
    needed = [(case, name) for case, names in entry.needs.items() for name in names]
    shown = [(name, window) for case, name in needed if (window := windows.get(case, {}).get(name)) is not None]
    angles = " and ".join(f"{theta:g}" for theta in sorted({window.theta for _, window in shown}))
    said = {"theta": f"θ = {angles}" if angles else "a fixed θ", "zoom": "a stretch", "orbit": "a stretch of the run"}
    for name, window in shown:
        if name == "zoom":
            said[name] = f"{1e3 * (window.stop - window.start):.3g} ms"
        if name == "orbit":
            said[name] = f"{window.start:g} to {window.stop:g} s"
    return said


_MODES = {
    "as_published": "modes scaled as in the published results",
    "orthonormal": "modes normalised as Eq. (17) says",
}


def said_parameters(p: Parameters) -> str:
    """N, Omega and whatever differs from Table 1, with units."""
    return said_values({name: getattr(p, name) for name in Parameters.model_fields})
