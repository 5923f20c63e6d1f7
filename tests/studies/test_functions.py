"""Quantities of a case and studies as functions: the same numbers as those of the workflow's
batches."""

import inspect
import json
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from disc_model.studies.registry import quantity_of
from disc_model.studies.whole_study import run_study

import disc_model as dm
from disc_model.data.variables import flag_names
from disc_model.studies import functions
from tests.refusals import refusal

P = dm.Parameters(N=385, Omega=14)
STARTS = {"horizon": 20, "energies": [0.1]}
SCAN = {"start": 14, "stop": 15, "step": 1}
SAME = [
    (dm.outcome, {"horizon": 20}, {"horizon": 20}),
    (
        dm.critical_speed,
        {"bounds": (14, 15), "horizon": [20, 30]},
        {"scan": SCAN, "horizons": [20, 30]},
    ),
    (dm.basins, STARTS, STARTS),
    (dm.hysteresis, {"bounds": (14, 15), "dwell": 10}, {"scan": SCAN, "dwell": 10}),
]


def the_study(quantity: str, options: dict[str, Any]) -> dict[str, Any]:
    if "scan" in options:
        base = {"N": 385}
    else:
        base = {"N": 385, "Omega": 14}
    return {
        "study": "s",
        "quantity": quantity,
        "base": base,
        "options": options,
        "axes": {"c": [0]},
    }


@pytest.mark.compiled
@pytest.mark.parametrize(("function", "arguments", "options"), SAME)
def test_a_function_gives_what_a_study_does(function: Any, arguments: Any, options: Any) -> None:
    of_study = run_study(the_study(function.__name__, options)).isel(c=0)
    of_function = function(P, **arguments)
    of_function = of_function.drop_vars("at_lower_bound", errors="ignore")  # which the scan tells
    assert set(of_function) == set(of_study) - {"message"}
    for variable, values in of_function.items():
        stored = of_study[variable]
        if "flag_meanings" in stored.attrs:
            stored = flag_names(stored)
        else:
            stored = stored.values
        np.testing.assert_array_equal(values.values, stored, err_msg=variable)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: dm.critical_speed(P, (14, 15), [5, "x"]), "horizon.1='x'"),
        (lambda: dm.critical_speed(P, (14, 15), step=-1), "step=-1"),
        (
            lambda: dm.critical_speed(P, (14, 15), step=0.3),
            "bounds=(14, 15): highest - lowest must be a multiple of step=0.3",
        ),
        (lambda: dm.hysteresis(P, (15, 14), 10), "bounds=(15, 14): lowest=15 must be < highest=14"),
        (lambda: dm.outcome(P, 10, start={"u": "x"}), "start.u='x'"),
        (lambda: dm.basins(P, n_starts=0), "n_starts=0"),
    ],
)
def test_a_wrong_argument_is_named_as_the_function_has_it(
    call: Callable[[], object], name: str
) -> None:
    with pytest.raises(dm.ParameterError) as error:
        call()
    assert any(fault.startswith(name) for fault in error.value.faults), error.value.faults


def test_a_study_of_cases_is_a_tree() -> None:
    case = {"title": "one", "parameters": {"N": 385, "Omega": 14}, "t_end": 0.1}
    tree = run_study({"study": "s", "cases": {"A": case}})
    assert json.loads(tree["A"].attrs["parameters"])["N"] == 385


SPELLED_OUT = [
    (
        dm.outcome,
        {
            "horizon": 7,
            "evaluation_time": 0.5,
            "after_separation": 2,
            "early_end": False,
            "extrapolate": True,
        },
        {
            "horizon": 7,
            "evaluation_time": 0.5,
            "after_separation": 2,
            "early_end": False,
            "extrapolate": True,
        },
    ),
    (
        dm.critical_speed,
        {
            "bounds": (3, 9),
            "step": 2,
            "horizon": 7,
            "precision": 0.5,
            "max_crossings": 3,
            "early_end": False,
            "extrapolate": False,
        },
        {
            "scan": {"start": 3, "stop": 9, "step": 2},
            "horizons": [7],
            "precision": 0.5,
            "max_crossings": 3,
            "early_end": False,
            "extrapolate": False,
        },
    ),
    (
        dm.basins,
        {
            "energies": [0.1, 0.2],
            "n_starts": 3,
            "precision": 0.2,
            "confidence": 0.9,
            "horizon": 7,
            "seed": 5,
            "attractor_tol": 0.2,
            "n_bisection_directions": 4,
            "max_attractors": 20,
        },
        {
            "energies": [0.1, 0.2],
            "n_starts": 3,
            "precision": 0.2,
            "confidence": 0.9,
            "horizon": 7,
            "seed": 5,
            "attractor_tol": 0.2,
            "n_bisection_directions": 4,
            "max_attractors": 20,
        },
    ),
    (
        dm.hysteresis,
        {"bounds": (3, 9), "dwell": 4, "step": 2, "max_dwell": 8, "evaluation_time": 3},
        {
            "scan": {"start": 3, "stop": 9, "step": 2},
            "dwell": 4,
            "max_dwell": 8,
            "evaluation_time": 3,
        },
    ),
]
FUNCTIONS = [function for function, *_ in SPELLED_OUT]
STARTED = (dm.outcome, dm.basins)  # functions whose motion may begin elsewhere


