"""Small changes of state and parameters, along a motion and through every kind of switch: against
differences."""

from collections.abc import Callable

import numpy as np
import pytest

from disc_model import Parameters, plate_modes
from disc_model.data.variables import PHASES
from disc_model.engine import columns, saltation, transitions
from disc_model.engine.state import phase_of
from disc_model.simulation.states import engine_case
from disc_model.stability.return_map import PARAMETERS, parameter_change
from tests.contact_laws import COMPILES, COUPLED, FALLING, LAWS
from tests.engine.full_system import Full
from tests.references import stored, taylor
from tests.references.printed import MOTIONS, P, lively


def differences(function, h: float):
    """Derivative at 0, to fourth order."""
    return (function(-2 * h) - 8 * function(-h) + 8 * function(h) - function(2 * h)) / (12 * h)


# ------------------------------------------------------------------------------------ through one switch
#: What ends a phase, and which: (phase, direction, kinds of events).
SWITCHES = {
    "at rest": ("slip", 1, ["slip_to_stick"]),
    "at rest, slip backwards": ("slip", -1, ["slip_to_stick"]),
    "reversal": ("slip", 1, ["slip_reversal"]),
    "contact lost": ("slip", 1, ["separation"]),
    "contact lost, slip backwards": ("slip", -1, ["separation"]),
    "contact lost in stick": ("stick", 0, ["separation"]),
    "release": ("stick", 0, ["stick_to_slip"]),
    "release backwards": ("stick", 0, ["stick_to_slip"]),
    "impact": ("separation", 0, ["reattachment"]),
    "impact, left in tension": ("separation", 0, ["reattachment", "separation"]),
}
#: Two laws are residual: their compliance changes with Young's modulus.
RESIDUAL = {"contact_compliance": "residual", "normalization": "orthonormal"}
CONTACTS = {
    "vertical": {}, **LAWS, "compliant": RESIDUAL, "residual_normal": RESIDUAL | {"contact_force": "normal"}, **COUPLED,
    **FALLING, "residual_normal_falling": RESIDUAL | {"contact_force": "normal", "friction_decay": 2.0},
}  # fmt: skip
#: Where nothing pulls the reference meets two switches at once; a compliant contact begins without tension.
NOT_THERE = [
    *(
        (law, "contact lost in stick")
        for law in CONTACTS
        if law.removeprefix("residual_").startswith("normal")
    ),
    *(
        (law, "impact, left in tension")
        for law in CONTACTS
        if "compliant" in law or "residual" in law
    ),
    # a surface that moves pulls at the slider: friction gives way first
    *(
        (law, "contact lost in stick")
        for law, contact in CONTACTS.items()
        if "friction_offset" in contact
    ),
]
THROUGH = [
    pytest.param(law, switch, marks=COMPILES if law != "vertical" else ())
    for law in CONTACTS
    for switch in SWITCHES
    if (law, switch) not in NOT_THERE
]


def solved(function: Callable[[float], float]) -> float:
    """Where a linear function is zero."""
    return function(0.0) / (function(0.0) - function(1.0))


