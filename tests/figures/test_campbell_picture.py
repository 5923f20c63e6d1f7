"""Campbell diagrams of a study on a reader's axes."""

import re
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.figure import Figure

import disc_model as dm
from disc_model.figures.campbell_looks import CROSSINGS, NOT_NEAR, Crossing
from disc_model.figures.campbell_peaks import peaks
from disc_model.figures.sizes import COLUMN, PAGE
from disc_model.studies.quantities.campbell import EFFECTS
from tests.figures.every_kind import flag
from tests.figures.made_up import campbell_study
from tests.figures.reading import draw, labels
from tests.refusals import refusal


def picture_of(study: xr.Dataset, **wishes: Any) -> Figure:
    """The figure of the diagram of a study."""
    top, _ = dm.plot_campbell(study, **wishes)
    return top.figure


@pytest.mark.parametrize("width", [COLUMN, pytest.param(PAGE, marks=pytest.mark.slow)])
def test_a_campbell_diagram_takes_the_axes_of_a_reader(width: float) -> None:
    _, axes = pyplot.subplots(2, 1, figsize=(width, 4.6), layout="constrained", sharex=True)
    top, bottom = dm.plot_campbell(campbell_study(), ax=axes, highest=150, title="(a) modes")
    assert [top, bottom] == [*axes]
    assert top.get_title(loc="left") == "(a) modes"
    assert top.get_ylim() == (0, 150)
    assert " ".join(top.get_ylabel().split()) == "Frequency in the slider's frame (Hz)"
    assert bottom.get_xlabel() == "Speed Ω (rad/s)"
    [legend] = [ax.get_legend() for ax in axes if ax.get_legend()]
    assert "cut at 150 Hz: 1 mode above" in [text.get_text() for text in legend.get_texts()]


def test_a_new_campbell_diagram_has_all_frequencies() -> None:
    top, _ = dm.plot_campbell(campbell_study())
    assert top.get_ylim()[1] > float(campbell_study()["sliding_frequency"].max())
    assert not [text for text in labels(top.figure) if text.startswith("cut")]


def over_loads(count: int) -> xr.Dataset:
    """The study at several preloads, whose frequencies differ."""
    parts = []
    for place in range(count):
        part = campbell_study()
        part["sliding_frequency"][:] += 10.0 * place
        parts.append(part)
    loads = xr.Variable("N", 300.0 + 10.0 * np.arange(count))
    return xr.concat(parts, loads, data_vars="all")


def over_loads_and_frictions() -> xr.Dataset:
    """A study along two further dimensions."""
    frictions = xr.Variable("mu_k", np.array([0.1, 0.2]))
    return xr.concat([over_loads(2), over_loads(2)], frictions, data_vars="all")


NO_CAMPBELL = "must be a study of `quantity: campbell`"
NO_DIAGRAMS: dict[str, tuple[Any, str]] = {
    "seven loads": (
        over_loads(7),
        r"study='N': must be one dimension of up to 6 values: .* study.sel\(N=300.0\)",
    ),
    "two further dimensions": (
        over_loads_and_frictions(),
        r"study='mu_k, N': must be one dimension",
    ),
    "no crossings": (campbell_study().drop_vars("crossing_Omega"), NO_CAMPBELL),
    "a case": (dm.Parameters(N=385, Omega=15), NO_CAMPBELL),
    "another dataset": (xr.Dataset({"N": 1}), "study=a dataset of 1 variable: must be a study"),
    "a single speed": (campbell_study().isel(Omega=[0]), "must have two speeds or more"),
}
"""What is no Campbell diagram, and what is said of it."""


@pytest.mark.parametrize("name", NO_DIAGRAMS)
def test_what_is_no_campbell_diagram_is_refused(name: str) -> None:
    study, said = NO_DIAGRAMS[name]
    with refusal(said):
        dm.plot_campbell(study)