@pytest.mark.parametrize(("function", "arguments", "options"), SPELLED_OUT)
def test_every_argument_of_a_function_reaches_the_option_of_its_name(
    function: Any, arguments: Any, options: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    handed: list[Any] = []
    # a message that says what went wrong is left as it is
    found = xr.Dataset({"kind": ((), "stick_slip")}, attrs={"message": "failed"})
    found["critical_speed"] = ("horizon", [5.0])
    found["horizon"] = [7.0]
    found["scan_Omega"] = [5.0, 6.0]

    def take(*parts: Any, progress: bool = False) -> xr.Dataset:
        handed.extend(parts)
        return found

    monkeypatch.setattr(functions, "compute_quantity", take)
    start = {"start": {"u": 1e-3}} if function in STARTED else {}
    function(P, tol=1e-9, **arguments, **start)
    name, case, chosen, *starts = handed
    assert name == function.__name__
    assert case is P
    assert chosen == {**options, "tol": 1e-9}
    assert starts == [{"u": 1e-3}] * len(start)


# Options under another name in a function: `start` has those of `Start`, `horizon`,
# `bounds` and `step` others.
SPELLED_OTHERWISE = {"prerun", "perturbation", "horizons", "scan"}


@pytest.mark.parametrize("function", FUNCTIONS)
def test_every_option_is_an_argument_of_the_function(function: Any) -> None:
    options = {*quantity_of(function.__name__).model_fields} - SPELLED_OTHERWISE
    missing = options - {*inspect.signature(function).parameters}
    assert not missing, f"add to {function.__name__} in studies/functions.py: {missing}"


@pytest.mark.parametrize("function", FUNCTIONS)
def test_what_a_function_is_not_told_is_as_in_a_study(function: Any) -> None:
    fields = quantity_of(function.__name__).model_fields
    compared = 0
    for name, argument in inspect.signature(function).parameters.items():
        if name not in fields or fields[name].is_required() or argument.default is None:
            continue
        compared += 1
        assert argument.default == fields[name].default, name
    assert compared >= 3


def test_a_longest_stay_below_the_first_one_is_refused() -> None:
    with refusal(r"^max_dwell=10 must be >= dwell=20$"):
        dm.hysteresis(P, (11, 13), 20, max_dwell=10)


@pytest.mark.compiled
def test_basins_count_the_starts_that_are_done(capsys: pytest.CaptureFixture[str]) -> None:
    starts = {"energies": [1e-4, 1e-3], "n_starts": 2, "horizon": 5}
    dm.basins(P, **starts)
    assert capsys.readouterr() == ("", "")
    dm.basins(P, **starts, progress=True)
    assert re.search(r"basins .*4/4", capsys.readouterr().err)
    with refusal("progress='yes'"):
        dm.basins(P, progress="yes")  # type: ignore[arg-type]


@pytest.mark.compiled
def test_a_critical_speed_counts_the_speeds_of_its_scan(capsys: pytest.CaptureFixture[str]) -> None:
    dm.critical_speed(P, (14, 16), 0.5, progress=True)
    assert re.search(r"critical_speed .*3/3", capsys.readouterr().err)


@pytest.mark.parametrize(("horizon", "dims"), [(0.5, ()), ([0.5], ("horizon",))])
def test_a_critical_speed_within_one_horizon_is_a_number(
    horizon: Any, dims: tuple[str, ...]
) -> None:
    """It had a dimension of one place, and `float` of it failed."""
    speeds = dm.critical_speed(P, (14, 16), horizon)
    assert speeds["critical_speed"].dims == dims
    assert speeds["at_lower_bound"].dims == dims
    assert speeds["crossing"].dims == (*dims, "crossing_number")
    assert json.loads(speeds.attrs["options"])["horizons"] == [0.5]


def test_a_critical_speed_that_is_nan_is_said_in_words() -> None:
    """It was nan with an empty message."""
    quiet = dm.Parameters(N=100, Omega=15)
    speeds = dm.critical_speed(quiet, (1, 3), [1.0, 2.0])
    assert np.isnan(speeds["critical_speed"]).all()
    said = "no separation within 1, 2 s at 3 speeds from 1 to 3 rad/s"
    assert speeds.attrs["message"] == said


@pytest.mark.parametrize(
    ("rates", "onset", "end", "message"),
    [
        ([[0, 0, 0], [0, 0, 0]], math.nan, math.nan, "kept at all 3 speeds from 12 to 16 rad/s"),
        (
            [[0, 0, 9], [9, 9, 9]],
            16.0,
            math.nan,
            "still lost on the way down at the lower bound, 12",
        ),
        ([[9, 9, 9], [0, 9, 9]], math.nan, 14.0, "on the way up from the lower bound on, 12 rad/s"),
        ([[0, 9, 0], [0, 0, 0]], 14.0, math.nan, "kept at 16 rad/s, where the way down begins"),
        ([[0, 0, 9], [0, 9, 9]], 16.0, 14.0, ""),
    ],
)
def test_a_sweep_says_why_it_has_no_onset_or_end(
    rates: list[list[float]], onset: float, end: float, message: str
) -> None:
    """The lower bound was returned as the end, and nothing was said."""
    sweep = swept(rates, onset, end)
    sweep["sweep_settled"] = sweep["separation_rate"].astype(str).copy(data=[["settled"] * 3] * 2)
    said = functions._with_reasons(sweep).attrs["message"]
    assert message in said
    assert bool(said) == bool(message)


@pytest.mark.parametrize(
    ("rates", "message"),
    [
        ([[0, 0, 0], [0, 0, 0]], "at all 3 values of mu_k from 12 to 16"),
        ([[9, 9, 9], [9, 9, 9]], "still lost on the way down at the lower bound, mu_k = 12;"),
        ([[0, 9, 0], [0, 0, 0]], "kept at mu_k = 16, where the way down begins"),
        ([[0, 0, 9], [0, 0, 9]], "at mu_k = 12, 14 on the way up the motion in contact"),
    ],
)
def test_a_sweep_along_another_number_names_it(rates: list[list[float]], message: str) -> None:
    """It said "at the lower bound, 0.2"."""
    sweep = swept(rates, math.nan, math.nan)
    stays = [["doubled", "doubled", "settled"], ["settled", "settled", "settled"]]
    sweep["sweep_settled"] = sweep["separation_rate"].astype(str).copy(data=stays)
    assert message in functions._with_reasons(sweep, "mu_k").attrs["message"]


def swept(rates: list[list[float]], onset: float, end: float) -> xr.Dataset:
    data = {
        "separation_rate": (("direction", "sweep_Omega"), np.array(rates)),
        "onset_speed": ((), onset),
        "offset_speed": ((), end),
    }
    coords = {"direction": ["up", "down"], "sweep_Omega": [12.0, 14.0, 16.0]}
    return xr.Dataset(data, coords, {"message": ""})


def test_a_sweep_says_where_contact_may_yet_be_lost() -> None:
    """An onset at 13 rad/s rested on a stay at 12 rad/s that was undecided, and nothing said so: a
    longer one separates."""
    sweep = swept([[0, 0, 9], [0, 9, 9]], 16.0, 14.0)
    settled = [["settled", "undecided", "changing"], ["settled", "settled", "settled"]]
    sweep["sweep_settled"] = (("direction", "sweep_Omega"), settled)
    said = functions._with_reasons(sweep).attrs["message"]
    assert said == (
        "at 14 rad/s on the way up the motion in contact has not settled and may yet separate: "
        "raise max_dwell"
    )


SCANNING = pytest.mark.parametrize("function", [dm.critical_speed, dm.hysteresis])


@SCANNING
def test_a_step_that_does_not_divide_the_bounds_names_them(function: Any) -> None:
    """The message named scan, which is no argument."""
    bounds = ("14 rad/s", 15.5)
    rule = "highest - lowest must be a multiple of step=0.4"
    with pytest.raises(dm.ParameterError) as raised:
        function(P, bounds, 100, step=0.4)
    message = str(raised.value)
    assert message == f"bounds={bounds}: {rule}"


@SCANNING
def test_speeds_of_a_scan_are_bounds_as_in_continuation(function: Any) -> None:
    with refusal(r"^scan=\(14, 15\): is called bounds$"):
        function(P, scan=(14, 15))
    assert "bounds" in inspect.signature(function).parameters
    assert "bounds" in inspect.signature(dm.continue_cycle).parameters


@pytest.mark.parametrize("ends", [14, (14,), (14, 15, 16)])
def test_a_scan_has_two_ends(ends: Any) -> None:
    with refusal(r"^bounds=.*: must be two numbers in rad/s"):
        dm.critical_speed(P, ends)


def test_a_result_states_its_options() -> None:
    """A file of a critical speed did not tell how exact it is."""
    case = dm.Parameters(N=385, Omega=15)
    found = dm.critical_speed(case, (15, 15.5), 1, step=0.5, precision=0.25)
    options = json.loads(found.attrs["options"])
    assert (options["precision"], options["horizons"]) == (0.25, [1])
    assert (options["scan"]["start"], options["scan"]["stop"]) == (15, 15.5)


def test_contact_that_is_lost_at_the_lowest_speed_is_told() -> None:
    """By the names that `critical` has for it."""
    case = P.replace(Omega=15)
    lost = dm.critical_speed(case, (15.5, 16.5), [10, 60])
    _, within_a_minute = lost["critical_speed"].values
    message = lost.attrs["message"]
    rule = "contact is already lost within 60 s at the lower bound, 15.5 rad/s"
    assert within_a_minute == 15.5
    assert lost["at_lower_bound"].values.tolist() == [False, True]
    assert message.endswith(rule)


def precision_of(bounds: tuple[Any, Any], step: Any) -> float:
    """The precision of a scan that is told its step alone."""
    speeds = dm.critical_speed(P, bounds, 0.01, step=step)
    options = json.loads(speeds.attrs["options"])
    return options["precision"]


@pytest.mark.parametrize(("step", "precision"), [(0.25, 0.25 / 3), (0.05, 0.05), (1, 0.1)])
def test_the_precision_of_a_scan_follows_its_step(step: float, precision: float) -> None:
    bounds = (14.0, 14.0 + 2 * step)
    found = precision_of(bounds, step)
    assert found == pytest.approx(precision, rel=1e-4)


def test_the_precision_of_a_scan_follows_a_step_with_a_unit() -> None:
    bounds = ("130 rpm", "135 rpm")
    found = precision_of(bounds, "5 rpm")
    step = 0.5236  # rad/s
    assert found == pytest.approx(step / 6, rel=1e-4)


def test_a_step_that_is_no_multiple_of_the_precision_is_told_with_its_value() -> None:
    with refusal("the scan's step of 0.5 rad/s must be a multiple of precision=0.2 rad/s"):
        dm.critical_speed(P, (14, 15), 1, step=0.5, precision=0.2)


def test_a_name_of_studies_is_answered_with_that_of_functions() -> None:
    """A start as in a study file was told to be "start.start='perturbation'"."""
    kick = {"perturbation": {"u": 1e-4}}
    rule = r"start\.perturbation: is a key of study files\. In functions it is start={'u': 1e-4}$"
    with refusal(f"^{rule}"):
        dm.outcome(P, 60, start=kick)  # type: ignore[arg-type]
    with refusal(f"^{rule}"):
        dm.sweep(dm.outcome, P, over={"start": [kick]}, horizon=60, Omega=[12])
    with refusal(f"^{rule}"):
        dm.initial_state(P, kick)  # type: ignore[arg-type]
    with refusal(r"^start\.prerun: is a key .* it is initial_state\(case, prerun=\.\.\.\)$"):
        dm.basins(P, start={"prerun": {}})  # type: ignore[dict-item]
    with refusal(r"did you mean start\? In functions it is start={'u': 1e-4} \(known"):
        dm.outcome(P, 60, perturbation={"u": 1e-4})  # type: ignore[call-arg]


def test_a_name_of_functions_is_answered_with_that_of_studies() -> None:
    study = {"study": "s", "quantity": "outcome", "base": {"N": 385}, "axes": {"Omega": [12]}}
    meant = r"did you mean perturbation\? In study files it is perturbation: {u: 1e-4} \(known"
    for wrong in ({"start": {"u": 1e-4}}, {"u": 1e-4}):
        with pytest.raises(dm.DiscModelError, match=meant):
            dm.run_study(study | {"options": {"horizon": 3, **wrong}})
