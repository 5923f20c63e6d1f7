"""Cycles that slip all the time, of a block against an independent method, and of a disc."""

import math

import numpy as np
import pytest

import disc_model as dm
from disc_model.data.variables import CycleStatus
from tests.references import block
from tests.refusals import refusal
from tests.stability.test_block import END_OF_STICK_SLIP, JUMP, RIG
from tests.stability.test_slipping_map import DISC

pytestmark = pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")


@pytest.mark.parametrize("Omega", [1.65, 2.0, 2.3])
def test_the_cycle_of_a_block_is_that_of_an_independent_method(Omega) -> None:
    p = RIG.replace(Omega=Omega)
    cycle = dm.floquet(p, kind="slipping")
    stretch = cycle.state.psi * p.r_0
    period, expected = block.slipping_cycle(p, 0.999 * stretch, 1.001 * stretch)
    # the largest stretch is determined a hundred times less sharply, by a multiplier near 1
    assert cycle.period == pytest.approx(period, rel=1e-12)
    assert stretch == pytest.approx(expected, rel=1e-10)
    assert cycle.stick_fraction == 0
    assert cycle.kind == "slipping"
    assert cycle.message.endswith("with 0 releases")


@pytest.mark.parametrize("Omega", [1.65, 2.0, 2.3])
def test_the_multiplier_of_a_block_is_that_of_an_independent_method(Omega) -> None:
    p = RIG.replace(Omega=Omega)
    cycle = dm.floquet(p, kind="slipping")
    stretch = cycle.state.psi * p.r_0
    step = 1e-4 * stretch
    ends = [block.next_extreme_pull(p, stretch + side * step)[1] for side in (1, -1)]
    multiplier = (ends[0] - ends[1]) / (2 * step)
    assert cycle.multipliers.tolist() == [pytest.approx(multiplier, abs=1e-6)]


@pytest.mark.parametrize("p", [RIG, DISC])
def test_the_cycle_separates_motions_to_stick_slip_from_those_to_steady_sliding(p) -> None:
    cycle = dm.floquet(p, kind="slipping")
    assert not cycle.stable
    assert cycle.sliding.stable
    assert not cycle.stable
    periods = math.ceil(math.log(1000) / math.log(abs(cycle.multipliers[0])))
    sticks = []
    for share in (0.99, 1.01):
        rest = dm.steady_sliding(p).psi
        start = cycle.state.replace(psi=rest + share * (cycle.state.psi - rest))
        run = dm.simulate(p, periods * cycle.period, initial_state=start)
        sticks.append(run.statistics["time_stick"] > 0)
    assert sticks == [False, True]


@pytest.mark.parametrize("Omega", [1.5, 2.35])
def test_there_is_none_below_the_hopf_point_and_above_the_end_of_stick_slip(Omega) -> None:
    cycle = dm.floquet(RIG.replace(Omega=Omega), kind="slipping")
    assert cycle.status is CycleStatus.NO_CYCLE
    assert cycle.message == "no_cycle: no cycle round steady sliding slips all the time"
    assert cycle.kind == "slipping"


BONDED = {"N": 0, "n_diameters": 0, "contact": "bilateral"}  # contact is kept


@pytest.mark.parametrize("change", [{"Omega": 0}, {"N": 0}, {"k_p": 0}, BONDED])
def test_without_drive_preload_or_spring_there_is_none(change) -> None:
    cycle = dm.floquet(RIG.replace(**change), kind="slipping")
    assert cycle.status is CycleStatus.NO_CYCLE
    assert "no steady sliding on a spring" in cycle.message


@pytest.mark.parametrize("c_p", [0, 0.1])
def test_friction_that_only_jumps_has_none_that_is_isolated(c_p) -> None:
    """Without damping every motion that slips on returns, and rounding makes it grow or decay."""
    cycle = dm.floquet(JUMP.replace(c_p=c_p), kind="slipping")
    assert cycle.status is CycleStatus.NO_CYCLE


def test_the_branch_of_a_block_ends_at_its_hopf_point_and_where_stick_slip_ends() -> None:
    branch = dm.continue_cycle(RIG, "Omega", (1.0, 3.0), kind="slipping")
    first, last = branch.special_points.to_dict("records")
    hopf = block.hopf_speed(RIG) / RIG.r_0
    # the smallest cycle has an amplitude of 1e-4, of which the speed depends on the square
    assert first["kind"] == "hopf"
    assert first["Omega"] == pytest.approx(hopf, rel=1e-8)
    rate = abs(block.sliding_eigenvalues(RIG.replace(Omega=hopf))[0].imag)
    assert first["period"] == pytest.approx(math.tau / rate, rel=1e-7)
    assert last["kind"] == "grazing"
    assert last["Omega"] == pytest.approx(END_OF_STICK_SLIP, abs=2e-7)  # steps are no shorter
    assert branch.ended == "hopf; grazing"
    assert np.all(branch.growth_rate > 0)
    assert not branch.stick_fraction.any()

    there = int(np.argmin(np.abs(branch.values - 1.8)))
    own = dm.floquet(branch.case_at(there), kind="slipping")
    assert branch.period[there] == pytest.approx(own.period, rel=1e-11)
    assert branch.state(there).psi == pytest.approx(own.state.psi, rel=1e-9)
    marks = [line.get_label() for line in branch.plot("period").lines]
    assert "Hopf point" in marks


def test_the_branch_of_a_disc_ends_where_steady_sliding_loses_stability() -> None:
    branch = dm.continue_cycle(DISC, "Omega", (2.0, 3.6), kind="slipping")
    first = branch.special_points.iloc[0]
    assert first["kind"] == "hopf"
    values = dm.steady_sliding(DISC.replace(Omega=first["Omega"])).eigenvalues
    slider = values[np.argmin(np.abs(values - 1j * math.tau / first["period"]))]
    # relative to the rate itself, by the square of the smallest amplitude
    assert abs(slider.real) < 1e-8 * slider.imag
    assert slider.imag == pytest.approx(math.tau / first["period"], rel=1e-7)


@pytest.mark.parametrize(
    ("options", "fault"),
    [
        ({"kind": "sliding"}, "kind='sliding': must be"),
        ({"kind": "slipping", "releases": 2}, "releases=2: must be"),
        ({"kind": "slipping", "guess": dm.State}, "guess=.*: must be None for a cycle in slip"),
    ],
)
def test_wrong_requests_are_named(options, fault) -> None:
    if "guess" in options:
        options = options | {"guess": dm.simulate(RIG, 0.1).final_state}
    with refusal(fault):
        dm.floquet(RIG, **options)
    with refusal(fault):
        dm.continue_cycle(RIG, "Omega", (1, 3), **options)


def test_a_branch_needs_a_cycle_to_begin_with() -> None:
    with refusal("case: must have a cycle, but the search ended with"):
        dm.continue_cycle(RIG.replace(Omega=2.5), "Omega", (1, 3), kind="slipping")
