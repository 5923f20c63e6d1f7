"""A plate with too few modes for friction on its surface is doubted, and the paper's disc is not."""

import warnings
from collections import Counter
from collections.abc import Callable
from typing import Any

import pytest

import disc_model as dm
from disc_model import ImplausibleValue, Parameters
from disc_model.disc import plausibility
from disc_model.stability import few_modes
from disc_model.stability.few_modes import LARGEST, MOST_FOR_A_PLATE, MOST_IN_ALL
from disc_model.stability.sliding import modes_in_doubt
from tests.studies.refused import parse_grid

BRAKE = Parameters(
    N=5000, Omega=60, E=210e9, rho=7850, nu=0.3, h=6e-3, m=0.3, k=5e5, k_p=2e5, mu_s=0.45, mu_k=0.35,
    damping_ratio=5e-4, normalization="orthonormal", friction_offset="surface", contact_arc=0.35,
    n_diameters=5,
)  # fmt: skip
"""Grows at 2.2/s at 3.3 kHz, and with 28 diameters and 5 circles at 4.8/s at 8.2 kHz."""
SAID = (
    "with 5 diameters and 0 circles steady sliding grows at 2.17/s (3343 Hz), and with 8 diameters"
)


@pytest.fixture(autouse=True)
def nothing_was_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plausibility, "_reported", set())
    monkeypatch.setattr(few_modes, "_compared", Counter())


def told_by(call: Callable[[], Any]) -> list[str]:
    """What is said of the number of modes."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    doubts = [each for each in caught if each.category is ImplausibleValue]
    texts = [str(each.message) for each in doubts]
    return [text for text in texts if "choose_modes" in text]


@pytest.mark.parametrize(
    "call",
    [
        lambda: dm.steady_sliding(BRAKE),
        lambda: [dm.steady_sliding(BRAKE.replace(N=load)) for load in (5000, 6000)],
        lambda: dm.critical(BRAKE, "Omega", (40, 60), points=3, kind="sliding"),
        lambda: dm.sweep(dm.steady_sliding, BRAKE, Omega=[40, 60], workers=2, processes=True),
    ],
    ids=["call", "calls", "critical", "sweep"],
)
def test_a_brake_disc_with_five_diameters_is_doubted_once(call: Callable[[], Any]) -> None:
    """It gave a confident map of a growth rate that is less than half of the converged one."""
    [text] = told_by(call)
    assert "choose_modes(case, quantity='sliding_growth')" in text
    assert "contact_arc" not in text
    if "2.17/s" in text:
        assert text.startswith(SAID)


def test_at_a_point_the_arc_of_the_pad_is_asked_for() -> None:
    [text] = told_by(lambda: dm.steady_sliding(BRAKE.replace(contact_arc=0)))
    assert text.endswith("under a point no number is: give contact_arc, the arc of the pad")


@pytest.mark.parametrize(
    "case",
    [
        Parameters(N=385, Omega=20, friction_offset="surface"),
        Parameters(N=385, Omega=20, friction_offset="surface", normalization="orthonormal", E=1e11),
        BRAKE.replace(friction_offset=0),
        BRAKE.replace(contact_arc=0.4, n_diameters=6),  # 2.4/s, and 3.2/s with 9 and a circle
        BRAKE.replace(n_diameters=8, n_circles=1),
        BRAKE.replace(mu_s=0, mu_k=0),
    ],
    ids=["paper", "paper, E", "middle plane", "six", "circle", "without friction"],
)
def test_the_paper_s_disc_and_enough_modes_are_not_doubted(case: Parameters) -> None:
    assert told_by(lambda: dm.steady_sliding(case)) == []


def test_few_cases_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """Studies and sweeps take hardly longer: one case of a plate is compared, three if nothing grows."""
    computed: list[int] = []

    def growth(p: Parameters) -> few_modes.Growth:
        computed.append(p.n_diameters)
        return few_modes.Growth(-1.0, float("nan"))

    found = few_modes.Growth(-1.0, float("nan"))
    for _ in range(5):
        assert few_modes.doubt_of_modes(BRAKE, growth, found) == ""
    assert computed == MOST_FOR_A_PLATE * [8]
    for thousandths in range(40):
        case = BRAKE.replace(h=5e-3 + 1e-4 * thousandths)
        few_modes.doubt_of_modes(case, growth, found)
    assert len(computed) == MOST_IN_ALL
    monkeypatch.setattr(few_modes, "_compared", Counter())
    many = BRAKE.replace(n_diameters=20)
    assert LARGEST < 2 * (2 * 30 + 1)
    assert not few_modes.may_have_few_modes(many)


def test_a_study_says_it_once() -> None:
    """Of the case at its upper end."""
    base = BRAKE.model_dump(exclude={"Omega", "N", "D_star", "disc"}, exclude_defaults=True)
    raw: dict[str, Any] = {"study": "pad", "quantity": "floquet", "base": base}
    raw["axes"] = {"Omega": [40, 60], "N": [1000, 5000]}
    doubts = [text for text in parse_grid(raw).doubts if "choose_modes" in text]
    assert len(doubts) == 1
    assert doubts[0].startswith(SAID)
    assert modes_in_doubt(BRAKE) == "", "it is told"
