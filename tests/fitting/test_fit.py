"""Parameters found from synthetic measurements, and what wrong input is told."""

import dataclasses
import math
import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot
from scipy.stats import binom

import disc_model as dm
from disc_model.disc.plausibility import ImplausibleValue, warn_of_measured
from disc_model.fitting.block_cycle import Unpredicted
from disc_model.fitting.prediction import Prediction
from disc_model.fitting.problem import Problem
from tests.refusals import refusal

DISC = dm.Parameters(N=385, Omega=15, n_diameters=2)
BLOCK = dm.Parameters(N=30, Omega=0.5, n_diameters=-1, m=0.2, k=0, k_p=2e3, mu_s=0.5, mu_k=0.3)


def synthetic(
    truth: dm.Parameters,
    names: Sequence[str],
    settings: Sequence[dict[str, float]],
    error: float,
    rng: np.random.Generator,
) -> list[dm.Measurement]:
    """Return measurements of a case in several settings, with normal errors of a relative size."""
    found = []
    for at in settings:
        prediction = Prediction(truth.replace(**at))
        for name in names:
            value = prediction.of(name)
            size = error * abs(value)
            found.append(dm.Measurement(name, value + size * rng.normal(), size, at=at))
    return found


def disc_friction(rng: np.random.Generator) -> tuple[dm.Parameters, dm.Parameters, list]:
    """Friction and stiffness from cycles of the paper's disc at three speeds."""
    truth = DISC.replace(mu_s=0.42, k_p=1.9e4)
    settings = [{"Omega": speed} for speed in (12.0, 13.0, 14.0)]
    names = ("period", "slip_time")
    return truth, DISC, synthetic(truth, names, settings, 1e-3, rng)


def plate(rng: np.random.Generator) -> tuple[dm.Parameters, dm.Parameters, list]:
    """Stiffness and Poisson's ratio of a plate from its natural frequencies."""
    truth = DISC.replace(E=160e9, nu=0.25)
    names = ("frequency_0_0", "frequency_1_0", "frequency_2_0", "coupled_frequency_1")
    return truth, DISC, synthetic(truth, names, [{}], 1e-3, rng)


def block(rng: np.random.Generator) -> tuple[dm.Parameters, dm.Parameters, list]:
    """Friction of a block from slips at several stiffnesses and speeds."""
    truth = BLOCK.replace(mu_s=0.45, mu_k=0.25)
    settings = [{"Omega": 0.5}, {"Omega": 1.0}, {"k_p": 4e3}]
    names = ("slip_length", "slip_time")
    start = BLOCK.replace(mu_s=0.5, mu_k=0.3, m=0.25)
    return truth, start, synthetic(truth, names, settings, 1e-2, rng)


VARIED: dict[Callable[..., Any], list[str]] = {
    disc_friction: ["mu_s", "k_p"],
    plate: ["E", "nu"],
    block: ["mu_s", "m"],
}


def holds(fit: dm.Fit, truth: dm.Parameters) -> list[bool]:
    """Return for each parameter whether its interval holds the true value."""
    return [each.low <= truth.numbers[name] <= each.high for name, each in fit.parameters.items()]


def one_draw(draw: Callable[..., Any], seed: int) -> tuple[dm.Fit, dm.Parameters]:
    truth, start, measurements = draw(np.random.default_rng(seed))
    if draw is block:  # the kinetic coefficient is known
        start = start.replace(mu_k=truth.mu_k)
    return dm.fit(start, VARIED[draw], measurements), truth


def check_coverage(draw: Callable[..., Any], draws: int) -> None:
    """The number of intervals of 95 % that hold the truth is binomial: it falls below the bound
    used here once in ten thousand tests."""
    counts = np.zeros(2, int)
    for seed in range(draws):
        fit, truth = one_draw(draw, seed)
        assert fit.converged
        counts += holds(fit, truth)
    assert counts.min() >= binom.ppf(1e-4, draws, 0.95)
    if draws >= 100:
        # and intervals are not wider than they need be
        assert counts.max() < draws


@pytest.mark.parametrize("draw", [disc_friction, plate, block], ids=lambda draw: draw.__name__)
def test_known_parameters_lie_within_the_intervals_of_a_few_draws(draw: Callable[..., Any]) -> None:
    check_coverage(draw, 4)


@pytest.mark.slow
@pytest.mark.parametrize("draw", [disc_friction, plate, block], ids=lambda draw: draw.__name__)
def test_known_parameters_lie_within_their_intervals_in_95_of_100_draws(
    draw: Callable[..., Any],
) -> None:
    check_coverage(draw, 100)


def test_exact_measurements_give_back_the_parameters() -> None:
    truth = DISC.replace(mu_s=0.42, k_p=1.9e4)
    measurements = []
    for at in ({}, {"Omega": 12.0}):
        prediction = Prediction(truth.replace(**at))
        for name in ("period", "slip_time"):
            measurements.append(dm.Measurement(name, prediction.of(name), 1e-6, at=at))
    fit = dm.fit(DISC, ["mu_s", "k_p"], measurements)
    # the search ends at relative changes of 1e-10, cycles are accurate to 1e-12
    assert fit.parameters["mu_s"].value == pytest.approx(0.42, rel=1e-8)
    assert fit.parameters["k_p"].value == pytest.approx(1.9e4, rel=1e-8)
    assert fit.case.mu_s == fit.parameters["mu_s"].value
    assert fit.chi_squared < 1e-6


def test_derivatives_are_those_of_the_closed_form() -> None:
    """Frequencies are proportional to sqrt(E / rho), and a block's stick lasts 2 d N / (k V)."""
    measurements = [dm.Measurement("frequency_2_0", 1.0, 1.0)]
    problem = Problem(DISC, ["E", "rho"], measurements, {})
    start = np.array([DISC.E, DISC.rho])
    value = problem.predictions(start)[0]
    expected = [value / (2 * DISC.E), -value / (2 * DISC.rho)]
    # a central difference errs by the third derivative, 3 / 8 times the squared step here
    slopes = problem.jacobian(start)
    assert slopes[0] == pytest.approx(expected, rel=1e-8)

    problem = Problem(BLOCK, ["mu_s"], [dm.Measurement("stick_time", 1.0, 1.0)], {})
    slope = 2 * BLOCK.N / (BLOCK.k_p * BLOCK.r_0 * BLOCK.Omega)
    # times of events err by 1e-10 s, over a step of 5e-5
    start = np.array([BLOCK.mu_s])
    slopes = problem.jacobian(start)
    assert slopes[0] == pytest.approx([slope], rel=1e-4)