def about_to(
    switch: str, law: str, pressed: float | None = None
) -> tuple[Parameters, stored.State]:
    """A case, and a state on a slope of a third that soon meets the switch, with the contact force
    ``pressed`` (N)."""
    phase, direction, _ = SWITCHES[switch]
    backwards = "backwards" in switch
    # with a circle there are two modes without nodal diameter, each with its own share of an
    # impulse
    p = P.replace(n_diameters=1, **CONTACTS[law])
    if switch == "contact lost in stick":
        # it is not friction that ends stick: it holds on the slope, or nothing pulls
        p = p.replace(
            **({"mu_s": 4.0} if law.startswith("compliant_normal") else {"k_p": 0.0, "c_p": 0.0})
        )
    start = stored.reference_state(lively(phase, direction, p), p)
    q = taylor.problem_of(p)
    level = np.array(start.a)
    flies = phase == "separation"
    thrown = "lost" in switch or "release" in switch
    start.b, start.alpha = (
        np.array(start.b) * (-60 if backwards else 60),
        start.alpha + 6 * thrown * q.s / q.S2,
    )
    if "release" in switch and (q.t * q.w2 * start.beta).sum() * (-1 if backwards else 1) < 0:
        start.beta = -np.array(start.beta)  # the surface pulls to the side of the release
        start.f = surface_rate(q, start)
    if direction and not thrown:
        start.f = 0.03 * direction + surface_rate(q, start)
        if switch == "reversal":
            start.psi = -0.15
        else:
            start.psi = 0.004
    rate = start.f - surface_rate(q, start)
    start.u_velocity = q.s @ (start.alpha + q.l * rate * start.b) + (
        0 if q.rigid or flies else thrown
    )

    def forces(bent: float) -> tuple[float, float]:
        """R and T (in flight those of slip) where the disc, or the contact, is bent by so much."""
        start.a = level + (bent if q.rigid else 0) * q.s / q.w2
        start.u = q.s @ start.a - bent * q.C
        return taylor.Reference(q, start).forces(*(("slip", 1) if flies else (phase, direction)))

    def margin(psi: float) -> float:
        """Of friction, less 1 N."""
        start.psi = psi
        R, T = forces(bent)
        return p.mu_s * R + (T if backwards else -T) - 1

    def unloaded(psi: float) -> float:
        """Friction that would hold the slider."""
        start.psi = psi
        return taylor.Reference(q, start).forces("stick")[1]

    if pressed is None:
        pressed = 5.0 if "lost" in switch else -100.0 if "tension" in switch else 400.0
    if flies and not q.rigid:
        bent = 0.0
    else:
        bent = solved(lambda x: forces(x)[0] - pressed)
    forces(bent)
    if "release" in switch:
        margin(solved(margin))
    if "at rest" in switch and q.t.any():
        # nothing pulls at the slider that has come to rest on a moving surface
        start.psi = solved(unloaded)
        forces(bent)
    if flies:
        start.u, start.u_velocity = start.u + 1e-5, start.u_velocity - 0.5
    return p, start


def surface_rate(q: taylor.Problem, state: stored.State) -> float:
    """v_s / r_0 of the surface on which friction acts."""
    return q.surface_speed(np.array(state.beta)) / q.r_0


def flat(q: taylor.Problem, state: stored.State) -> np.ndarray:
    """psi, the rate g of the contact over the material, u, u', then a, b, alpha, beta of all
    modes."""
    y = np.concatenate([np.atleast_1d(x) for x in list(vars(state).values())[3:]])
    y[1] -= surface_rate(q, state)
    return y


def moved_to(q: taylor.Problem, start: stored.State, y: np.ndarray) -> stored.State:
    """The same phase at other coordinates, as `flat` has them."""
    modal = y[4:].reshape(4, -1).tolist()
    state = stored.State(0.0, start.phase, start.direction, *y[:4], *modal)
    state.f = state.f + surface_rate(q, state)
    return state


