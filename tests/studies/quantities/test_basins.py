"""Shares of what many starts come to, and the critical energy of separation."""

from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest

from disc_model.data.variables import WORDS, Outcome
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.stability import attractors
from disc_model.stability.follower import Attractor, OutcomeResult
from disc_model.studies.quantities import basins
from disc_model.studies.quantities.basins import AttractorBasins
from disc_model.studies.quantity import Point
from tests.stability.test_attractor import stretch
from tests.studies.conftest import compute

CALM = stretch(u_min=0, u_max=1e-5, separation_rate=0, stick_fraction=0.3, separation_fraction=0)
NEAR = Attractor(Outcome.STICK_SLIP, CALM, 0.015, 1, -0.1, np.zeros((1, 2)))
APART = Attractor(Outcome.SEPARATING, stretch(u_min=0, u_max=0.03))


class Made:
    """Of a start i, what is kicked by more than `least` separates, in J; further starts are as
    said."""

    classes: ClassVar[dict[int, OutcomeResult]] = {}

    def __init__(self, p, horizon, **_) -> None:
        self.p = p
        self.known = [NEAR, APART]

    def copy(self) -> "Made":
        return self

    @staticmethod
    def least(p: Parameters, i: int) -> float:
        return 0.02 * (i + 1)

    def follow(self, state: tuple[float, int]) -> OutcomeResult:
        energy, i = state
        if i in self.classes:
            return self.classes[i]
        attractor = NEAR
        if energy > self.least(self.p, i):
            attractor = APART
        return OutcomeResult(attractor.kind, 50.0, attractor=attractor)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(attractors, "Basins", Made)
    monkeypatch.setattr(
        attractors, "random_perturbation", lambda p, state, energy, key: (energy, key[2])
    )


def found(**options):
    return compute(AttractorBasins.model_validate(options), [Point(Parameters(N=385, Omega=14))])


def test_shares_are_counted_with_wilsons_intervals(made: None) -> None:
    """Three of ten: 0.108 to 0.603 (Wilson 1927, at 95 %)."""
    table = found(energies=[0.07], n_starts=10).arrays
    classes = list(basins.CLASSES)
    place = (0, classes.index("separating"))
    assert table["basin_fraction"][place] == 0.3
    assert table["basin_fraction_low"][place] == pytest.approx(0.1078, abs=1e-4)
    assert table["basin_fraction_high"][place] == pytest.approx(0.6032, abs=1e-4)
    assert table["basin_fraction"][0, classes.index("stick_slip")] == 0.7
    assert table["basin_fraction_low"][0, classes.index("undecided")] == pytest.approx(0, abs=1e-12)
    assert table["basin_fraction_by_energy"][0, 0].sum() == 1
    assert table["attractor_starts"][0, :3].tolist() == [7, 3, 0]
    assert table["attractor_index"][0, 0].tolist() == [2, 2, 2, *[1] * 7]


SEPARATES = basins.CLASSES.index("separating")


@pytest.mark.parametrize(
    ("share", "place"),
    [
        ("separating_fraction", (0,)),
        ("basin_fraction", (0, SEPARATES)),
        ("basin_fraction_by_energy", (0, 0, SEPARATES)),
    ],
)
def test_intervals_of_all_shares_have_the_stated_confidence(
    made: None, share: str, place: tuple[int, ...]
) -> None:
    """Three of ten: 0.154 to 0.503 by Wilson's formula with z = 1.2816, at 80 %."""
    table = found(energies=[0.07], n_starts=10, confidence=0.8).arrays
    assert table[share][place] == 0.3
    assert table[f"{share}_low"][place] == pytest.approx(0.1538, abs=1e-4)
    assert table[f"{share}_high"][place] == pytest.approx(0.5026, abs=1e-4)


UNDECIDED = OutcomeResult(Outcome.UNDECIDED, 60.0)


Arrays = dict[str, np.ndarray]