def test_the_covariance_of_a_linear_problem_is_that_of_weighted_least_squares() -> None:
    """Two functions of one's own that are linear in E and rho."""

    def first(p: dm.Parameters) -> float:
        return p.E / 1e9 + p.rho / 1e3

    def second(p: dm.Parameters) -> float:
        return p.E / 1e9 - p.rho / 1e3

    measurements = [dm.Measurement(first, 157.2, 0.3), dm.Measurement(second, 142.8, 0.4)]
    fit = dm.fit(DISC, ["E", "rho"], measurements)
    # E / 1e9 = (first + second) / 2, rho / 1e3 = (first - second) / 2
    variance = (0.3**2 + 0.4**2) / 4
    mixed = (0.3**2 - 0.4**2) / 4
    of_E = 1e18 * variance
    of_both = 1e12 * mixed
    of_k = 1e6 * variance
    expected = np.array([[of_E, of_both], [of_both, of_k]])
    assert fit.covariance == pytest.approx(expected, rel=1e-6)
    assert fit.parameters["E"].value == pytest.approx(150e9, rel=1e-9)
    width = fit.parameters["E"].high - fit.parameters["E"].low
    deviation = 1e9 * math.sqrt(variance)
    half_width = 1.959964 * deviation
    assert width == pytest.approx(2 * half_width, rel=1e-6)
    correlation = mixed / variance
    assert fit.correlation[0, 1] == pytest.approx(correlation, rel=1e-6)


def test_a_prediction_has_the_uncertainty_of_the_parameters() -> None:
    """The frequency with two nodal diameters sets E, and others have its relative uncertainty."""
    fit = dm.fit(DISC, ["E"], {"frequency_2_0": (290.0, 2.9)})
    value, deviation = fit.predict("frequency_0_0")
    assert deviation / value == pytest.approx(0.01, rel=1e-6)
    slower, _ = fit.predict("frequency_0_0", at={"rho": 4 * DISC.rho})
    assert slower == pytest.approx(value / 2, rel=1e-12)


def test_intervals_of_less_confidence_are_narrower() -> None:
    measured = {"frequency_2_0": (290.0, 2.9)}
    wide = dm.fit(DISC, ["E"], measured).parameters["E"]
    narrow = dm.fit(DISC, ["E"], measured, confidence=0.6827).parameters["E"]
    above = narrow.high - narrow.value
    assert above == pytest.approx(narrow.deviation, rel=1e-3)
    above = wide.high - wide.value
    expected = 1.96 * wide.deviation
    assert above == pytest.approx(expected, rel=1e-3)


def test_measurements_that_contradict_the_model_are_inconsistent() -> None:
    measured = {"frequency_0_0": (239.0, 0.5), "frequency_2_0": (310.0, 0.5)}
    fit = dm.fit(DISC, ["E"], measured)
    assert fit.freedom == 1
    assert not fit.consistent
    said = dict(fit.summary())
    doubt = f"model, fixed parameters or uncertainties may be wrong, chi squared is {fit.chi_squared:.3g} times its"
    share = "less than 0.0001 % of fits of the right model are this bad"
    assert fit.doubt == f"{doubt} degrees of freedom: {share}, and frequency_0_0 deviates most"
    assert said["consistent"] == f"no: {fit.doubt}"
    assert said["intervals"] == f"none: {fit.doubt}"
    assert " to " not in said["E"]
    assert "±" not in repr(fit)
    # a chi squared that one of 25 fits of the right model exceeds is no proof
    unlucky = dataclasses.replace(fit, chi_squared=4.2)
    assert not unlucky.consistent
    assert unlucky.doubt == (
        "model, fixed parameters or uncertainties may be wrong, chi squared is 4.2 times its degrees of freedom: "
        "4 % of fits of the right model are this bad, and frequency_0_0 deviates most"
    )


def test_a_search_that_has_not_converged_has_no_intervals() -> None:
    """It said "consistent yes", and gave an interval of 95 %."""
    good = dm.fit(DISC, ["E"], {"frequency_0_0": (239.0, 0.5)})
    assert "±" in repr(good)
    failed = replace(good, converged=False)
    assert not failed.consistent
    said = dict(failed.summary())
    for name in ("consistent", "intervals"):
        assert said[name].endswith(": the search has not converged")
    assert "(" not in said["E"]
    assert "95 %" not in " ".join(map(str, said.values()))
    assert repr(failed).endswith("; the search has not converged)")


def test_a_failed_search_without_degrees_of_freedom_is_inconsistent() -> None:
    """As many parameters as measurements fit exactly, unless a bound keeps them away."""
    measured = {"frequency_0_0": (250.0, 0.5)}
    free = dm.fit(DISC, ["E"], measured)
    assert free.freedom == 0
    assert free.consistent
    near = {"E": (0.999 * DISC.E, 1.001 * DISC.E)}
    held = dm.fit(DISC, ["E"], measured, bounds=near)
    assert held.chi_squared > 100
    assert not held.consistent
    assert held.doubt.endswith(f"chi squared is {held.chi_squared:.3g} and should be 0")


def test_bounds_hold_the_parameters() -> None:
    measured = {"frequency_2_0": (300.0, 1.0)}
    fit = dm.fit(DISC, ["E"], measured, bounds={"E": ("120 GPa", "152 GPa")})
    assert fit.parameters["E"].value == pytest.approx(152e9, rel=1e-6)


def test_a_parameter_that_starts_at_zero_is_found_within_bounds() -> None:
    truth = DISC.replace(c=3.0)
    measured = {"growth_rate": (Prediction(truth).of("growth_rate"), 1e-3)}
    start = DISC.replace(c=0.0)
    bounds = {"c": (0, 20)}
    fit = dm.fit(start, ["c"], measured, bounds=bounds)
    assert fit.parameters["c"].value == pytest.approx(3.0, rel=1e-6)


def test_a_ratio_can_be_fitted_and_stays_in_the_case() -> None:
    truth = DISC.replace(mu_k_over_mu_s=0.5)
    measured = {"slip_time": (Prediction(truth).of("slip_time"), 1e-5)}
    start = DISC.replace(mu_k_over_mu_s=0.6)
    fit = dm.fit(start, ["mu_k_over_mu_s"], measured)
    assert fit.parameters["mu_k_over_mu_s"].value == pytest.approx(0.5, rel=1e-6)
    mu_s = fit.case.mu_s
    assert fit.case.mu_k == pytest.approx(0.5 * mu_s, rel=1e-12)


def test_a_number_of_a_table_of_modes_can_be_fitted() -> None:
    omega = [1500.0, 1800.0]
    amplitude = [1.5, 2.0]
    disc = dm.Disc(diameters=[0, 2], omega=omega, amplitude=amplitude)
    p = dm.Parameters(N=385, Omega=15, disc=disc, r_0=0.1)
    truth = p.replace(amplitude_2_0=2.5)
    measured = {"coupled_frequency_1": (Prediction(truth).of("coupled_frequency_1"), 0.1)}
    fit = dm.fit(p, ["amplitude_2_0"], measured)
    amplitude = fit.parameters["amplitude_2_0"]
    assert abs(amplitude.value) == pytest.approx(2.5, rel=1e-6)


