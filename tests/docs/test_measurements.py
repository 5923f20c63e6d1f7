"""The page on measurements says what the comparisons give."""

import re

import numpy as np
import pytest
from docs.measurements import load, report, signals, stick_slip, wheel

import disc_model as dm

PAGE = report.PAGE.read_text(encoding="utf-8")
NUMBER = re.compile(r"\d+(?:\.\d+)?")
QUICK = [name for name in report.SECTIONS if name != "spread"]


def check_table(name: str) -> None:
    """The same words, and numbers to two units of their last digits: three are shown."""
    found = report.marked(name).search(PAGE)
    assert found is not None
    shown, computed = found[0], report.SECTIONS[name]()
    assert NUMBER.sub("", shown) == NUMBER.sub("", computed)
    numbers = [np.array(NUMBER.findall(text), dtype=float) for text in (shown, computed)]
    assert numbers[0] == pytest.approx(numbers[1], rel=0.02)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.parametrize("name", QUICK)
def test_tables_of_the_page_are_computed(name: str) -> None:
    check_table(name)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_the_spread_of_slips_is_computed() -> None:
    check_table("spread")


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_sentences_on_slips_are_computed() -> None:
    mu_s, mu_k = stick_slip.friction()
    assert f"{mu_s:.3f} and {mu_k:.3f}, are medians" in PAGE
    ratios = [each.ratio for each in stick_slip.medians()["period"]]
    assert f"{100 * (min(ratios) - 1):.0f} % to {max(ratios):.1f} times too long" in PAGE
    shorter = []
    for stiffness in stick_slip.STIFFNESSES:
        swing = 2 * np.pi * np.sqrt(stick_slip.MASS / stiffness)
        seen = stick_slip.period(stick_slip.measured((stiffness, stick_slip.FASTEST)))
        shorter.append(round(100 * (1 - seen / swing)))
    sentence = f"periods are {min(shorter)} to {max(shorter)} % shorter than a free swing"
    assert sentence in " ".join(PAGE.split())
    # one run in which the source finds no stick, and the model stick
    assert [each.what for each in stick_slip.sticks() if not each.agrees] == ["2254 N/m, 42 µm/s"]


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_the_mass_that_explains_the_fastest_runs_is_computed() -> None:
    fit = stick_slip.moving_mass()
    assert not fit.consistent
    mass = fit.parameters["m"].value
    text = " ".join(PAGE.split())
    assert f"gives {1e3 * mass:.1f} g, {mass / stick_slip.MASS:.2f} of the stated one" in text
    medians = stick_slip.medians(mass)
    calibration = stick_slip.name(stick_slip.CALIBRATION)
    durations = [each.ratio for each in medians["duration"] if each.what != calibration]
    assert f"are {min(durations):.2f} to {max(durations):.2f} times the measured ones" in text
    soft, stiff = [], []
    for each in medians["period"]:
        if each.what.startswith("168 N/m") and "42 µm" not in each.what:
            soft.append(100 * (each.ratio - 1))
        elif not each.what.startswith("168 N/m"):
            stiff.append(each.ratio)
    assert f"{min(stiff):.2f} to {max(stiff):.2f} times." in text
    assert f"still {min(soft):.0f} and {max(soft):.0f} % too long" in text


def test_sentences_on_discs_and_loads_are_computed() -> None:
    frequencies = wheel.frequencies()
    assert [each.agrees for each in frequencies] == [True] * 4 + [False]
    low = [round(100 * (1 - each.ratio)) for each in frequencies]
    assert f"The plate is {min(low)} to {max(low)} % low" in PAGE
    laws = wheel.damping()
    assert not any(each.agrees for each in laws)
    assert f"up to {max(each.ratio for each in laws):.0f} times too high" in PAGE
    constant = [each.ratio for each in laws if each.what.endswith("damping_ratio")]
    assert f"up to {max(constant):.1f} times too high" in " ".join(PAGE.split())
    ratios = [each.ratio for each in load.loads()]
    factor = max(max(ratio, 1 / ratio) for ratio in ratios)
    assert f"factor of {factor:.1f}" in PAGE


# ---- The methods of the comparisons


def test_slips_of_a_known_force_are_found() -> None:
    """A saw tooth that rises in 0.4 s and falls by 0.1 in a half wave of 20 ms."""
    rise, fall, periods = 800, 40, 5
    up = np.linspace(0.2, 0.3, rise, endpoint=False)
    down = 0.25 + 0.05 * np.cos(np.linspace(0, np.pi, fall, endpoint=False))
    force = np.tile(np.concatenate([up, down]), periods)
    force += 1e-3 * np.random.default_rng(0).normal(size=force.size)
    found = signals.slips(force)
    assert len(found) in (periods - 1, periods)  # the last one is not ended by a rise
    for slip in found:
        # noise of 0.001, of which the extremes of some samples are taken
        assert slip.before == pytest.approx(0.3, abs=4e-3)
        assert slip.after == pytest.approx(0.2, abs=4e-3)
        # from 5 to 95 % of a half wave: 1 - 2 acos(0.9) / pi of it; samples are 0.5 ms apart
        assert slip.duration == pytest.approx(0.02 * (1 - 2 * np.arccos(0.9) / np.pi), abs=2e-3)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_friction_is_found_from_slips_of_a_simulated_block() -> None:
    """At a low speed; the block then swings about the kinetic force."""
    run = (1002, 42)
    table = stick_slip.predicted(run, 0.35, 0.30)
    static, kinetic = stick_slip.coefficients(table)
    # samples are 0.5 ms apart, in a slip of 17 ms
    assert np.median(static) == pytest.approx(0.35, abs=1e-3)
    assert np.median(kinetic) == pytest.approx(0.30, abs=2e-3)
    swing = np.pi * np.sqrt(stick_slip.MASS / run[0])
    part = 1 - 2 * np.arccos(0.9) / np.pi
    assert stick_slip.duration(table) == pytest.approx(part * swing, abs=1e-3)


def test_shapes_on_the_rim_are_harmonics() -> None:
    angles = np.radians(np.arange(0, 180, 15))
    assert wheel.shape(3, angles) == pytest.approx(np.cos(3 * angles), abs=1e-12)


def test_a_small_clamp_leaves_a_free_plate() -> None:
    """Frequencies of a free circular plate with nu = 0.3: lambda^2 of 5.358, 12.44, 21.84
    (text books, four digits)."""
    p = wheel.plate("wheel", 667.35, 4)
    modes = dm.plate_modes(p).set_index("diameters")["omega"]
    scale = p.b**2 * np.sqrt(p.rho * p.h / p.D)
    values = [modes[l] * scale for l in (2, 3, 4)]
    assert values == pytest.approx([5.358, 12.44, 21.84], rel=1e-3)