class Disturbances:
    """Two random disturbances of all coordinates of a start, and two of all parameters, in columns;
    their sizes."""

    def __init__(self, p: Parameters, start: stored.State) -> None:
        self.p = p
        self.start = start
        rng = np.random.default_rng(2)
        slow = 1500 / plate_modes(p)["omega"].to_numpy()
        pair = plate_modes(p)["diameters"].to_numpy() > 0
        self.sizes = np.concatenate(
            [[1e-4, 0.3, 1e-6, 0.03], *2 * [1e-5 * slow], np.full(2 * len(slow), 0.03)]
        )
        turns = start.phase != "stick"
        free = start.phase == "separation" or p.contact_compliance != 0
        there = np.concatenate([[True, turns, free, free], pair | True, pair, pair | True, pair])
        self.moved = (self.sizes * there)[:, None] * rng.normal(size=(len(there), 2))
        self.values = np.array([getattr(p, name) for name in PARAMETERS])
        self.changed = self.values[:, None] * rng.normal(size=(len(PARAMETERS), 2))

    def expected(
        self, function: Callable[[taylor.Problem, stored.State], np.ndarray]
    ) -> np.ndarray:
        """Derivatives of what follows from a case and a start, by each disturbance: one row
        each."""

        def changed(change: np.ndarray) -> taylor.Problem:
            return taylor.problem_of(
                self.p.replace(**dict(zip(PARAMETERS, self.values + change, strict=True)))
            )

        q = taylor.problem_of(self.p)
        # a moving surface pulls with thousands of newtons, which soon changes which event is first
        h = np.longdouble(1e-5 if q.t.any() else 1e-4)
        y = flat(q, self.start)
        found = [
            differences(lambda h, d=d: function(q, moved_to(q, self.start, y + h * d)), h)
            for d in self.moved.T
        ]
        found += [
            differences(lambda h, d=d: function(changed(float(h) * d), self.start), h)
            for d in self.changed.T
        ]
        return np.array(found, float)

    def run(self) -> Full:
        """The engine with these columns: in the first block those of the start, in the second those
        of parameters."""
        q = taylor.problem_of(self.p)
        start = moved_to(q, self.start, flat(q, self.start))
        run = Full(self.p, stored.engine_state(start, self.p))
        case = engine_case(self.p)
        t = run.tangent = columns.build_tangent(run.model, 8, run.order, 8)
        now = t.now.reshape(2, -1, 8)[0, :, :2]
        now[case.places] = (self._signs * self.moved[4:])[case.present]
        now[-4:] = self.moved[:4]
        by = np.array([parameter_change(self.p, run.model, name) for name in PARAMETERS])
        t.inputs.reshape(2, -1, 8)[1, :, :2] = by.T @ self.changed
        return run

    def read(self, run: Full) -> np.ndarray:
        """The columns, one row each."""
        case = engine_case(self.p)
        now = run.tangent.now.reshape(2, -1, 8)[:, :, :2]
        found = np.zeros((2, *self.moved.shape))
        found[:, 4 + case.present] = self._signs[case.present] * now[:, case.places]
        found[:, :4] = now[:, -4:]
        return np.concatenate(found, axis=1).T

    @property
    def _signs(self) -> np.ndarray:
        """Of the modes' amplitudes, which the reference makes positive."""
        return np.tile(np.sign(plate_modes(self.p)["psi"]), 4)[:, None]


def followed(p: Parameters, start: stored.State, span: float, kinds: list[str]) -> Full:
    """The engine after a time in which these events happen, its columns being those of the
    reference's differences."""
    disturbances = Disturbances(p, start)

    def end(q: taylor.Problem, start: stored.State) -> np.ndarray:
        run = taylor.Reference(q, start).run(span)
        assert [event["kind"] for event in run.events] == kinds
        return flat(q, run.state())

    engine = disturbances.run()
    assert engine.fly(float(span)) == transitions.TIME_OVER
    sizes = disturbances.sizes
    if not p.contact_compliance and kinds[-1] != "separation":
        sizes[2:4] = np.inf  # u and u' are the disc's
    got = disturbances.read(engine) / sizes
    expected = disturbances.expected(end) / sizes
    # frequencies of other Young's moduli are rounded: 1e-11 was found, and ten times as much, with ten
    # times smaller differences, where the surface moves
    allowed = 1e-9
    if p.friction_offset:
        allowed = 1e-8
    assert np.all(np.abs(got - expected) <= allowed * np.abs(expected).max(axis=1, keepdims=True))
    return engine


@pytest.mark.parametrize(("law", "switch"), THROUGH)
def test_derivatives_through_a_switch(law: str, switch: str) -> None:
    p, start = about_to(switch, law)
    kinds = SWITCHES[switch][2]
    run = taylor.Reference(taylor.problem_of(p), start)
    while not run.events:
        run.run(2 * run.time + 1e-7)
    span = 1.5 * run.events[0]["time"]
    engine = followed(p, start, span, kinds)
    ends = {"at rest": columns.STICKS, "reversal": columns.REVERSALS, "release": columns.RELEASES}
    ends |= {"release backwards": columns.BACK_RELEASES, "impact": None}
    counted = ends.get(switch.removesuffix(", slip backwards"), columns.SEPARATIONS)
    log = engine.tangent.log
    assert [i for i in range(columns.RELEASES, columns.STICKS + 1) if log[i]] == [counted] * (
        counted is not None
    )
    assert log[columns.RELEASES : columns.STICKS + 1].sum() == (counted is not None)
    first = PHASES.index(SWITCHES[switch][0])
    spent = np.zeros(len(PHASES))
    spent[first] = switched = float(run.events[0]["time"])
    spent[phase_of(engine.state)] += float(span) - switched
    times = log[columns.DURATION : columns.RELEASES]
    np.testing.assert_allclose(times, [float(span), *spent], rtol=0, atol=1e-9 * float(span))
    assert log[columns.N_STEPS] >= len(kinds)