def test_texts_with_units_are_read() -> None:
    measurement = dm.Measurement("frequency_2_0", "0.29 kHz", "3 Hz", at={"h": "2 mm"})
    assert measurement.value == 290.0
    assert measurement.uncertainty == 3.0
    assert measurement.name == "frequency_2_0 (h=2 mm)"


# ---- Tables


def table_of(**columns: list[Any]) -> pd.DataFrame:
    """A table of two measured frequencies, with further columns, or others in their place."""
    usual = {
        "quantity": ["frequency_2_0", "frequency_0_0"],
        "value": ["0.29 kHz", 237.0],
        "uncertainty": [1.0, "1 Hz"],
    }
    return pd.DataFrame({**usual, **columns})


def test_a_table_is_a_list_of_measurements() -> None:
    """It was refused."""
    table = table_of(h=["2.1 mm", None], Omega=[np.nan, 12])
    measured = [
        dm.Measurement("frequency_2_0", 290.0, 1.0, at={"h": "2.1 mm"}),
        dm.Measurement("frequency_0_0", 237.0, 1.0, at={"Omega": 12.0}),
    ]
    assert dm.fit(DISC, ["E"], table) == dm.fit(DISC, ["E"], measured)


def test_a_table_may_be_indexed_by_a_column() -> None:
    table = table_of()
    indexed = dm.fit(DISC, ["E"], table.set_index("quantity"))
    assert indexed == dm.fit(DISC, ["E"], table)


def test_a_table_of_a_file_is_a_table_of_measurements(tmp_path: Path) -> None:
    table = table_of(h=[None, 0.0021])
    file = tmp_path / "measured.csv"
    table.to_csv(file, index=False)
    assert dm.fit(DISC, ["E"], pd.read_csv(file)) == dm.fit(DISC, ["E"], table)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (
            table_of(Omga=[12, 13]),
            "measured.Omga: is neither a column of measurements nor a number of the case, did you mean"
            " Omega? (known: quantity, value, uncertainty, N, Omega,",
        ),
        (table_of().drop(columns="value"), "measured: must have a column value"),
        (
            table_of().rename(columns={"value": "valu"}),
            "measured.valu: is neither a column of measurements nor a number of the case, did you mean"
            " value?",
        ),
        (table_of(E=[1e11, 2e11]), "measured.E: must be no column, because it is varied"),
        (pd.concat([table_of(), table_of()], axis=1), "measured.value: must not be given twice"),
        (table_of(value=[290.0, "3 kg"]), "measured.value[1]='3 kg': must be a number in Hz"),
        (table_of(uncertainty=[1, 0]), "measured.uncertainty[1]=0: must be a standard deviation"),
        (table_of(value=[np.nan, 1]), "measured.value[0]=nan: must be a finite number"),
        (
            table_of(quantity=["frequency_2_0", "perod"]),
            "measured.quantity[1]='perod': is no quantity of a case, did you mean period?",
        ),
        (table_of(h=[0.002, -1]), "measured.h[1]=-1: must be > 0"),
        (table_of(h=[0.002, "thick"]), "measured.h[1]='thick': must be a number"),
        (table_of().iloc[:0], "must be at least as many as the varied parameters"),
    ],
)
def test_wrong_tables_are_named(table: pd.DataFrame, message: str) -> None:
    with refusal(re.escape(message)):
        dm.fit(DISC, ["E"], table)


# ---- What a reader sees


def test_a_fit_shows_values_intervals_and_deviations() -> None:
    measured = {"frequency_0_0": (239.0, 0.5), "frequency_2_0": (292.0, 0.5)}
    fit = dm.fit(DISC, ["E"], measured)
    assert re.fullmatch(
        r"Fit\(E=1\.5\d*e\+11 ± [\d.e+]+; ± one standard deviation; chi squared .*freedom\)",
        repr(fit),
    )
    left, right = fit.plot()
    names = [f"frequency of mode ({number}, 0)" for number in (0, 2)]
    assert [text.get_text() for text in left.get_yticklabels()] == names
    shown = np.concatenate([line.get_xdata() for line in right.lines if len(line.get_xdata()) == 2])
    deviations = np.round(fit.deviations, 9)
    drawn = np.round(shown, 9)
    assert set(deviations) <= set(drawn)
    pyplot.close("all")


# ---- Files


def in_settings() -> dm.Fit:
    """A fit to measurements in several settings, of which some are texts or words."""
    table = [
        dm.Measurement("frequency_2_0", 290.0, 1.0, at={"h": "2 mm"}),
        dm.Measurement("frequency_0_0", 237.0, 1.0, at={"contact": "bilateral"}),
        dm.Measurement(damping, 0.5, 1.0),
    ]
    return dm.fit(DISC.replace(c_p=2), ["E", "c_p"], table)


@pytest.mark.parametrize("suffix", ["nc", "mat"])
def test_a_fit_is_saved_and_comes_back(tmp_path: Path, suffix: str) -> None:
    fit = in_settings()
    file = tmp_path / f"fit.{suffix}"
    dm.save(fit, file)
    assert dm.load(file).identical(fit.to_dataset())


def test_a_fit_is_a_dataset_of_its_parameters_and_measurements() -> None:
    fit = in_settings()
    data = fit.to_dataset()
    stiffness = data.sel(parameter="E", other_parameter="E")
    assert stiffness["value"].item() == fit.case.E
    assert stiffness["unit"].item() == "Pa"
    assert stiffness["high"].item() == fit.parameters["E"].high
    assert stiffness["covariance"].item() == fit.covariance[0, 0]
    assert np.isnan(stiffness["at_bound"].item())

    held = data.sel(parameter="c_p")
    assert held["at_bound"].item() == 0.0
    assert held["limit"].item() == fit.limits["c_p"]
    assert np.isnan(held["low"].item())
    assert held["low"].attrs["long_name"].endswith(", or it lies beyond a bound")

    assert data["quantity"].values.tolist() == ["frequency_2_0", "frequency_0_0", "damping"]
    assert data["measured_unit"].values.tolist() == ["Hz", "Hz", ""]
    assert data["measured"].values.tolist() == [290.0, 237.0, 0.5]
    assert data["predicted"].values.tolist() == fit.computed.tolist()
    assert data["h"].values.tolist() == [0.002, DISC.h, DISC.h]
    assert data["h"].attrs["units"] == "m"
    assert data["contact"].values.tolist() == ["unilateral", "bilateral", "unilateral"]
    assert data.attrs["doubt"] == fit.doubt
    assert dm.Parameters.model_validate_json(data.attrs["case"]) == fit.case


def test_a_branch_is_saved_without_a_detour(tmp_path: Path) -> None:
    branch = dm.continue_cycle(dm.Parameters(N=385, Omega=14.9), "Omega", (14.8, 15.0))
    dm.save(branch, tmp_path / "branch.nc")
    assert dm.load(tmp_path / "branch.nc").identical(branch.to_dataset())