@pytest.fixture
def of_four_starts(made: None, undecided: int, monkeypatch: pytest.MonkeyPatch) -> Arrays:
    """A table of four starts of which the first are undecided, and of the others every second one
    separates."""

    def least(p: Parameters, i: int) -> float:
        return 1.0 * (i % 2)

    results = dict.fromkeys(range(undecided), UNDECIDED)
    monkeypatch.setattr(Made, "classes", results)
    monkeypatch.setattr(Made, "least", staticmethod(least))
    return found(energies=[0.5], n_starts=4).arrays


INTERVALS = {
    4: (0.0, 1.0),
    2: (0.0456, 0.9544),  # of one, 0.0456 to 0.6994, and of three, 0.3006 to 0.9544
    0: (0.1500, 0.8500),
}
"""Ends of the interval of the share that separates, by the number of undecided starts."""


@pytest.mark.parametrize("undecided", INTERVALS)
def test_undecided_starts_widen_the_interval_of_the_share_that_separates(
    of_four_starts: Arrays, undecided: int
) -> None:
    """All four starts undecided gave an interval from 0 to 0.49, and most separated later."""
    low = of_four_starts["separating_fraction_low"][0]
    high = of_four_starts["separating_fraction_high"][0]
    assert (low, high) == pytest.approx(INTERVALS[undecided], abs=1e-4)


@pytest.mark.parametrize("undecided", INTERVALS)
def test_undecided_starts_widen_the_interval_of_the_class_that_separates(
    of_four_starts: Arrays, undecided: int
) -> None:
    low = of_four_starts["basin_fraction_low"][0, SEPARATES]
    high = of_four_starts["basin_fraction_high"][0, SEPARATES]
    assert (low, high) == pytest.approx(INTERVALS[undecided], abs=1e-4)


@pytest.mark.parametrize(("undecided", "share"), [(4, np.nan), (2, 0.5), (0, 0.5)])
def test_the_share_that_separates_is_that_of_the_decided_starts(
    of_four_starts: Arrays, share: float
) -> None:
    of_classes = of_four_starts["basin_fraction"][0]
    separating = of_four_starts["separating_fraction"][0]
    assert separating == pytest.approx(share, nan_ok=True)
    assert of_classes.sum() == pytest.approx(1)


