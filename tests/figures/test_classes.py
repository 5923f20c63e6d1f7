"""Classes of points: each has a colour and a pattern of its own, the same everywhere."""

from itertools import combinations

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb

from disc_model.data.variables import EVENT_KINDS, LONG_TERM_OUTCOMES, PHASES, STATUSES, Outcome
from disc_model.figures.basin_shares import STACKED
from disc_model.figures.classes import LOOKS, UNRESOLVED, Look, lightness, looks_of, name_of
from disc_model.studies.registry import quantity_names, quantity_of
from tests.figures.reading import draw, labels

FLAGS = {
    f"{name}.{variable}": column.flags
    for name in quantity_names()
    for variable, column in quantity_of(name).COLUMNS.items()
    if column.flags
}
FLAGS |= {"events": EVENT_KINDS, "phases": PHASES, "statuses": STATUSES, "outcomes": (*Outcome,)}
APART = 0.06  # distance of two colours, of red, green and blue from 0 to 1, that print apart
GREY_APART = 0.1  # difference of lightness that a grey print shows


def distance(one: Look, other: Look) -> float:
    return float(np.linalg.norm(np.subtract(to_rgb(one.face), to_rgb(other.face))))


def test_every_outcome_has_a_look_and_a_place_in_stacks() -> None:
    """A word without a look has a colour by chance, and one without a place is not drawn."""
    assert not {*Outcome} - {*LOOKS}, "add to LOOKS in figures/classes.py"
    assert not {*LONG_TERM_OUTCOMES} - {*STACKED}, "add to STACKED in figures/basins.py"


@pytest.mark.parametrize("words", FLAGS.values(), ids=FLAGS)
def test_classes_of_a_flag_differ_in_colour_and_in_grey_print(words: tuple[str, ...]) -> None:
    """Nine classes had seven colours, so that quiet looked as undecided, and failed as stuck."""
    looks = looks_of(words)
    assert [*looks] == [*words]
    for (word, one), (other_word, other) in combinations(looks.items(), 2):
        assert distance(one, other) > APART, (word, other_word)
        by_pattern = {*one.hatch} != {*other.hatch} or len(one.hatch) != len(other.hatch)
        by_lightness = abs(lightness(one.face) - lightness(other.face)) > GREY_APART
        assert by_pattern or by_lightness, (word, other_word)
        assert one.label != other.label


def kinds(words: list[list[str]]) -> xr.Dataset:
    """What starts come to, over two perturbations."""
    flags = quantity_of("basins").COLUMNS["kind"].flags
    codes = np.array([[flags.index(word) for word in row] for row in words], np.int8)
    attrs = {"flag_meanings": " ".join(flags), "long_name": "what the motion comes to"}
    rows, columns = codes.shape
    axes = {
        "perturbation_f": np.arange(rows, dtype=float),
        "perturbation_u": 1e-3 * np.arange(columns),
    }
    return xr.Dataset({"kind": ([*axes], codes, attrs)}, axes)


def test_what_is_unresolved_is_marked_over_its_class_and_keeps_it() -> None:
    """A column of cells was hatched in place of its outcome."""
    column = [["undecided", "quiet", "undecided"]] * 3
    figure = draw(
        "heat_map", kinds(column), variable="kind", x="perturbation_u", y="perturbation_f"
    )
    assert labels(figure)[:3] == ["quiet", "undecided", UNRESOLVED.label]
    figure.draw_without_rendering()
    face = figure.axes[0].collections[0].get_facecolor().reshape(3, 3, 4)[1, 1]
    np.testing.assert_allclose(face[:3], to_rgb(LOOKS["quiet"].face), atol=1e-6)
    [mark] = [patch for patch in figure.axes[0].patches if patch.get_hatch() == UNRESOLVED.hatch]
    assert mark.get_path().vertices[:, 0].mean() == pytest.approx(1, abs=0.2)


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("neimark_sacker", "Neimark-Sacker"),
        ("period_doubling", "period doubling"),
        ("fold", "fold"),
    ],
)
def test_bifurcations_have_the_names_of_the_field(word: str, name: str) -> None:
    """Legends said "neimark sacker"."""
    assert name_of(word) == name
    assert looks_of([word])[word].label == name