def test_a_sweep_of_fits_has_their_parameters() -> None:
    def fitted(case: dm.Parameters) -> dm.Fit:
        return dm.fit(case, ["E"], {"frequency_2_0": (290.0, 1.0), "frequency_0_0": (245.0, 1.0)})

    swept = dm.sweep(fitted, DISC, nu=[0.2, 0.3])
    single = fitted(DISC.replace(nu=0.3))
    row = swept.sel(nu=0.3, parameter="E")
    assert row["value"].item() == single.case.E
    assert row["chi_squared"].item() == single.chi_squared


# ---- Wrong input

GOOD: dict[str, Any] = {"case": DISC, "vary": ["E"], "measured": {"frequency_2_0": (290.0, 1.0)}}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"case": 3}, "case=3: must be Parameters"),
        ({"vary": "E"}, "vary='E': must be a list of names"),
        ({"vary": []}, "must be a list of names"),
        ({"vary": ["Ee"]}, "vary.0='Ee': is no number of this case"),
        ({"vary": ["n_diameters"]}, "is no number of this case"),
        ({"vary": ["E", "E"]}, "vary.1='E': must not be given twice"),
        ({"measured": 3}, "measured=3: must be values"),
        ({"measured": {"perod": (1, 1)}}, "is no quantity of a case, did you mean period"),
        ({"measured": {"period": 0.01}}, "must be a value and its standard deviation"),
        ({"measured": {"period": (0.01, 0)}}, "uncertainty=0: must be a standard deviation > 0"),
        ({"measured": {"period": (math.nan, 1)}}, "value=nan: must be a finite number"),
        ({"measured": {"period": ("3 kg", 1)}}, "must be a number in s"),
        ({"vary": ["E", "nu"]}, "measured='1 values': must be at least as many"),
        ({"bounds": {"nu": (0, 1)}}, "bounds.nu=(0, 1): must be of a parameter that is varied"),
        ({"bounds": {"E": (2e11, 1e11)}}, "must be two ascending values around the start"),
        ({"bounds": {"E": (2e11, 3e11)}}, "must be two ascending values around the start"),
        ({"bounds": 3}, "bounds=3: must give two values by parameter"),
        ({"confidence": 1}, "confidence=1: must lie between 0 and 1"),
        ({"vary": ["c"]}, "vary.c=0: must have bounds"),
        ({"measured": {"frequency_9_0": (1, 1)}}, "has no mode of 9 nodal diameters"),
    ],
)
def test_wrong_input_is_named(changes: dict[str, Any], message: str) -> None:
    with refusal(re.escape(message)):
        dm.fit(**(GOOD | changes))


@pytest.mark.parametrize(
    ("at", "message"),
    [
        ({"E": 1e11}, "must not set what is varied"),
        ({"Omga": 3}, "measured.0.at.Omga=3: unknown parameter"),
        ({"rho": -1}, "measured.0.at.rho=-1: must be > 0"),
    ],
)
def test_wrong_settings_are_named(at: dict[str, Any], message: str) -> None:
    measured = [dm.Measurement("frequency_2_0", 290.0, 1.0, at=at)]
    with refusal(re.escape(message)):
        dm.fit(DISC, ["E"], measured)


def test_parameters_that_act_alike_are_told_apart_from_others() -> None:
    """Frequencies depend on E / rho alone."""
    measured = {"frequency_0_0": (239.0, 0.5), "frequency_2_0": (292.0, 0.5)}
    with refusal("cannot be determined") as error:
        dm.fit(DISC, ["E", "rho"], measured)
    assert "'E', 'rho'" in str(error.value)
    assert "only E / rho" in str(error.value)


def test_a_parameter_without_effect_is_named() -> None:
    measured = {"frequency_0_0": (239.0, 0.5), "frequency_2_0": (292.0, 0.5)}
    with refusal(r"\['mu_s'\]: cannot be determined"):
        dm.fit(DISC, ["E", "mu_s"], measured)


def test_a_case_that_breaks_a_rule_on_the_way_shortens_the_step() -> None:
    """Equal coefficients of friction have no cycle; the search must not stop there."""
    truth = BLOCK.replace(mu_k=0.4999)
    measured = {"slip_length": (Prediction(truth).of("slip_length"), 1e-6)}
    fit = dm.fit(BLOCK, ["mu_k"], measured)
    assert fit.parameters["mu_k"].value == pytest.approx(0.4999, rel=1e-6)


def times_at(speeds: Sequence[float], truth: dm.Parameters) -> list[dm.Measurement]:
    """Periods and times of stick of a case at some speeds, without errors."""
    measured = []
    for speed in speeds:
        cycle = dm.floquet(truth.replace(Omega=speed))
        at = {"Omega": speed}
        stick = cycle.period * cycle.stick_fraction
        measured.append(dm.Measurement("period", cycle.period, 1e-5, at=at))
        measured.append(dm.Measurement("stick_time", stick, 2e-5, at=at))
    return measured


@pytest.mark.parametrize(
    ("names", "powers", "formula"),
    [
        (["m", "k_p"], [1, 2], "m * k_p^2"),
        (["m", "k_p"], [2, -3], "m^2 / k_p^3"),
        (["m", "k_p"], [1, 1.234], "m^0.8104 * k_p"),
        (["m", "k_p", "k"], [1, 2, -1], "m * k_p^2 / k"),
        (["k", "k_p"], [1, -1], "k / k_p"),
    ],
)
def test_the_product_that_measurements_determine_is_found(
    names: list[str], powers: list[float], formula: str
) -> None:
    """Names of parameters that are not told apart did not say what is known of them."""

    def product(case: dm.Parameters) -> float:
        values = np.array([case.numbers[name] for name in names])
        return float(np.prod(values**powers))

    def alike(number: int) -> Callable[[dm.Parameters], float]:
        return lambda case: product(case) * (1 + 1e-4 * case.numbers[names[number]] ** 0.1)

    measured = []
    for quantity in (product, *map(alike, range(1, len(names)))):
        value = 1.01 * quantity(DISC)
        measured.append(dm.Measurement(quantity, value, 1e-3 * value))
    fit = dm.fit(DISC, names, measured)
    assert fit.indistinct == tuple(names)
    assert [*fit.determined] == [formula]
    assert fit.note.startswith(f"the measurements determine {formula} = ")