@pytest.mark.parametrize(("first", "said"), [(3.0, "yes"), (np.nan, "not_yet")])
def test_a_start_that_will_lose_contact_does_not_keep_it(
    made: None, first: float, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Starts that came to an attractor on which contact is lost were said to keep contact."""
    leaves = OutcomeResult(APART.kind, 95.0, attractor=APART, first_separation=first)
    monkeypatch.setattr(Made, "classes", {0: leaves})
    monkeypatch.setattr(Made, "least", staticmethod(lambda p, i: 1.0))
    table = found(energies=[0.5], n_starts=2).arrays
    words = AttractorBasins.COLUMNS["lost_contact"].flags
    leaving, staying = table["lost_contact"][0, 0]
    assert words[leaving] == said
    assert words[staying] == "no"


def test_the_least_kick_is_bisected_along_the_start_that_separates_first(made: None) -> None:
    table = found(energies=[0.05, 1.0], n_starts=3, n_bisection_directions=2, precision=0.01).arrays
    assert table["critical_energy_sampled"] == 0.05
    low = table["critical_energy_lower"][0]
    high = table["critical_energy"][0]
    assert low <= 0.02 < high <= low * 1.01
    assert np.isnan(found(energies=[0.01], n_starts=3).arrays["critical_energy"][0])


def test_directions_depend_on_the_seed_the_energy_and_the_start(
    made: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = []

    def kicked(p: Parameters, state: object, energy: float, key: tuple[int, int, int]) -> object:
        keys.append(key)
        return energy, key[2]

    monkeypatch.setattr(attractors, "random_perturbation", kicked)
    found(energies=[0.05, 1.0], n_starts=2, seed=7, n_bisection_directions=0)
    assert set(keys) == {(7, 0, 0), (7, 0, 1), (7, 1, 0), (7, 1, 1)}


def test_what_separates_by_itself_needs_no_energy(
    made: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Made, "least", staticmethod(lambda p, i: -1.0))
    table = found(energies=[0.05, 1.0], n_starts=2).arrays
    assert table["critical_energy"] == 0.0
    assert np.isnan(table["critical_energy_lower"][0])
    assert table["critical_energy_sampled"] == 0.05


def test_a_bisection_that_finds_no_energy_without_separation_says_how_low_it_went(
    made: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All energies separate but 0 itself."""
    monkeypatch.setattr(Made, "least", staticmethod(lambda p, i: 0.0))
    table = found(energies=[0.5], n_starts=1).arrays
    assert np.isnan(table["critical_energy_lower"][0])
    assert 0 < table["critical_energy"][0] < 0.5 * 2.0**-37


def test_attractors_of_a_case_are_found_once_for_all_its_starts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """169 starts of one case each looked for them."""
    cases = []
    known = []

    class Counted(Made):
        def __init__(self, p, horizon, **_) -> None:
            super().__init__(p, horizon)
            cases.append(p.Omega)

        def copy(self) -> Made:
            other = Counted.__new__(Counted)
            other.p = self.p
            other.known = [*self.known]
            return other

        def follow(self, state: tuple[float, int]) -> OutcomeResult:
            known.append(len(self.known))
            self.known.append(NEAR)
            return OutcomeResult(NEAR.kind, 50.0, attractor=NEAR)

    monkeypatch.setattr(attractors, "Basins", Counted)
    points = [Point(Parameters(N=385, Omega=Omega)) for Omega in (14, 14, 14, 15)]
    compute(AttractorBasins(), points)
    assert cases == [14, 15]
    assert known == [2] * 4, "what a point gives depends on none before it"


LOST: Any = SimpleNamespace(status=Status.NON_FINITE, message="lost")


@pytest.mark.parametrize(("failed", "status"), [(1, Status.OK), (3, Status.NON_FINITE)])
def test_a_point_fails_if_all_its_starts_do(
    made: None, failed: int, status: Status, monkeypatch: pytest.MonkeyPatch
) -> None:
    results = {i: OutcomeResult(None, 1.0, failed=LOST) for i in range(failed)}
    monkeypatch.setattr(Made, "classes", results)
    table = found(energies=[0.01], n_starts=3)
    [code] = table.arrays["status"]
    assert WORDS["point_statuses"][code] == status
    assert table.messages == [f"{failed} of 3 starts failed, such as lost"]
    share = table.arrays["basin_fraction"][0, basins.CLASSES.index("failed")]
    assert share == pytest.approx(failed / 3)


@pytest.mark.parametrize(("directions", "least"), [(1, 0.04), (2, 0.01)])
def test_the_critical_energy_is_the_least_of_the_directions_that_are_bisected(
    made: None, directions: int, least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    ends = (0.04, 0.01)
    monkeypatch.setattr(Made, "least", staticmethod(lambda p, i: ends[i]))
    table = found(
        energies=[0.05], n_starts=2, precision=0.01, n_bisection_directions=directions
    ).arrays
    low = table["critical_energy_lower"][0]
    high = table["critical_energy"][0]
    assert low <= least < high


def test_a_bisection_from_a_small_energy_gives_up_as_many_halvings_below_it(
    made: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Made, "least", staticmethod(lambda p, i: 0.0))
    first = 2.0**-10
    table = found(energies=[first], n_starts=1).arrays
    assert 0 < table["critical_energy"][0] < first * 2.0**-37


def test_a_study_says_how_many_starts_are_undecided(
    made: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only the function said so, and a study's list of remarks was empty with all starts undecided."""
    lost = OutcomeResult(Outcome.UNDECIDED, 60.0, first_separation=2.0)
    monkeypatch.setattr(Made, "classes", {0: UNDECIDED, 1: lost})
    [message] = found(energies=[0.01], n_starts=4).messages
    told = "2 of 4 starts (1 after contact was lost) undecided within the horizon: raise it"
    assert message == told


def test_a_study_tells_failed_starts_from_undecided_ones(
    made: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone = OutcomeResult(None, 1.0, failed=LOST)
    monkeypatch.setattr(Made, "classes", {0: UNDECIDED, 1: gone})
    [message] = found(energies=[0.01], n_starts=4).messages
    of_failed, of_undecided = message.split("; ")
    assert of_failed == "1 of 4 starts failed, such as lost"
    assert of_undecided == "1 of 4 starts undecided within the horizon: raise it"
