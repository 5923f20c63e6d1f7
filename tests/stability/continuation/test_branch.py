"""What a branch says of its cycles and of its special points."""

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.stability.continuation.branch import Branch
from disc_model.stability.continuation.special_kinds import LABELS
from disc_model.stability.continuation.special_point import SpecialPoint
from tests.refusals import refusal

P = Parameters(N=385, Omega=15)


def special(kind: str, value: float) -> SpecialPoint:
    return SpecialPoint(
        kind=kind,
        values=np.array([value]),
        period=0.015,
        stick_fraction=0.5,
        growth_rate=0.25,
        multiplier=1 + 0j,
        after=1,
        case=P,
        modal=np.zeros(1),
    )


def branch(name: str) -> Branch:
    """Three cycles at 3, 5 and 4, with a fold at 5.2."""
    fold = special("fold", 5.2)
    return Branch(
        parameters=(name,),
        values=np.array([[3.0], [5.0], [4.0]]),
        period=np.full(3, 0.015),
        stick_fraction=np.full(3, 0.5),
        growth_rate=np.array([-0.1, 0.1, 0.2]),
        multipliers=np.ones((3, 1), dtype=complex),
        diameters=np.zeros(3, dtype=int),
        separations=np.zeros(3, dtype=int),
        releases=np.ones(3, dtype=int),
        points=np.zeros((3, 1)),
        folds=fold.values[None],
        ended="made up",
        case=P,
        special=(fold,),
    )


def test_a_branch_states_how_far_it_reaches_with_its_special_points() -> None:
    text = repr(branch("Omega"))
    assert text == "Branch(3 cycles, Omega from 3 to 5.2 rad/s, 1 fold; ended: made up)"


def test_cycles_are_numbered_from_either_end() -> None:
    found = branch("Omega")
    last = found.case_at(2)
    assert last.Omega == 4.0
    first = found.case_at(-3)
    assert first.Omega == 3.0
    rule = "must be the number of a cycle, from -3 to 2"
    for number in (3, -4):
        with refusal(f"^i={number}: {rule}$"):
            found.case_at(number)


@pytest.mark.parametrize(
    ("kind", "label"),
    [
        ("fold", "LP"),
        ("period_doubling", "PD"),
        ("neimark_sacker", "TR"),
        ("branch_point", "BP"),
        ("hopf", "HB"),
        ("end", "EP"),
        ("max_points", "EP"),
        ("lost", "EP"),
    ],
)
def test_special_points_have_the_labels_of_auto(kind: str, label: str) -> None:
    assert special(kind, 5.0).label == label
    assert LABELS[kind] == label


def test_a_special_point_states_its_place_and_its_period() -> None:
    text = repr(special("fold", 5.2))
    assert text == "SpecialPoint(fold at 5.2, period 0.015 s)"