@pytest.mark.compiled
def test_parameters_that_are_hardly_told_apart_are_doubted() -> None:
    """Times depend on mu_s - mu_k. Peaks of resonances in the predictions made narrow intervals
    that missed the truth by 4.8 standard deviations, and nothing was said."""
    truth = dm.Parameters(N=280, Omega=9, mu_s=0.43, mu_k=0.25, k_p=2.2e4)
    measured = times_at((5, 6, 7, 8), truth)
    start = dm.Parameters(N=280, Omega=9)
    fit = dm.fit(start, ["mu_s", "mu_k", "k_p"], measured)
    assert fit.indistinct == ("mu_s", "mu_k")
    assert "do not determine mu_s and mu_k apart" in fit.doubt
    assert not fit.consistent
    [(formula, known)] = fit.determined.items()
    assert formula == "mu_s - mu_k"
    assert known.value == pytest.approx(0.18, abs=2 * known.deviation)
    assert "the measurements determine mu_s - mu_k = 0.18" in fit.note
    assert dict(fit.summary())["note"] == fit.note
    assert all(math.isnan(fit.parameters[name].deviation) for name in fit.indistinct)
    assert dict(fit.summary())["intervals"].endswith("; none of mu_s and mu_k")
    ends = [math.isfinite(end) for each in fit.parameters.values() for end in (each.low, each.high)]
    assert ends == [False, False, False, False, True, True]
    alone = dm.fit(start.replace(mu_k=0.25), ["mu_s", "k_p"], measured)
    assert alone.doubt == ""
    # the search ends where chi squared no longer falls by 1e-10
    assert alone.parameters["mu_s"].value == pytest.approx(0.43, rel=1e-4)


def noisy_times(seed: int) -> list[dm.Measurement]:
    """Periods and times of slip at five speeds with errors of 10 µs; coefficients of friction are
    0.43 and 0.22, k_p is 21 kN/m."""
    truth = dm.Parameters(N=250, Omega=9, mu_s=0.43, mu_k=0.22, k_p=2.1e4)
    rng = np.random.default_rng(seed)
    measured = []
    for speed in (6, 7, 8, 9, 10):
        cycle = dm.floquet(truth.replace(Omega=speed))
        slip = (1 - cycle.stick_fraction) * cycle.period
        for name, value in (("period", cycle.period), ("slip_time", slip)):
            value += rng.normal(0, 1e-5)
            measured.append(dm.Measurement(name, value, 1e-5, at={"Omega": speed}))
    return measured


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("seed", "start"),
    [
        pytest.param(11, 0.2, marks=pytest.mark.slow),
        pytest.param(11, 0.21, marks=pytest.mark.slow),
        pytest.param(11, 0.22, marks=pytest.mark.slow),
        pytest.param(3, 0.2, marks=pytest.mark.slow),
        pytest.param(3, 0.21, marks=pytest.mark.slow),
        pytest.param(3, 0.22, marks=pytest.mark.slow),
    ],
)
def test_indistinct_parameters_are_named_from_every_start(seed: int, start: float) -> None:
    """By the start there was an error, a doubt of mu_k and k_p, or none of any parameter: the search
    ends at mu_k = 0, where derivatives say nothing, or at coefficients above 3, which are known to
    15 %, more than that of which k_p is known by a factor of a thousand."""
    case = dm.Parameters(N=250, Omega=9, mu_k=start)
    fit = dm.fit(case, ["mu_s", "mu_k", "k_p"], noisy_times(seed))
    assert fit.indistinct == ("mu_s", "mu_k")
    assert "do not determine mu_s and mu_k apart" in fit.doubt
    assert not fit.consistent
    # the stiffness is determined nevertheless: three standard deviations of some 12 N/m
    assert fit.parameters["k_p"].value == pytest.approx(2.1e4, abs=40)


@pytest.mark.compiled
@pytest.mark.slow
def test_a_large_chi_squared_is_said_beside_indistinct_parameters() -> None:
    """One doubt hid the other."""
    measured = [replace(each, uncertainty=2e-7) for each in noisy_times(3)]
    case = dm.Parameters(N=250, Omega=9, mu_k=0.22)
    fit = dm.fit(case, ["mu_s", "mu_k", "k_p"], measured)
    # errors are fifty times as large as stated
    assert fit.chi_squared > 1000 * fit.freedom
    least = fit.chi_squared - fit.excess
    reduced = f"the least chi squared is {least / fit.freedom:.3g} times its degrees of freedom"
    for words in (
        "determine mu_s and mu_k apart",
        "model, fixed parameters or uncertainties may be wrong",
        reduced,
    ):
        assert words in fit.doubt
        assert words in repr(fit)


@pytest.mark.compiled
def test_a_search_goes_on_beside_gaps_without_a_cycle() -> None:
    """At 12 rad/s no cycle of up to three releases is found above 0.42971 and below 0.42968. Both steps
    of the differences were in such gaps, and the search ended in an error."""
    true = dm.Parameters(N=385, Omega=14, mu_s=0.43, mu_k=0.22, k_p=18000.0)
    scatter = 2e-5 * np.random.default_rng(41).normal(size=(5, 2))
    measured = []
    for speed, errors in zip((11.5, 12.0, 13.0, 14.0, 14.5), scatter, strict=True):
        cycle = dm.floquet(true.replace(Omega=speed))
        slip_time = cycle.period * (1 - cycle.stick_fraction)
        at = {"Omega": speed}
        measured.append(dm.Measurement("period", cycle.period + errors[0], 2e-5, at))
        measured.append(dm.Measurement("slip_time", slip_time + errors[1], 2e-5, at))
    found = dm.fit(true.replace(mu_s=0.4, k_p=2e4), ["mu_s", "k_p"], measured)
    assert found.converged
    # five standard deviations of some 0.0004 and 19 N/m
    assert found.parameters["mu_s"].value == pytest.approx(0.43, abs=0.002)
    assert found.parameters["k_p"].value == pytest.approx(18000, abs=95)


@pytest.mark.compiled
def test_a_bound_that_holds_a_parameter_is_said() -> None:
    """The measurements were said not to determine it, though they are exact. A bound between the value
    and an end of its interval was not said at all."""
    case = dm.Parameters(N=385, Omega=14)
    true = case.replace(k_p=19000.0)
    speeds = (11.5, 13.0, 14.8)
    measured = [
        dm.Measurement(
            "period", dm.floquet(true.replace(Omega=speed)).period, 1e-5, {"Omega": speed}
        )
        for speed in speeds
    ]
    free = dm.fit(case, ["k_p"], measured)
    assert free.at_bounds == {}
    assert free.consistent
    held = dm.fit(case, ["k_p"], measured, bounds={"k_p": (19500, 22000)})
    assert held.at_bounds == {"k_p": 19500.0}
    assert "k_p is held by its bound 19500" in held.doubt
    assert "do not determine" not in held.doubt
    near = 19000 + 0.5 * free.parameters["k_p"].deviation
    below = case.replace(k_p=18500.0)
    beside = dm.fit(below, ["k_p"], measured, bounds={"k_p": (18000, near)})
    assert beside.at_bounds == {}
    assert beside.passed_bounds == {"k_p": (near,)}
    assert np.isnan(held.parameters["k_p"][1:]).all()


def stiffness_between(low: float, high: float) -> dm.Fit:
    """A fit of a stiffness that is measured as 19109 ± 97 N/m."""

    def stiffness(case: dm.Parameters) -> float:
        return case.k_p

    start = BLOCK.replace(k_p=0.5 * (low + high))
    measured = [dm.Measurement(stiffness, 19109.0, 97.0)]
    return dm.fit(start, ["k_p"], measured, bounds={"k_p": (low, high)})