@pytest.mark.parametrize(
    ("count", "shape"),
    [(2, (2, 2)), (3, (2, 3)), (5, (2, 5)), pytest.param(6, (2, 6), marks=pytest.mark.slow)],
)
def test_a_further_axis_has_panels_with_equal_axes(count: int, shape: tuple[int, int]) -> None:
    """It was refused."""
    axes = dm.plot_campbell(over_loads(count), highest=150, multiples=[2])
    figure = axes[0, 0].figure
    assert axes.shape == shape
    for row in axes:
        limits = {(ax.get_xlim(), ax.get_ylim()) for ax in row}
        assert len(limits) == 1
    assert len(figure.axes) == 2 * count
    assert len(figure.legends) == 1


def test_titles_of_panels_say_what_differs() -> None:
    axes = dm.plot_campbell(over_loads(2))
    assert [ax.get_title(loc="left") for ax in axes[0]] == ["Preload N = 300 N", "310 N"]
    assert [ax.get_title(loc="left") for ax in axes[1]] == ["", ""]


@pytest.mark.parametrize(
    ("highest", "said"),
    [
        (-1.0, "highest=-1: must be a number > 0, in Hz"),
        ("3 kg", "highest='3 kg': must be a number in Hz, or with a unit"),
        ("high", "highest='high': must be a number > 0, in Hz"),
    ],
)
def test_what_is_no_highest_frequency_is_refused(highest: Any, said: str) -> None:
    with refusal(said):
        dm.plot_campbell(campbell_study(), highest=highest)


def test_points_of_a_cycle_that_the_motion_is_not_near_are_marked() -> None:
    """The largest of them was called a peak of growth, and a point that finer steps would resolve."""
    study = campbell_study()
    away = np.full(21, np.nan)
    away[[4, 5]] = 0.0
    study["near_motion"] = ("Omega", away)
    top, bottom = dm.plot_campbell(study)
    assert NOT_NEAR in labels(top.figure)
    rings = [line for line in bottom.lines if line.get_markerfacecolor() == "white"]
    heights = [rate for line in rings for rate in np.ravel(line.get_ydata()).tolist()]
    assert heights == [0.2]
    crosses = [line for line in bottom.lines if line.get_marker() == "x"]
    assert [[*line.get_ydata()] for line in crosses] == [[0.35, 0.4]]
    assert [peak.place for peak in peaks(study)] == [12]
    without = dm.plot_campbell(campbell_study())[0].figure
    assert NOT_NEAR not in labels(without)
    pyplot.close("all")


GAP = np.nan


@pytest.mark.parametrize(
    ("rates", "places"),
    [
        ([GAP, 0.74, 0.53, 0.45, 0.40, 0.36], []),
        ([0.74, 0.70, 0.45, 0.40, 0.36, 0.33], []),
        ([0.10, 0.20, 0.30, GAP, 0.20, 0.10], [12]),
        ([0.10, 0.20, GAP, 0.30, 0.20, 0.10], [13]),
        ([0.10, 0.20, 0.30, GAP, GAP, GAP], []),
        ([0.20, 0.30, 0.29, 0.31, 0.20, 0.10], [13]),
        ([0.10, 0.20, 0.30, 0.40, 0.50, 0.60], []),
        ([0.10, 0.20, 0.30, 0.28, 0.20, 0.10], [12]),
        ([0.00, 0.00, 0.30, 0.00, 0.00, 0.00], [12]),
    ],
    ids=[
        "no cycle up to the first rate",
        "falls",
        "ends at a gap",
        "begins at a gap",
        "no cycle after the last rate",
        "ripple",
        "rises",
        "smooth peak",
        "by itself",
    ],
)
def test_a_peak_is_above_both_its_neighbours(rates: list[float], places: list[int]) -> None:
    """Points along a flank that falls from the end of a branch were peaks of growth, each with a line."""
    study = campbell_study()
    study["growth_rate"][:] = -0.05
    study["growth_rate"][10:16] = rates
    study["growth_rate"][:10] = rates[0]
    study["growth_rate"][16:] = rates[-1]
    assert [peak.place for peak in peaks(study)] == places


def test_the_highest_frequency_may_have_a_unit() -> None:
    """A study's figure took it, and the picture did not."""
    top, _ = dm.plot_campbell(campbell_study(), highest="0.15 kHz")
    assert top.get_ylim() == (0, 150)