@pytest.mark.parametrize("switch", ["release", "release backwards"])
def test_stick_that_friction_cannot_hold_ends_at_once_for_neighbouring_motions_too(
    switch: str,
) -> None:
    """The pull exceeds friction by 20 N from the start, so that no disturbance delays the release."""
    p, start = about_to(switch, "vertical")
    beyond = 20.0 / (p.k_p * p.r_0)
    start.psi += -beyond if "backwards" in switch else beyond
    span = 1e-5
    events = taylor.Reference(taylor.problem_of(p), start).run(span).events
    assert events[0]["time"] == 0
    followed(p, start, span, ["stick_to_slip"])


LOSSES = [("vertical", switch) for switch in SWITCHES if "lost" in switch]
LOSSES += [("vertical_coupled", switch) for _, switch in LOSSES if "stick" not in switch]


@pytest.mark.parametrize("pressed", [5.0, 0.0])
@pytest.mark.parametrize(
    ("law", "switch"),
    [pytest.param(*loss, marks=COMPILES if loss[0] != "vertical" else ()) for loss in LOSSES],
)
def test_when_contact_is_lost(law: str, switch: str, pressed: float) -> None:
    """No motion shows that, because no rate jumps there: the change of what vanishes, the numerator
    of P.

    What does not vanish where a phase ends at once was past zero already: neighbouring motions end
    it there, too.
    """
    phase, direction, _ = SWITCHES[switch]
    p, start = about_to(switch, law, pressed)
    disturbances = Disturbances(p, start)

    def numerator(q: taylor.Problem, start: stored.State) -> np.ndarray:
        run = taylor.Reference(q, start)
        inplane = (1 + q.m * q.St) * direction * q.mu_k * run.disc()[2] / q.r_0
        return run.forces(phase, direction)[0] * (1 + q.m * q.S2 + inplane)

    engine = disturbances.run()
    t = engine.tangent
    saltation.rates(engine.model, engine.state, t.before)
    expected = disturbances.expected(numerator)
    for at_once in (False, True):
        rate = saltation.event_times(
            engine.model, engine.state, t, transitions.CONTACT_LOST, at_once
        )
        wanted = expected
        if at_once and pressed:
            wanted = 0 * expected
        np.testing.assert_allclose(-rate * t.tau.reshape(2, 8)[:, :2].ravel(), wanted, rtol=1e-8)


# ------------------------------------------------------------------------------------ rates
@pytest.mark.parametrize("law", CONTACTS)
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_rates_are_those_of_the_reference(law: str, phase: str, direction: int) -> None:
    """Five pairs of modes fill one block of lanes and begin another."""
    p = P.replace(n_diameters=5, **CONTACTS[law])
    start = lively(phase, direction, p)
    case = engine_case(p)
    q = taylor.problem_of(p)
    if phase != "separation":
        start = start.replace(u=start.u - 500 * float(q.C))
    run = Full(p, start, scalars=4 if phase == "separation" or not q.rigid else 2)
    step = taylor.Step(q, phase, direction, stored.reference_state(start, p))
    sign = np.sign(plate_modes(p)["psi"].to_numpy())
    modal = np.concatenate([sign * x[1] for x in (step.a, step.b, step.alpha, step.beta)])
    expected = np.zeros(run.n_rows)
    expected[case.places] = modal[case.present]
    expected[-4:] = step.psi[1], step.g[1], step.u[1], step.v[1]
    # sums of terms that cancel: rounding of velocities' rates
    np.testing.assert_allclose(run.rates, expected[run.rows], rtol=1e-9, atol=1e-9)