def test_a_bound_that_only_an_interval_passes_leaves_the_rest() -> None:
    """The parameter was said to be held by the bound, and had no standard deviation."""
    found = stiffness_between(19000, 21000)
    k_p = found.parameters["k_p"]
    assert found.at_bounds == {}
    assert found.passed_bounds == {"k_p": (19000.0,)}
    assert k_p.deviation == pytest.approx(97, rel=1e-4)
    assert k_p.high == pytest.approx(19109 + 1.96 * 97, rel=1e-5)
    assert math.isnan(k_p.low)
    assert found.consistent
    said = dict(found.summary())
    assert said["k_p"] == "19109 N/m (less than 19000 to 19299.1)"
    assert str(said["intervals"]).endswith(
        "; the interval of k_p passes its bound 19000, beyond which its end is not known"
    )
    data = found.to_dataset().sel(parameter="k_p")
    assert data["passed_low"].item() == 19000.0
    assert np.isnan(data["passed_high"].item())
    assert np.isnan(data["at_bound"].item())


def test_an_interval_may_pass_both_bounds() -> None:
    found = stiffness_between(19000, 19200)
    assert found.passed_bounds == {"k_p": (19000.0, 19200.0)}
    assert np.isnan(found.parameters["k_p"][2:]).all()
    assert dict(found.summary())["k_p"] == "19109 N/m (less than 19000 to more than 19200)"


def test_a_parameter_without_an_interval_has_no_fold_within_it() -> None:
    """The end of an interval that is not given was said to have no motion."""

    def short(case: dm.Parameters) -> float:
        return case.c_p if case.c_p < 1.8 else math.nan

    found = dm.fit(BLOCK.replace(c_p=1), ["c_p"], [dm.Measurement(short, 0.0, 1.0)])
    assert found.at_bounds == {"c_p": 0.0}
    assert found.unpredicted == {}
    assert found.limits["c_p"] == pytest.approx(1.645, rel=1e-3)


@pytest.mark.parametrize("low", [19109.0, 19150.0, 20000.0])
def test_a_bound_holds_a_value_that_lies_there(low: float) -> None:
    found = stiffness_between(low, 21000)
    assert found.at_bounds == {"k_p": low}
    assert found.passed_bounds == {}
    assert found.doubt.startswith(f"k_p is held by its bound {low:.6g}: widen")


def test_a_fit_at_a_bound_shows_what_it_says() -> None:
    """Its interval was given as numbers, which the fit itself said to mean nothing."""
    found = dm.fit(BLOCK.replace(c_p=2), ["c_p"], [dm.Measurement(damping, 0.5, 1.0)])
    assert found.parameters["c_p"].value == pytest.approx(0.5)
    assert np.isnan(found.parameters["c_p"][1:]).all()
    assert found.covariance.item() == pytest.approx(1.0)
    assert "nan" not in repr(found)
    assert len(found.plot()) == 2
    pyplot.close("all")


def damping(case: dm.Parameters) -> float:
    """A quantity that is a parameter, so that limits are known in closed form."""
    return case.c_p


@pytest.mark.parametrize("bounds", [{"c_p": (0, 50)}, None])
@pytest.mark.parametrize("measured", [-1.0, 0.0, 0.5])
def test_a_parameter_that_may_be_zero_has_an_upper_limit(
    measured: float, bounds: dict[str, Any] | None
) -> None:
    """It was said to be held by its bound, and without bounds to be undetermined by a search that had not
    converged."""
    table = [dm.Measurement(damping, measured, 1.0)]
    found = dm.fit(BLOCK.replace(c_p=2), ["c_p"], table, bounds=bounds)
    z = 1.6449
    limit = measured + z if measured >= 0 else measured + math.sqrt(measured**2 + z**2)
    assert found.converged
    assert found.limits["c_p"] == pytest.approx(limit, rel=1e-3)
    assert f"c_p is below {limit:.3g} N s/m at 95 % confidence" in found.doubt
    assert "the interval of c_p passes 0, beyond which there is no case" in found.doubt
    assert "widen" not in found.doubt


@pytest.mark.parametrize("draws", [60, pytest.param(300, marks=pytest.mark.slow)])
def test_upper_limits_lie_above_the_true_value_in_95_of_100_draws(draws: int) -> None:
    drawn = np.random.default_rng(5).normal(size=draws)
    start = BLOCK.replace(c_p=2)
    for true in (0.0, 0.5, 1.0):
        above = 0
        for error in drawn:
            table = [dm.Measurement(damping, true + error, 1.0)]
            found = dm.fit(start, ["c_p"], table, bounds={"c_p": (0, 50)})
            above += not found.limits.get("c_p", math.inf) < true
        assert above >= binom.ppf(0.01, len(drawn), 0.95)


def test_a_limit_of_a_cycle_is_where_chi_squared_has_risen_as_far() -> None:
    truth = DISC.replace(N=385, Omega=14)
    cycle = Prediction(truth)
    table = {"period": (cycle.of("period"), 1e-5), "growth_rate": (cycle.of("growth_rate"), 0.05)}
    found = dm.fit(truth.replace(c_p=0.3), ["c_p"], table)
    at_limit = Prediction(truth.replace(c_p=found.limits["c_p"]))
    rise = sum(((at_limit.of(name) - value) / s) ** 2 for name, (value, s) in table.items())
    assert rise - found.chi_squared == pytest.approx(1.6449**2, rel=0.05)


def test_a_parameter_without_effect_up_to_a_limit_has_none() -> None:

    def flat(case: dm.Parameters) -> float:
        return min(case.c_p, 1.0)

    found = dm.fit(BLOCK, ["c_p"], [dm.Measurement(flat, 0.0, 1.0)], bounds={"c_p": (0, 50)})
    assert math.isnan(found.limits["c_p"])
    assert "confidence" not in found.doubt


def test_the_measurement_that_deviates_most_is_named() -> None:
    case = dm.Parameters(N=385, Omega=14)
    measured = []
    for speed, error in ((11.5, 0.0), (13.0, 1e-3), (14.0, 0.0), (14.8, 0.0)):
        period = dm.floquet(case.replace(Omega=speed)).period
        measured.append(dm.Measurement("period", period + error, 1e-5, {"Omega": speed}))
    assert "period (Omega=13) deviates most" in dm.fit(case, ["k_p"], measured).doubt