@pytest.mark.parametrize(
    ("highest", "said"),
    [
        (None, ["2 modes of 5 not computed"]),
        (250.0, ["2 modes of 5 not computed"]),
        (150.0, ["cut at 150 Hz: 3 modes above", "2 modes of 5 not computed"]),
    ],
)
def test_modes_without_room_are_counted(highest: float | None, said: list[str]) -> None:
    """Only modes that had room were counted above the edge, and nothing was said without one."""
    study = campbell_study()
    study["n_modes"] = ("Omega", np.full(21, 5))
    figure = picture_of(study, highest=highest)
    counts = [text for text in labels(figure) if re.search("^cut|computed", text)]
    assert counts == said


def with_sliding(*rates: float, gone: slice) -> xr.Dataset:
    """A study whose modes of steady sliding have these growth rates at all speeds, without a cycle at
    some of them."""
    study = campbell_study()
    growth = np.tile(rates, (21, 1))
    study["sliding_growth_rate"] = (("Omega", "mode"), growth)
    words = np.full(21, "ok", dtype=object)
    words[gone] = "no_stick_slip"
    study["status"] = flag(("Omega",), words, ("ok", "no_stick_slip"))
    study["growth_rate"][gone] = np.nan
    return study


FAST = slice(14, 21)
"""The last speeds."""


@pytest.mark.parametrize(
    ("largest", "word"), [(0.5, "unstable steady sliding"), (-0.5, "steady sliding")]
)
def test_steady_sliding_without_a_cycle_is_named(largest: float, word: str) -> None:
    """It was shaded as if nothing were known: "no growth rate"."""
    study = with_sliding(-1.0, largest, -2.0, gone=FAST)
    figure = picture_of(study)
    said = labels(figure)
    assert word in said
    assert "no growth rate" not in " ".join(said)


@pytest.mark.parametrize("largest", [0.5, -0.5])
def test_speeds_of_steady_sliding_are_shaded_in_both_panels(largest: float) -> None:
    study = with_sliding(-1.0, largest, -2.0, gone=FAST)
    top, bottom = dm.plot_campbell(study)
    [above] = top.patches
    [below] = bottom.patches
    assert above.get_x() == below.get_x()
    assert below.get_hatch(), "told apart in grey print"


GROWING = "growing mode"


def test_modes_that_grow_are_thick() -> None:
    """Unstable modes of steady sliding were drawn like stable ones."""
    study = with_sliding(-1.0, 0.5, -2.0, gone=FAST)
    top, _ = dm.plot_campbell(study)
    frequencies = study["sliding_frequency"].sel(mode=2)
    *thin, thick = top.lines[:4]
    widest_of_thin = max(line.get_linewidth() for line in thin)
    assert thick.get_linewidth() > 2 * widest_of_thin
    assert thick.get_ydata().tolist() == frequencies.values.tolist()
    assert GROWING in labels(top.figure)


def without_a_crossing_at_a_peak() -> xr.Dataset:
    """A study whose crossings are all at another speed than its peaks."""
    study = campbell_study()
    study["crossing_Omega"] = ("crossing", [9.0, 9.0, 9.0])
    return study


@pytest.mark.parametrize(
    ("effects", "said"),
    [
        (["unresolved"] * 3, ["3 crossings: all unresolved (2 marked)"]),
        (["unresolved", "unresolved", "rises"], ["3 crossings: 2 unresolved (1 marked)"]),
        (["unresolved", "no_rise", "rises"], ["3 crossings: 1 not marked, 1 unresolved (marked)"]),
        (["no_rise", "no_rise", "rises"], []),
    ],
)
def test_unresolved_crossings_are_counted(effects: list[str], said: list[str]) -> None:
    """Of 213 crossings none was resolved, and the figure said nothing."""
    study = campbell_study()
    study["crossing_effect"] = flag(("crossing",), effects, EFFECTS)
    figure = picture_of(study)
    assert [text for text in counts_of(figure) if "unresolved" in text] == said


def counts_of(figure: Figure) -> list[str]:
    """What the legend says of the number of crossings."""
    said = labels(figure)
    return [text.replace("\n", " ") for text in said if re.match(r"\d+ crossings?:", text)]


