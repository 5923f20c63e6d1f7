"""docs/model.md: its equations, written out in tests/references/equations.py, and its table of symbols."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import numpy as np
import pytest

from disc_model import Parameters, plate_modes, slider_at_rest_frequencies
from disc_model.data.variables import SCALARS, SERIES, attributes
from disc_model.simulation.result import engine_case
from tests.references import equations
from tests.references.printed import MOTIONS, THETA, P, Printed, lively

PAGE = (Path(__file__).parents[2] / "docs" / "model.md").read_text(encoding="utf-8")
ROUNDING = 1e-12
"""Of two ways to write the same sums of some hundred terms, relative to the largest."""
STEP = 1e-4
ENERGY_ROUNDING = 1e-12
"""Of energies of some 10 J, with room."""
POWERS = str.maketrans("⁻¹²³", "-123")
IN_WORDS = {"Contact and events"}
"""Whose condition says what the phases do."""
FUNCTIONS = [f for _, f in inspect.getmembers(equations, inspect.isfunction) if f.__module__ == equations.__name__]


def close(got, expected):
    size = np.max(np.abs(expected))
    np.testing.assert_allclose(got, expected, rtol=0, atol=ROUNDING * size if size else 1e-300)


def section(title):
    """The text under a heading of the second level."""
    return PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]


# ------------------------------------------------------------------------------------------------ the equations
def test_every_equation_is_written_out():
    """A section that gains equations gains a function, and a function names the section that it stands for."""
    cited = {title for f in FUNCTIONS for title in f.__doc__.split(":")[0].split("; ")}
    with_equations = {title for title in re.findall(r"^## (.*)$", PAGE, re.M) if "$$" in section(title)}
    assert with_equations - IN_WORDS == cited


def motion(phase, direction):
    """A motion: its state, the disc, u at the static start, the contact force, and the rates that the page states."""
    s, d = lively(phase, direction), equations.modal_damping(P)
    _, u_0 = equations.start(P, d)
    force, rates = getattr(equations, phase)(P, d, s, u_0)
    return s, d, u_0, force, rates | equations.modal_rates(d, s, force)


def moving(phase, direction):
    """As `motion`, with the rates of all of the state: in contact u is that of the disc."""
    s, d, u_0, force, rates = motion(phase, direction)
    if phase != "separation":
        _, _, A, B = equations.vertical_motion(d, s)
        rates |= {"u": s.u_velocity, "u_velocity": A + rates["f"] * B - d.S * force}
    return s, d, u_0, force, rates


def rate_along(rates, s, of):
    """How fast a function of the state that is quadratic at most changes: exact, but for rounding."""
    there = [s.replace(**{n: getattr(s, n) + h * r for n, r in rates.items()}) for h in (STEP, -STEP)]
    ahead, behind = (np.array(of(state, h)) for state, h in zip(there, (STEP, -STEP), strict=True))
    return (ahead - behind) / (2 * STEP)


@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_rates_and_forces_are_the_papers(phase, direction):
    s, d, _, force, rates = motion(phase, direction)
    printed = Printed(P, s)
    close(force, printed.force())
    for name, rate in rates.items():
        close(rate, printed.rates()[name])
    close(equations.vertical_motion(d, s)[0], printed.described(0.0, printed.y)["w"])
    # the slider's angle is the drive point's, 0, less psi
    close(equations.displacement(d, s, THETA + s.psi), printed.described(0.0, printed.y)["w_point"])


@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_powers_are_the_rates_of_the_energies(phase, direction):
    s, d, u_0, force, rates = moving(phase, direction)
    gained = rate_along(rates, s, lambda there, _: equations.energies(P, d, there, u_0))
    np.testing.assert_allclose(gained, equations.powers(P, d, s, force), rtol=1e-9, atol=ENERGY_ROUNDING / STEP)


@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_powers_on_ramps_are_the_rates_of_the_energies(phase, direction):
    """Products of two linear functions as well."""
    s, d, u_0, force, rates = moving(phase, direction)
    ramp = (-40.0, 3e3)
    gained = rate_along(rates, s, lambda there, h: equations.energies(equations.ramp(P, ramp, h), d, there, u_0))
    expected = np.add(equations.powers(P, d, s, force), (equations.power_of_ramp(s, u_0, ramp), 0.0))
    np.testing.assert_allclose(gained, expected, rtol=1e-9, atol=ENERGY_ROUNDING / STEP)
    assert abs(equations.power_of_ramp(s, u_0, ramp)) > 1e-3


def test_impact_is_the_papers():
    s, d = lively("separation"), equations.modal_damping(P)
    _, u_0 = equations.start(P, d)
    # heights equal, as they are at an impact
    s = s.replace(u=equations.vertical_motion(d, s)[0])
    impulse, alpha, velocity = equations.impact(P, d, s)
    printed = Printed(P, s)
    after = printed.described(0.0, printed.literal.impact(printed.y))
    close(alpha, after["alpha"])
    after_impact = s.replace(alpha=alpha, u_velocity=velocity)
    close(velocity, equations.vertical_motion(d, after_impact)[1])
    close(velocity, printed.literal.impact(printed.y)[-1])
    gained = equations.energies(P, d, after_impact, u_0)[0] - equations.energies(P, d, s, u_0)[0]
    np.testing.assert_allclose(gained, equations.energy_of_impact(P, d, s, impulse), rtol=1e-9)


def test_force_jumps_at_a_release_as_stated():
    d = equations.modal_damping(P)
    s, u_0 = lively("stick"), equations.start(P, d)[1]
    before, _ = equations.stick(P, d, s, u_0)
    # the spring that just reaches the stick limit
    s = s.replace(psi=(P.mu_s * before / P.r_0 - P.c_p * P.Omega) / P.k_p)
    after, _ = equations.slip(P, d, s.replace(phase="slip", direction=1), u_0)
    assert abs(after / before - 1) > 1e-5
    close(equations.force_after_release(P, d, s, before), after)


def test_painleve_denominator_is_what_the_force_is_divided_by():
    """Twice the slope that makes it zero, the other way round, doubles it."""
    d, s = equations.modal_damping(P), lively("slip", 1)
    B = equations.vertical_motion(d, s)[3]
    factor = -(1 + P.m * d.S) * P.r_0 / (P.mu_k * B)
    close(equations.painleve_denominator(P, d, s.replace(b=-factor * s.b)), 2 * (1 + P.m * d.S))


def test_start_is_the_engines():
    p = Parameters(N=385, Omega=15.1)
    s, u_0 = equations.start(p, equations.modal_damping(p))
    close(engine_case(p).model.u_0, u_0)
    close(equations.stick(p, equations.modal_damping(p), s, u_0)[0], p.N)


@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
def test_modes_are_those_of_the_equations(normalization):
    p = P.replace(normalization=normalization, n_diameters=4)
    for mode in plate_modes(p).itertuples():
        conditions = equations.edge_conditions(p, mode.diameters, mode.omega)
        conditions = conditions / np.max(np.abs(conditions), axis=0)
        conditions /= np.max(np.abs(conditions), axis=1)[:, None]
        values = np.linalg.svd(conditions)[1]
        # frequencies are right to rounding, which the condition of four Bessel functions multiplies
        assert values[-1] < 1e-10 * values[0]
        np.testing.assert_allclose(equations.amplitude(p, mode.diameters, mode.omega), abs(mode.psi), rtol=1e-9)


def test_attached_frequencies():
    frequencies = equations.attached(P, equations.modal_damping(P))
    free = plate_modes(P).query("diameters > 0")["omega"]
    np.testing.assert_allclose(np.sort([*frequencies, *free]), slider_at_rest_frequencies(P), rtol=1e-10)


@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
def test_attached_frequencies_on_the_page(normalization):
    row = re.search(rf"^\| `{normalization}` \|(.*)\|$", section("Two normalisations"), re.M)[1]
    p = Parameters(N=200, Omega=20, normalization=normalization)
    digits = max(len(number.strip().split(".")[1]) for number in row.split(","))
    np.testing.assert_allclose(
        equations.attached(p, equations.modal_damping(p)),
        [float(number) for number in row.split(",")],
        rtol=0,
        atol=0.51 * 10**-digits,
    )


# ------------------------------------------------------------------------------------------------ beyond the paper
CONTACT = [motion for motion in MOTIONS if motion[0] != "separation"]


@pytest.mark.parametrize("compliance", [0.0, 2e-6])
@pytest.mark.parametrize("normal", [False, True])
@pytest.mark.parametrize(("phase", "direction"), CONTACT)
def test_powers_of_other_contacts_are_the_rates_of_the_energies(phase, direction, normal, compliance):
    s, d = lively(phase, direction), equations.modal_damping(P)
    u_0 = equations.start(P, d)[1]
    w, velocity, A, B = equations.vertical_motion(d, s)
    if compliance:
        s = s.replace(u=w - 600.0 * compliance, u_velocity=velocity + 0.01)
        force, rates = equations.compliant(P, d, s, u_0, compliance)
        R, T, V = force, np.nan, force
        if normal and phase == "slip":
            R, T, V = equations.normal_compliant_slip(P, d, s, u_0, compliance)
        elif normal:
            R = (V + equations.in_plane_force(P, s) * B) / (1 + B**2 / P.r_0**2)
            T = P.r_0 * equations.in_plane_force(P, s) - R * B / P.r_0
        f_rate = rates_of_f(phase, d, s, u_0, V, (R, T) if normal else None)
    else:
        if normal:
            R, T, V = getattr(equations, f"normal_{phase}")(P, d, s, u_0)
        else:
            V = R = getattr(equations, phase)(P, d, s, u_0)[0]
            T = np.nan
        f_rate = rates_of_f(phase, d, s, u_0, V, (R, T) if normal else None)
        # the slider follows the disc: this is what the rigid contact's formulas come from
        rates = {"u": velocity, "u_velocity": A + f_rate * B - d.S * V}
        close(P.m * rates["u_velocity"], V - P.N - P.k * (s.u - u_0) - P.c * velocity)
    rates |= equations.modal_rates(d, s, V) | {"f": f_rate, "psi": P.Omega - s.f}

    def energies(there, _):
        give = equations.vertical_motion(d, there)[0] - there.u
        transverse, in_plane = equations.energies(P, d, there, u_0)
        return transverse + (0.5 * give**2 / compliance if compliance else 0.0), in_plane

    expected = equations.normal_powers(P, d, s, R, T, V) if normal else equations.powers(P, d, s, V)
    np.testing.assert_allclose(rate_along(rates, s, energies), expected, rtol=1e-9, atol=ENERGY_ROUNDING / STEP)
    if normal:
        slope = B / P.r_0
        rubbed = P.mu_k * P.r_0 * R * abs(s.f) * (1 + slope**2) if phase == "slip" else 0.0
        np.testing.assert_allclose(P.r_0 * s.f * (T + R * slope) - V * s.f * B, rubbed, rtol=1e-9)


def rates_of_f(phase, d, s, u_0, force, normal):
    if phase == "stick":
        return 0.0
    if normal:
        return equations.normal_turning(P, d, s, *normal)
    return (equations.in_plane_force(P, s) - s.direction * P.mu_k * force / P.r_0) / P.m


def test_stick_on_a_normal_force_is_in_balance():
    s, d = lively("stick"), equations.modal_damping(P)
    R, T, V = equations.normal_stick(P, d, s, equations.start(P, d)[1])
    B = equations.vertical_motion(d, s)[3]
    close(R - T * B / P.r_0, V)
    # a difference of forces of some hundred newtons, over m r_0
    assert abs(equations.normal_turning(P, d, s, R, T)) < ROUNDING * abs(R) / (P.m * P.r_0)


def test_impact_of_a_normal_force():
    """Slider and disc end with one velocity, and as much energy is lost as the page says."""
    s, d = lively("separation"), equations.modal_damping(P)
    s = s.replace(u=equations.vertical_motion(d, s)[0])
    impulse, alpha, velocity, f = equations.normal_impact(P, d, s)
    after = s.replace(alpha=alpha, u_velocity=velocity, f=f)
    close(equations.vertical_motion(d, after)[1], velocity)
    lost = sum(equations.energies(P, d, s, 0.0)) - sum(equations.energies(P, d, after, 0.0))
    np.testing.assert_allclose(lost, equations.lost_at_a_normal_impact(P, d, s, impulse), rtol=1e-9)


# ------------------------------------------------------------------------------------------------ the symbols
def symbols():
    """Names in the table of symbols and their units."""
    rows = [line.strip("|").split("|") for line in section("Symbols").splitlines() if line.startswith("|")]
    assert all(len(row) == 5 for row in rows)
    return {name: row[3].strip().translate(POWERS) for row in rows[2:] for name in re.findall(r"`(\w+)`(?! ¹)", row[1])}


def test_every_variable_is_in_the_table_of_symbols():
    known = {*SERIES, *SCALARS, *Parameters.model_fields}
    table = symbols()
    assert known - set(table) == set(), "add a row to docs/model.md, Symbols"
    assert set(table) - known == set(), "no such variable: docs/model.md, Symbols"
    assert {name: attributes(name)["units"] for name in known} == table