@pytest.mark.compiled
def test_a_fold_within_an_interval_is_said() -> None:
    """It said that the measurements do not determine mu_s, and gave an end at which there is no
    cycle."""
    case = dm.Parameters(N=385, Omega=15)
    found = dm.fit(case, ["mu_s"], {"period": (0.0148, 1e-5)})
    mu_s = found.parameters["mu_s"]
    assert found.indistinct == ()
    assert math.isnan(mu_s.low)
    assert mu_s.high == pytest.approx(mu_s.value + 1.96 * mu_s.deviation, rel=1e-5)
    [end] = found.unpredicted["mu_s"]
    assert not dm.floquet(case.replace(mu_s=end)).stable
    assert found.doubt == (
        f"no such motion was found at mu_s={end:.6g}: a fold, or another end of the cycle, lies within the interval"
    )
    assert dict(found.summary())["intervals"].startswith("none: no such motion")
    # where the cycle exists at both ends nothing is said
    surer = dm.fit(case, ["mu_s"], {"period": (0.01485, 1e-6)})
    assert surer.unpredicted == {}
    assert surer.consistent


def level(case: dm.Parameters) -> float:
    """A quantity that does not exist for some values of mu_s."""
    if 0.41 < case.mu_s < 0.43:
        raise ArithmeticError("nothing was found")
    return case.mu_s


def square(case: dm.Parameters) -> float:
    """A quantity that exists everywhere."""
    return case.mu_s**2


def test_a_search_that_stops_in_front_of_a_gap_says_so() -> None:
    """It blamed the model and the uncertainties."""
    start = DISC.replace(mu_s=0.4)
    found = dm.fit(start, ["mu_s"], [dm.Measurement(level, 0.42, 1e-4)])
    assert not found.converged
    assert not found.consistent
    assert found.gap is not None
    assert found.gap.measurements == ("level",)
    assert found.gap.values["mu_s"] == pytest.approx(0.41, rel=1e-3)
    assert found.doubt == (
        "the search stopped near mu_s = 0.41, where level does not exist: start from the other side of this gap,"
        " or leave out this measurement"
    )
    assert "in front of a gap" in found.message
    data = found.to_dataset()
    assert data["gap"].item() == found.gap.values["mu_s"]
    assert data["gap"].attrs["long_name"].endswith("has stopped, nan if it has not")


def test_a_search_goes_on_beyond_a_gap_where_other_measurements_lead() -> None:
    start = DISC.replace(mu_s=0.4)
    measured = [dm.Measurement(level, 0.44, 1e-4), dm.Measurement(square, 0.44**2, 1e-4)]
    found = dm.fit(start, ["mu_s"], measured)
    assert found.consistent
    assert found.gap is None
    assert found.parameters["mu_s"].value == pytest.approx(0.44, rel=1e-8)


def test_a_bound_before_a_gap_is_no_gap() -> None:
    start = DISC.replace(mu_s=0.4)
    measured = [dm.Measurement(level, 0.42, 1e-4)]
    found = dm.fit(start, ["mu_s"], measured, bounds={"mu_s": (0.39, 0.405)})
    assert found.gap is None
    assert found.at_bounds == {"mu_s": 0.405}


def times_of_five_speeds(true: dm.Parameters) -> list[dm.Measurement]:
    """Exact periods of a case at five speeds, and times of slip at three."""
    found = []
    for speed in (10, 11, 12, 13, 14):
        at = {"Omega": speed}
        prediction = Prediction(true.replace(**at))
        found.append(dm.Measurement("period", prediction.of("period"), 1e-5, at))
        if speed % 2 == 0:
            found.append(dm.Measurement("slip_time", prediction.of("slip_time"), 1e-5, at))
    return found


@pytest.mark.compiled
def test_a_search_finds_exact_data_beyond_a_gap_without_a_cycle() -> None:
    """The search crept along a gap at 14 rad/s, and the fit blamed the model: chi squared was 1790."""
    true = dm.Parameters(N=385, Omega=14, mu_s=0.42, mu_k=0.25, k_p=2.1e4)
    measured = times_of_five_speeds(true)
    found = dm.fit(true.replace(mu_s=0.4, k_p=2e4), ["mu_s", "k_p"], measured)
    assert found.consistent
    assert found.parameters["mu_s"].value == pytest.approx(0.42, rel=1e-8)
    assert found.parameters["k_p"].value == pytest.approx(2.1e4, rel=1e-8)


@pytest.mark.compiled
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(30))
def test_exact_data_are_found_from_starts_nearby(seed: int) -> None:
    """Of starts up to 5 % away two in 26 had ended in front of gaps."""
    rng = np.random.default_rng(seed)
    mu_s = 0.42 * (1 + 0.03 * rng.uniform(-1, 1))
    k_p = 2.05e4 * (1 + 0.05 * rng.uniform(-1, 1))
    true = dm.Parameters(N=385, Omega=14, mu_s=mu_s, mu_k=0.25, k_p=k_p)
    factors = 1 + 0.05 * rng.uniform(-1, 1, 2)
    start = true.replace(mu_s=mu_s * factors[0], k_p=k_p * factors[1])
    try:
        found = dm.fit(start, ["mu_s", "k_p"], times_of_five_speeds(true))
    except (Unpredicted, dm.ParameterError):
        return  # there is no cycle at one of the speeds, at the start or in the true case
    assert found.chi_squared < 1e-3


@pytest.mark.compiled
def test_a_fitted_cycle_that_is_unstable_is_said() -> None:
    case = dm.Parameters(N=385, Omega=16)
    period = Prediction(case).of("period")
    found = dm.fit(case.replace(mu_s=0.3995), ["mu_s"], {"period": (period, 1e-6)})
    rate = dm.floquet(found.case).growth_rate
    assert rate == pytest.approx(0.74, abs=0.01)
    assert found.unstable == {"period": rate}
    assert found.note == (
        "in the fitted case the cycle of period (0.74/s) is unstable: a motion does not stay on it"
    )
    # the values are those of the cycle all the same
    assert found.consistent
    assert repr(found).endswith(f"; {found.note})")
    assert dict(found.summary())["note"] == found.note
    data = found.to_dataset()
    assert data["unstable"].values.tolist() == [rate]
    assert data.attrs["note"] == found.note


@pytest.mark.compiled
def test_a_stable_cycle_and_quantities_of_no_cycle_have_no_note() -> None:
    case = dm.Parameters(N=385, Omega=16)
    rate = Prediction(case).of("growth_rate")
    assert dm.fit(case, ["mu_s"], {"growth_rate": (rate, 1e-3)}).unstable == {}
    assert (
        dm.fit(
            case, ["rho"], {"frequency_2_0": (Prediction(case).of("frequency_2_0"), 1.0)}
        ).unstable
        == {}
    )
    stable = dm.fit(case, ["mu_s"], [dm.Measurement("period", 0.01485, 1e-6, {"Omega": 15})])
    assert stable.note == ""
    assert "note" not in dict(stable.summary())
    assert np.isnan(stable.to_dataset()["unstable"].item())


@pytest.mark.compiled
def test_a_fit_says_that_the_motion_is_not_near_a_fitted_cycle() -> None:
    """As `floquet` does at this speed."""
    case = dm.Parameters(N=375, Omega=7.35)
    found = dm.fit(case, ["mu_s"], {"period": (Prediction(case).of("period"), 1e-6)})
    assert dm.floquet(found.case).near_motion is False
    assert found.elsewhere == ("period",)
    assert found.note.endswith(
        "a motion does not stay on it, and none from the static start comes near"
    )