def unmarked(figure: Figure) -> list[str]:
    """What the legend says of crossings without a mark."""
    return [text for text in counts_of(figure) if "not marked" in text]


def test_crossings_without_a_mark_are_counted() -> None:
    """Of six crossings in the table the picture neither showed nor said any."""
    study = without_a_crossing_at_a_peak()
    figure = picture_of(study)
    assert unmarked(figure) == ["3 crossings: all not marked"]


def test_crossings_at_peaks_are_marked() -> None:
    at_a_peak = campbell_study().isel(crossing=[0])
    assert not unmarked(picture_of(at_a_peak))


def named_multiples(top: Any) -> list[str]:
    """Names of multiples of the stick-slip frequency in the panel of frequencies."""
    texts = [re.sub(r"\\mathrm{(.*)}", r"\1", text.get_text()) for text in top.texts]
    return [text for text in texts if text.endswith("$f_s$")]


def with_a_crossing_at_no_peak(effect: str) -> xr.Dataset:
    """A study in which twice the stick-slip frequency meets a mode where no rate peaks."""
    study = campbell_study()
    study["crossing_Omega"][0] = 16.0
    study["crossing_frequency"][0] = 126.4
    study["crossing_multiple"] = ("crossing", [2.0, 3.0, 1.0])
    study["crossing_effect"][0] = EFFECTS.index(effect)
    return study


@pytest.mark.parametrize("crossing", CROSSINGS)
def test_crossings_of_multiples_that_are_asked_for_are_marked(crossing: Crossing) -> None:
    """Only those at the highest peaks had a line and a mark."""
    for effect in crossing.effects:
        study = with_a_crossing_at_no_peak(effect)
        top, _ = dm.plot_campbell(study, multiples=[2])
        [at] = [line for line in top.lines if line.get_marker() == crossing.marker]
        assert at.get_xydata().tolist() == [[16.0, 126.4]]
        assert at.get_markerfacecolor() == crossing.face
        assert f"crossing: {crossing.meaning}" in labels(top.figure)
        assert "2 $f_s$" in named_multiples(top)


def test_multiples_are_open_where_the_frequency_jumps() -> None:
    """Dashes led from that of one kind of cycle to that of another."""
    study = campbell_study()
    study["stick_slip_frequency"][14:] += 15.0
    top, _ = dm.plot_campbell(study, multiples=[2])
    line = next(line for line in top.lines if 120.0 < np.ravel(line.get_ydata())[0] < 130.0)
    heights = np.ravel(line.get_ydata())
    assert np.flatnonzero(np.isnan(heights)).tolist() == [14]


def test_a_picture_without_multiples_has_those_at_peaks_only() -> None:
    top, _ = dm.plot_campbell(with_a_crossing_at_no_peak("rises"))
    assert "2 $f_s$" not in named_multiples(top)
    assert not [text for text in labels(top.figure) if text.startswith("crossing: ")]


def test_the_figure_of_a_study_takes_multiples() -> None:
    figure = draw("campbell", campbell_study(), multiples=[2, 3])
    names = named_multiples(figure.axes[0])
    assert {"2 $f_s$", "3 $f_s$"} <= {*names}


@pytest.mark.parametrize("multiples", [2, [0], [2.3], [True], "2"])
def test_what_are_no_multiples_is_refused(multiples: Any) -> None:
    with refusal("must be whole numbers or halves > 0, such as"):
        dm.plot_campbell(campbell_study(), multiples=multiples)


@pytest.mark.parametrize("multiples", [[2.5], (2.5,), np.array([2.5, 3.0])])
def test_halves_of_the_stick_slip_frequency_are_multiples(multiples: Any) -> None:
    """Crossings are at n and n + 1/2, and only whole numbers were taken."""
    study = with_a_crossing_at_no_peak("rises")
    study["crossing_multiple"][0] = 2.5
    top, _ = dm.plot_campbell(study, multiples=multiples)
    assert "2.5 $f_s$" in named_multiples(top)
    assert "crossing: a rate rises" in labels(top.figure)


def test_the_figure_of_a_study_refuses_other_fractions() -> None:
    with refusal("multiples.0=2.3: must be a multiple of 0.5"):
        draw("campbell", campbell_study(), multiples=[2.3])
