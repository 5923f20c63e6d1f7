"""Anything in the parameter box and beyond ends with a result or a named status, and breaks no law
on the way."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from disc_model import Execution, Parameters, Result, State, Status, Window, plate_modes, simulate
from disc_model.simulation.states import static_start
from tests.references.fixed_step import switches

# phase left -> (kind, phase entered): the table of switches
LEGAL = {
    "stick": {
        ("stick_to_slip", "slip"),
        ("stick_to_slip", "separation"),
        ("separation", "separation"),
    },
    "slip": {("slip_to_stick", "stick"), ("slip_reversal", "slip"), ("separation", "separation")},
    "separation": {
        *(("reattachment", phase) for phase in ("slip", "stick", "separation")),
        ("separation", "separation"),
    },
}


def magnitude(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers spread evenly over their logarithm."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda x: float(10**x))


def sometimes_zero(low: float, high: float) -> st.SearchStrategy[float]:
    return st.one_of(st.just(0.0), magnitude(low, high))


@st.composite
def parameters(draw: st.DrawFn) -> Parameters:
    mu_k = draw(st.one_of(st.just(0.0), st.floats(0, 1.5)))
    return Parameters(
        N=draw(sometimes_zero(1e-6, 1e5)), Omega=draw(sometimes_zero(1e-3, 1e3)), m=draw(magnitude(1e-6, 10)),
        E=draw(st.one_of(st.just(150e9), magnitude(1e6, 1e20))), k=draw(sometimes_zero(1, 1e8)),
        k_p=draw(sometimes_zero(1, 1e8)), c=draw(sometimes_zero(1e-3, 1e6)), c_p=draw(sometimes_zero(1e-3, 1e6)),
        D_star=draw(sometimes_zero(1e-8, 100)), mu_k=mu_k,
        mu_s=mu_k + draw(st.one_of(st.just(0.0), st.floats(0, 0.5))),
        normalization=draw(st.sampled_from(["as_published", "orthonormal"])),
        contact=draw(st.sampled_from(["unilateral", "bilateral"])),
    )  # fmt: skip


def run(p: Parameters, radians: float, tol: float) -> Result:
    """A run of so many radians of the highest mode, a second at most, sampled throughout."""
    t_end = min(1.0, radians / float(plate_modes(p).omega.max()))
    window = Window(start=0, stop=t_end, rate=400 / t_end)
    execution = Execution(max_steps=20_000, audit_every_step=True)
    return simulate(p, t_end, {"all": window}, tol=tol, execution=execution)


def check_laws(result: Result, phase: str = "stick") -> None:
    """``phase`` : in which it starts."""
    p = result.parameters
    events = result.events
    assert np.all(np.diff(events.time) >= 0)
    for kind, entered in zip(events.kind, events.phase, strict=True):
        assert (kind, entered) in LEGAL[phase], (phase, kind, entered)
        phase = entered
    samples = result.samples["all"]
    for name, values in samples.items():
        assert np.all(np.isfinite(values)), name
    in_contact = samples["phase"] < 2
    if p.contact == "unilateral":
        # a loss of contact that was missed would show as a tension; P is a sum of terms as large as
        # its own extremes
        size = max(p.N, np.abs(samples["P"]).max(initial=0.0))
        assert samples["P"][in_contact].min(initial=0.0) >= -1e-6 * size
    # the slip's direction is the sign of f; contact means that slider and disc are at the same
    # height
    scale = max(np.abs(samples["w"]).max(), np.abs(samples["u"]).max(), 1e-300)
    np.testing.assert_allclose(
        samples["u"][in_contact], samples["w"][in_contact], rtol=0, atol=1e-12 * scale
    )
    # where contact is lost P is zero to within the tolerance, and the gap opens with an error of
    # that share
    assert np.all(samples["u"] - samples["w"] >= -(1e-9 + 10 * result.tol) * scale)


def check_paradox(result: Result) -> None:
    """A paradox is one: the denominator of P in slip is not positive."""
    p = result.parameters
    state = result.final_state
    modes = plate_modes(result.parameters)
    psi = modes.psi.to_numpy()
    diameters = modes.diameters.to_numpy()
    free = 1 + p.m * float(psi @ psi)
    slope = float(psi * diameters @ state.b)
    # the direction that could not be entered is not in the state where stick or separation was to
    # end in slip, nor where slip was to turn round: f = 0 and the direction is the one before
    if state.direction and state.f != 0:
        directions = [state.direction]
    else:
        directions = [-1, 1]
    # rounding in sums of as many terms as there are modes, and the engine's own margin of 1e-6
    assert min(free + s * p.mu_k * slope / p.r_0 for s in directions) <= 2e-6 * free


def check_ending(result: Result) -> None:
    """At the end of the time, or with a message that says where, and with a paradox only if it is
    one."""
    if result.status is Status.OK:
        assert result.final_state.time == pytest.approx(result.t_end, rel=1e-14)
    else:
        assert f"at t = {result.final_state.time:.9g}" in result.message
    if result.status is Status.PARADOX:
        check_paradox(result)


# slip turns round where the other direction has no solution
NO_WAY_BACK = Parameters(
    N=1000,
    Omega=1,
    D_star=0,
    c=10,
    c_p=0,
    k=0,
    k_p=1e7,
    E=1e8,
    m=1e-5,
    mu_s=0.25,
    mu_k=0.25,
    contact="bilateral",
)


@pytest.mark.compiled
def test_a_reversal_into_a_direction_without_solution_is_a_paradox() -> None:
    result = run(NO_WAY_BACK, 10, 1e-10)
    assert result.status is Status.PARADOX
    assert result.final_state.f == 0
    check_paradox(result)


@pytest.mark.compiled
@given(parameters(), st.floats(10, 3000), magnitude(1e-14, 1e-4))
@example(NO_WAY_BACK, 10.0, 1e-4)
def test_every_run_ends_with_a_result_or_a_named_status(
    p: Parameters, radians: float, tol: float
) -> None:
    result = run(p, radians, tol)
    assert isinstance(result.status, Status)
    assert result.statistics["steps"] <= 20_000
    check_laws(result)
    check_ending(result)


# ------------------------------------------------------------------------------------ switches at
# the edge of being one
FIRST = yaml.safe_load(Path(__file__).with_name("first_switches.yaml").read_text(encoding="utf-8"))
AT_ONCE = ("a strong damper breaks stick at once", "no friction breaks stick at once")


def changed(state: State, **changes: float | str) -> State:
    """Another state: a and alpha of the first mode with a nodal diameter, and u, are added to what
    is there."""
    one = np.arange(len(state.a)) == 1
    added = {
        name: getattr(state, name) + changes[name] * one
        for name in ("a", "alpha")
        if name in changes
    }
    height = {}
    if "u" in changes:
        height = {"u": state.u + changes["u"]}
    return state.replace(time=0.0, _roots=(0, 0), **changes | added | height)


def beginning(what: str) -> tuple[Parameters, State]:
    """A case of first_switches.yaml, and its start."""
    values, changes, _ = FIRST[what]
    p = Parameters(**{"N": 200, "Omega": 10} | values)
    if not changes:
        return p, static_start(p)
    state = simulate(p, 1e-6).final_state
    return p, changed(state, **changes)


@pytest.mark.parametrize("what", FIRST)
def test_first_switches(what: str) -> None:
    kinds = FIRST[what][2]
    p, start = beginning(what)
    result = simulate(p, 0.05, initial_state=start)
    rests = p.Omega == 0 and result.final_state.phase == "stick"
    assert result.status is (Status.AT_REST if rests else Status.OK)
    events = result.events
    assert list(events.kind[: len(kinds) or None]) == kinds
    if what in AT_ONCE:
        assert events.time[0] == 0
    elif not kinds:
        assert np.abs(result.final_state.alpha).max() < 1e-12
    elif "tension" in what:
        assert events.time[0] == events.time[1]


# without a pull the slip before contact is lost lasts for 1e-11 s, within the rounding of what
# steps of 1e-5 s end with
SEEN_BY_STEPS = [what for what in FIRST if not what.endswith(("pulled by 1e-08", "pulled by 0.0"))]


@pytest.mark.parametrize("what", SEEN_BY_STEPS)
def test_switches_are_those_of_fixed_steps(what: str) -> None:
    """The paper's method shares no code with the engine; its error falls sixteenfold where steps
    are half as long."""
    p, start = beginning(what)
    right = simulate(p, 0.01, tol=1e-13, initial_state=start).events
    errors = []
    for step in (2e-5, 1e-5):
        times, kinds = switches(p, start, 0.01, step)
        assert kinds == list(right.kind)
        errors.append(np.abs(times - right.time.to_numpy()).max(initial=0))
    # on the stiff spring the slider swings at 7,000 rad/s: 0.14**5 / 120 / 7,000 s are lost in each
    # of 500 steps
    assert errors[0] < 1e-7
    assert errors[1] <= max(errors[0] / 10, 1e-12)


def test_no_preload_slips_at_once_and_never_separates() -> None:
    result = simulate(Parameters(N=0, Omega=15), 1)
    assert result.status is Status.OK
    # f = Omega (1 - cos) touches zero once a swing: rounding decides whether that counts as a
    # reversal
    assert set(result.events.kind) <= {"stick_to_slip", "slip_reversal"}
    assert result.events.time[0] == 0
    # no friction: the slider swings about the drive point, psi'' = -k_p/m psi with psi' = Omega at
    # the start
    rate = np.sqrt(2e4 / 0.1)
    assert result.final_state.psi == pytest.approx(15 / rate * np.sin(rate), abs=1e-11)


# ------------------------------------------------------------------------------------ where a step
# or a run ends


@pytest.mark.parametrize("tol", [1e-8, 1e-13])
@pytest.mark.parametrize("lifted", [-0.03, -0.003, 0.01])
def test_equal_friction_coefficients_in_violent_motion(lifted: float, tol: float) -> None:
    """The error of a release's time gives f' either sign where it is zero; that is no paradox."""
    p = Parameters(N=300, Omega=20, mu_s=0.4, mu_k=0.4)
    start = changed(simulate(p, 1e-6).final_state, a=lifted / plate_modes(p).psi[1], u=lifted)
    events = simulate(p, 0.3, tol=tol, initial_state=start).raise_for_status().events
    assert {"stick_to_slip", "slip_to_stick"} <= set(events.kind)