def test_a_note_names_all_unstable_cycles() -> None:
    found = dm.fit(DISC, ["E"], {"frequency_0_0": (239.0, 0.5)})
    noted = replace(found, unstable={"period": 0.5, "slip_time (Omega=14)": 0.25})
    assert noted.note == (
        "in the fitted case the cycles of period (0.5/s) and slip_time (Omega=14) (0.25/s) are unstable: "
        "a motion does not stay on them"
    )
    away = replace(found, elsewhere=("period", "slip_time (Omega=14)"))
    assert away.note == (
        "the motion from the static start is not near the cycles of period and slip_time (Omega=14)"
    )
    rates = {f"period (Omega={speed})": 0.5 for speed in range(11, 16)}
    assert "Omega=13) (0.5/s) and 2 others are unstable" in replace(found, unstable=rates).note


def test_a_parameter_that_starts_far_below_its_value_is_not_doubted() -> None:
    """Standard deviations count over the value that is found, too."""
    truth = DISC.replace(c=3.0)
    measured = {
        "growth_rate": (Prediction(truth).of("growth_rate"), 1e-6),
        "period": (Prediction(truth).of("period"), 1e-6),
    }
    for start in (0.02, 3.0):
        fit = dm.fit(DISC.replace(c=start), ["c", "k_p"], measured)
        assert fit.doubt == ""
        # chi squared falls until deviations are some 1e-5 of the uncertainties
        assert fit.parameters["c"].value == pytest.approx(3.0, rel=1e-4)


def test_a_start_without_a_cycle_is_told_where_to_begin() -> None:
    """The message showed an empty value, and no remedy."""
    at = {"Omega": 10.0}
    measured = [dm.Measurement("period", 0.0153, 1e-5, at=at)]
    with pytest.raises(dm.ParameterError) as error:
        dm.fit(dm.Parameters(N=250, Omega=9, mu_k=0.24), ["mu_s"], measured)
    message = str(error.value)
    assert message.startswith("measured.period (Omega=10): cannot be computed: no cycle of up to 3")
    assert message.endswith("start the search from a case with other values than mu_s=0.4")


def test_a_mode_that_is_missing_is_no_matter_of_the_start() -> None:
    with pytest.raises(dm.ParameterError) as error:
        dm.fit(DISC, ["E"], {"frequency_9_0": (1, 1)})
    assert "start" not in str(error.value)
    assert "=''" not in str(error.value)


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (239.0, ""),
        (
            0.239,
            "frequency_0_0 = 0.239 Hz is 1/990 of the 237.4 Hz that the case gives: was 239 Hz meant?",
        ),
        (
            2.39e5,
            "frequency_0_0 = 239000 Hz is 1000 times the 237.4 Hz that the case gives: was 239 Hz meant?",
        ),
    ],
)
def test_a_measured_value_in_another_unit_is_doubted(value: float, said: str) -> None:
    """What was fitted to it was far from any disc, and only that was said."""
    case = dm.Parameters(N=385, Omega=15, normalization="orthonormal")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        dm.fit(case, ["E"], {"frequency_0_0": (value, 0.5e-3 * value)})
    texts = [str(each.message) for each in caught if str(each.message).startswith("measured.")]
    assert texts == ([f"measured.{said}"] if said else [])


@pytest.mark.parametrize(
    ("value", "given", "unit", "said"),
    [
        (15.73, 0.0157, "s", "was 15.73 ms meant?"),
        (15.73e-6, 0.0157, "s", "was 15.73 ms meant?"),
        (15730.0, 0.0157, "s", "was 15.73 ms meant?"),
        (0.5, 0.4e-6, "m", "was 500 nm meant?"),
        (15.73, 0.05, "s", "was 15.73 ms meant?"),
        (2.2, 0.021, "m", "was 22 mm meant?"),
        (1.0, 1e-4, "m", "or start from another case"),
        (1.5, 0.0157, "s", ""),
        (-5.0, 0.02, "1/s", ""),
        (-3.0, 0.02, "s", ""),
        (0.01, 1e-6, "1", ""),
        (5.0, 0.01, "", ""),
    ],
)
def test_the_value_that_was_meant_has_a_unit_of_its_size(
    value: float, given: float, unit: str, said: str
) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warn_of_measured([("period", value, unit)], [given])
    assert [str(each.message).endswith(said) for each in caught] == ([True] if said else [])


def test_a_time_of_a_cycle_in_another_unit_is_refused() -> None:
    """The search went on without end, among springs so soft that each cycle took seconds."""
    case = dm.Parameters(N=385, Omega=14)
    measured = {"period": (15.73, 0.01), "slip_time": (10.52, 0.01)}
    said = (
        "measured: period = 15.73 s is 1100 times the 0.01497 s that the case gives: was 15.73 ms meant?;"
        " 1 other measured value alike; if it is right, start from a case that gives a value nearer to it"
    )
    with pytest.raises(dm.ParameterError, match=re.escape(said)):
        dm.fit(case, ["mu_s", "k_p"], measured)


def test_a_fit_counts_the_values_that_it_tries(capsys: pytest.CaptureFixture[str]) -> None:
    dm.fit(DISC, ["E"], {"frequency_0_0": (239.0, 0.5)}, progress=True)
    assert re.search(r"fit +[1-9]\d*", capsys.readouterr().err)
    with refusal("progress='yes'"):
        dm.fit(DISC, ["E"], {"frequency_0_0": (239.0, 0.5)}, progress="yes")  # type: ignore[arg-type]


def test_several_measured_values_in_another_unit_are_one_warning() -> None:
    named = [("period (Omega=12)", 16.3, "s"), ("period", 15.7, "s"), ("slip_time", 0.01, "s")]
    with pytest.warns(
        ImplausibleValue, match=r"period \(Omega=12\) = 16.3 s .*; 1 other measured value alike"
    ):
        warn_of_measured(named, [0.0163, 0.0157, 0.0105])


def test_a_start_at_a_bound_stays_where_the_case_has_its_cycle() -> None:
    """It was moved to 1 % of the bounds, where there is none, and refused by a value not given."""
    true = dm.Parameters(N=385, Omega=15)
    times = []
    for speed in (12, 13, 14, 14.5):
        cycle = dm.floquet(true.replace(Omega=speed))
        times.append(dm.Measurement("period", cycle.period, 2e-5, at={"Omega": speed}))
        slip = cycle.period * (1 - cycle.stick_fraction)
        times.append(dm.Measurement("slip_time", slip, 2e-5, at={"Omega": speed}))
    assert dm.floquet(true.replace(Omega=14.5, c_p=1)).status == "no_cycle"
    found = dm.fit(true, ["mu_s", "k_p", "c_p"], times, bounds={"c_p": (0, 100)})
    assert found.chi_squared < 1e-6
    assert 0 < found.limits["c_p"] < 2
