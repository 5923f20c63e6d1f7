"""Small studies and cases for every kind of figure, and what each of its axes has to show.

Words and units are written by hand, values are taken from the data in SI units: a test converts
them by the unit in the label.
"""

import functools
import json
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model import Parameters, Poincare, Window, simulate
from disc_model.data.variables import LONG_TERM_OUTCOMES, OUTCOMES_TO_HORIZON, attributes
from disc_model.studies.registry import quantity_of
from tests.figures.measured import Shown
from tests.studies.conftest import computed

RECORDED = {
    "history": Window(stop=60, rate=200, envelope=100, theta=0.5),
    "zoom": Window(start=56, stop=56.035, rate=1e5, theta=0.5),
    "spectrum_a": Window(start=0, stop=3, rate=4e3, theta=0.5),
    "orbit": Window(start=59, rate=5e3, theta=0.5),
    "poincare": Poincare(theta=0.5),
}
SPEED = "Speed Ω"
LOAD = "Preload N"
SPEEDS = np.array([8.0, 11.0, 14.5])  # rad/s
LOADS = np.array([120.0, 310.0, 475.0])  # N
OK = {"flag_meanings": "ok failed"}
ONE = {"normalization": ["as_published"]}


@functools.cache
def simulated(separates: bool) -> xr.DataTree:
    """A minute with windows; contact is first lost at 54.4 s, or never."""
    Omega = 15.1 if separates else 15.0
    return simulate(Parameters(N=385, Omega=Omega), 60, RECORDED).to_tree()


class Example(NamedTuple):
    """A figure as a file asks for it, what it is drawn from, and what it has to show."""

    phrase: Mapping[str, Any]
    inputs: Mapping[str, xr.Dataset | xr.DataTree]
    shown: tuple[Shown, ...]


def flag(dims: tuple[str, ...], words: Any, meanings: tuple[str, ...]) -> tuple[Any, ...]:
    """A flag variable of words."""
    meanings = tuple(map(str, meanings))
    codes = np.vectorize(meanings.index, otypes=[np.int8])(np.asarray(words, dtype=object))
    return (dims, codes, {"flag_meanings": " ".join(meanings)})


def stated(**options: Any) -> dict[str, str]:
    """The base and the options that a grid study states."""
    return {
        "base": json.dumps({"N": 385.0, "normalization": "as_published"}),
        "options": json.dumps(options),
    }


def over(**axes: Any) -> dict[str, Any]:
    """Coordinates with the units of their parameters."""
    return {
        name: (name, values, {} if name == "normalization" else attributes(name))
        for name, values in axes.items()
    }


def column(quantity: str, name: str) -> dict[str, Any]:
    """Attributes of a variable of a quantity."""
    return quantity_of(quantity).COLUMNS[name].attributes


# ---- General kinds

PERIOD = np.array([[0.0148, 0.0151, 0.0153], [0.0161, 0.0164, 0.0172]])  # s
# N s/m and N/m
DAMPERS = np.array([0.02, 0.05, 0.08])
SPRINGS = np.array([2e4, 5e4])


def general() -> xr.Dataset:
    data = {"period": (("k_p", "c_p"), PERIOD, column("floquet", "period"))}
    return xr.Dataset(data, over(c_p=DAMPERS, k_p=SPRINGS), stated())


def heat_map() -> Example:
    return Example(
        {"variable": "period", "x": "c_p", "y": "k_p"},
        {"study": general()},
        (
            Shown(0, "x", "In-plane damper c_p", DAMPERS[[0, -1]], "N s/m", "linear"),
            Shown(0, "y", "In-plane spring k_p", SPRINGS, "N/m", "linear"),
            Shown(1, "bar", "Period of the stick-slip cycle", PERIOD, "s"),
        ),
    )


def curve() -> Example:
    return Example(
        {"variable": "period", "x": "c_p", "by": "k_p"},
        {"study": general()},
        (
            Shown(0, "x", "In-plane damper c_p", DAMPERS, "N s/m", "linear"),
            Shown(0, "y", "Period of the stick-slip cycle", PERIOD, "s", "linear"),
        ),
    )


# ---- Kinds of named cases


def samples(window: str, variable: str) -> np.ndarray:
    return np.asarray(simulated(True)[window][variable].values)


def history() -> Example:
    labels = {
        "P": ("Contact force P", "N"),
        "u": ("Slider u", "m"),
        "u_velocity": ("Slider du/dt", "m/s"),
        "w": ("Disc under the slider w", "m"),
        "w_point": (r"Disc at r_0, \theta = 0.5 rad", "m"),
        "w_point_velocity": (r"Disc velocity at r_0, \theta = 0.5 rad", "m/s"),
        "psi": ("Angle ψ", "rad"),
        "psi_velocity": ("dψ/dt", "rad/s"),
    }
    shown = [
        Shown(i, "y", words, samples("zoom", name)[::50], unit, "linear")
        for i, (name, (words, unit)) in enumerate(labels.items())
    ]
    time = Shown(len(labels) - 1, "x", "Time", samples("zoom", "time")[::50], "s", "linear")
    return Example(
        {"case": "A", "window": "zoom", "variables": [*labels]},
        {"A": simulated(True)},
        (*shown, time),
    )


def poincare() -> Example:
    where = r", \theta = 0.5 rad"
    return Example(
        {"case": "A"},
        {"A": simulated(True)},
        (
            Shown(0, "x", "Angle ψ", samples("poincare", "psi"), "rad"),
            Shown(0, "y", "dψ/dt", samples("poincare", "psi_velocity"), "rad/s"),
            Shown(1, "x", f"Disc at r_0{where}", samples("poincare", "w_point"), "m"),
            Shown(
                1,
                "y",
                f"Disc velocity at r_0{where}",
                samples("poincare", "w_point_velocity"),
                "m/s",
            ),
        ),
    )


def portrait() -> Example:
    return Example(
        {"case": "A", "window": "orbit", "x": "u", "y": "psi_velocity"},
        {"A": simulated(True)},
        (
            Shown(0, "x", "Slider u", samples("orbit", "u")[::20], "m"),
            Shown(0, "y", "dψ/dt", samples("orbit", "psi_velocity")[::20], "rad/s"),
        ),
    )


# Hz and m, of a vibration of the disc
TONE = 70.0
SIZE = 2e-3


def vibration() -> xr.DataTree:
    """A window in which the disc vibrates at one frequency."""
    time = np.arange(0, 4, 1 / 2000)
    window = simulated(True)["spectrum_a"].to_dataset().isel(time=slice(time.size))
    window = window.assign_coords(time=time).assign(
        w=("time", SIZE * np.sin(2 * np.pi * TONE * time), attributes("w"))
    )
    root = simulated(True).to_dataset()
    return xr.DataTree.from_dict({"/": root, "/tone": window})


def spectrum() -> Example:
    return Example(
        {"case": "A", "window": "tone", "variable": "w"},
        {"A": vibration()},
        (
            Shown(0, "x", "Frequency", [TONE], "Hz", "linear"),
            Shown(0, "y", "Disc under the slider w, amplitude", [SIZE], "m", "log"),
        ),
    )


def spectrogram() -> Example:
    return Example(
        {"case": "A", "window": "tone", "variable": "w", "highest": 400},
        {"A": vibration()},
        (
            Shown(0, "x", "Time", [0.5, 1.0, 3.0], "s", "linear"),
            Shown(0, "y", "Frequency", [TONE, 400.0], "Hz", "linear"),
            Shown(1, "bar", "Power (dB re strongest line)", [0.0]),
        ),
    )


# ---- Kinds of grid studies

RATES = np.array([[-0.2, -0.1, 0.05], [-0.1, 0.02, np.nan], [0.1, 0.2, 0.25]])  # 1/s


def regions() -> xr.Dataset:
    dims = ("N", "Omega", "normalization")
    words = [
        ["stick_slip", "stick_slip", "growing"],
        ["stick_slip", "growing", "undecided"],
        ["separation"] * 3,
    ]
    followed = np.where(np.isfinite(RATES), "followed", "no_cycle")
    cycles = quantity_of("regions").COLUMNS["cycle"].flags
    data = {
        "outcome": flag(dims, np.array(words)[..., None], OUTCOMES_TO_HORIZON),
        "cycle": flag(dims, followed[..., None], cycles),
        "growth_rate": (dims, RATES[..., None], column("regions", "growth_rate")),
        "status": flag(dims, np.full((3, 3, 1), "ok"), ("ok", "failed")),
    }
    for name in ("branch_continues_first", "branch_continues_second"):
        data[name] = flag(dims, np.full((3, 3, 1), "yes"), ("no", "yes"))
    return xr.Dataset(data, over(N=LOADS, Omega=SPEEDS, **ONE), stated(horizon=900.0))


def region_map() -> Example:
    growth = "Growth rate of the cycle that the static start follows"
    return Example(
        {"x": "Omega", "y": "N"},
        {"study": regions()},
        (
            Shown(1, "x", SPEED, SPEEDS[[0, -1]], "rad/s", "linear"),
            Shown(0, "y", LOAD, LOADS[[0, -1]], "N", "linear"),
            Shown(1, "y", LOAD, LOADS[[0, -1]], "N", "linear"),
            Shown(2, "bar", growth, RATES, "1/s"),
        ),
    )


def critical_speed() -> Example:
    critical = np.array([9.5, 11.25, 13.0])
    dims = ("N", "horizon", "crossing_number")
    data = {
        "critical_speed": (dims[:2], critical[:, None], column("critical_speed", "critical_speed")),
        "crossing": (dims, critical[:, None, None], column("critical_speed", "crossing")),
        "crossing_kind": flag(dims, np.full((3, 1, 1), "begins"), ("none", "begins", "ends")),
        "status": flag(("N",), ["ok"] * 3, ("ok", "failed")),
    }
    coords = over(N=LOADS) | {
        "horizon": [900.0],
        "crossing_number": [1],
        "scan_Omega": np.arange(8.0, 15.0),
    }
    return Example(
        {},
        {"study": xr.Dataset(data, coords, stated())},
        (
            Shown(0, "x", SPEED, critical, "rad/s", "linear"),
            Shown(0, "y", LOAD, LOADS, "N", "linear"),
        ),
    )


def basins() -> Example:
    shares = np.array([[1.0, 0.0], [0.25, 0.75], [0.5, 0.5]])  # quiet and separating
    ranges = np.array([2e-5, 0.031, 0.029])
    critical = np.array([0.4, 0.1, 0.2])
    classes = ["stick_slip", "separating"]
    energies = [0.01]
    data = {
        "basin_fraction": (("Omega", "attractor_class"), shares),
        "basin_fraction_by_energy": (("Omega", "energy", "attractor_class"), shares[:, None]),
        "attractor_kind": flag(
            ("Omega", "attractor"), [["stick_slip"], ["separating"], ["separating"]], LONG_TERM_OUTCOMES
        ),
        "attractor_starts": (("Omega", "attractor"), np.full((3, 1), 4)),
        "attractor_range": (
            ("Omega", "attractor"), ranges[:, None], column("basins", "attractor_range"),
        ),
        "critical_energy": ("Omega", critical, column("basins", "critical_energy")),
        "critical_energy_sampled": ("Omega", critical, column("basins", "critical_energy_sampled")),
        "status": flag(("Omega",), ["ok"] * 3, ("ok", "failed")),
    }  # fmt: skip
    everything = sorted({*classes, *map(str, LONG_TERM_OUTCOMES)})
    study = xr.Dataset(
        data,
        over(Omega=SPEEDS) | {"attractor_class": classes, "energy": energies},
        stated(horizon=60),
    )
    study = study.reindex(attractor_class=everything, fill_value=0.0)
    study = study.assign_coords(start=range(4))
    return Example(
        {"x": "Omega"},
        {"study": study},
        (
            Shown(0, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(0, "y", "Share of 4 starts", shares.ravel(), "", "linear"),
            Shown(1, "y", "Slider range", ranges, "m", "log"),
            Shown(2, "y", "Critical energy", critical, "J", "log"),
        ),
    )


def branches() -> Example:
    values = np.array([[8.0, 11.0, 14.5]])
    ranges = np.array([[2e-5, 4e-4, 2.5e-2]])
    data = {
        "status": ((), np.int8(0), OK),
        "n_branches": ((), 1),
        "separations": ("branch", [0]),
        "value": (("branch", "branch_point"), values),
        "range": (("branch", "branch_point"), ranges, column("branches", "range")),
        "growth_rate": (("branch", "branch_point"), [[-0.1, -0.1, -0.1]]),
        "sweep_range": (("sweep_direction", "sweep_value"), np.tile(ranges, (2, 1))),
        "sweep_separation_rate": (("sweep_direction", "sweep_value"), np.zeros((2, 3))),
        "sweep_settled": flag(
            ("sweep_direction", "sweep_value"), np.full((2, 3), "settled"), ("undecided", "settled")
        ),
        "sliding_growth_rate": ("sweep_value", [0.1, 0.1, 0.1]),
    }
    study = xr.Dataset(data, {"sweep_value": SPEEDS}, stated(parameter="Omega"))
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "x", SPEED, values, "rad/s", "linear"),
            Shown(0, "y", "Range of the slider's height", ranges, "m", "log"),
        ),
    )


def ramps() -> Example:
    rates = np.array([0.01, 0.1, 1.0])
    onset = np.array([15.2, 15.4, 16.1])
    end = [9.7, 9.6, 9.1]
    data = {
        "onset_speed": ("rate", onset, column("ramps", "onset_speed")),
        "offset_speed": ("rate", end, column("ramps", "offset_speed")),
        "top_separation_rate": ("rate", [135.0, 134.0, 133.0]),
        "rate_status": ("rate", np.zeros(3, np.int8), OK),
    }
    study = xr.Dataset(data, {"rate": ("rate", rates)}, stated(low=8.0, high=20.0))
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "x", "Ramp rate", rates, "rad/s²", "log"),
            Shown(0, "y", SPEED, [*onset, *end], "rad/s", "linear"),
        ),
    )


MOTIONS = ("undecided", "locked", "without_stick")


def staircase() -> Example:
    releases = np.array([34, 34, 35])
    separations = np.array([371, 371, 372])
    data = {
        "motion": flag(("Omega",), ["locked"] * 3, MOTIONS),
        "period_releases": ("Omega", releases),
        "period_separations": ("Omega", separations),
        "separations_per_release": ("Omega", separations / releases),
        "status": ("Omega", np.zeros(3, np.int8), OK),
    }
    study = xr.Dataset(data, over(Omega=SPEEDS), stated())
    return Example(
        {"x": "Omega"},
        {"study": study},
        (
            Shown(0, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(0, "y", "Separations per release", separations / releases, "", "linear"),
        ),
    )


def phase_map() -> Example:
    phase = np.array([0.70, 0.75, 0.80, 0.82, 0.84, 0.88])
    following = np.array([0.90, 0.88, 0.83, 0.80, 0.82, 0.86])
    data = {
        "map_phase": ("probe", phase),
        "map_next_phase": ("probe", following),
        "map_separations": ("probe", np.array([17.0, 17, 17, 2, 2, 2])),
        "map_slope": ("probe", np.full(6, 0.9)),
        "release_phase": ("release", np.array([0.80, 0.83, 0.81])),
    }
    study = xr.Dataset(data, {}, stated())
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "x", "Phase of a release", phase, ""),
            Shown(0, "y", "Phase of the next one", following, ""),
        ),
    )


def range_law() -> Example:
    dims = ("N", "begin")
    pinned = np.array([[4e-3, np.nan], [8e-3, 8e-3], [16e-3, 17e-3]])
    excess = np.array([[0.01, np.nan], [0.03, 0.12], [0.02, -0.3]])
    apart = np.array([[0.1, np.nan], [0.15, 0.3], [0.12, 0.2]])
    shares = np.array([[1.0, np.nan], [0.99, 0.97], [0.98, 0.6]])
    values = {
        "range": pinned * (1 + excess),
        "pinned_range": pinned,
        "deviation": excess,
        "separation_fraction": apart,
        "vibration_share": shares,
        "force_share": shares,
    }
    data: dict[str, Any] = {}
    for name, column_values in values.items():
        data[name] = (dims, column_values, column("range_law", name))
    data["status"] = ("N", np.zeros(3, np.int8), OK)
    study = xr.Dataset(data, over(N=LOADS) | {"begin": ["static", "displaced"]}, stated())
    law = "Range at which contact is lost, R = 2N/|k − mω²|"
    over_law = "Excess of the range over R"
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "x", law, pinned, "m", "log"),
            Shown(0, "y", over_law, excess, "", "linear"),
            Shown(1, "x", "Time apart", apart, "", "linear"),
            # what lies beyond the panel stands at its edge
            Shown(1, "y", over_law, np.maximum(excess, -0.25), "", "linear"),
        ),
    )


def late_range() -> Example:
    dims = ("Omega", "N", "contact", "disc")
    axes = {"contact": ["unilateral", "bilateral"], "disc": ["thin"]}
    tops = np.arange(1.0, 13.0).reshape(3, 2, 2, 1) * 1e-3
    data = {
        "outcome": flag(dims, np.full(tops.shape, "separation"), OUTCOMES_TO_HORIZON),
        "u_max": (dims, tops, attributes("u")),
        "u_min": (dims, -tops, attributes("u")),
    }
    study = xr.Dataset(data, over(Omega=SPEEDS, N=LOADS[:2]) | axes, stated())
    return Example(
        {"thickness": 0.004},
        {"study": study},
        (
            Shown(0, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(0, "y", "Slider, peak to peak (thicknesses)", 2 * tops / 0.004, "", "log"),
        ),
    )


def escape() -> Example:
    dims = ("N", "perturbation_u")
    times = np.array([[12.0, np.nan, 8.0, 20.0], [np.nan, np.nan, np.nan, 25.0]])
    data = {
        "status": (dims, np.zeros(times.shape, np.int8), OK),
        "first_separation": (dims, times, attributes("first_separation")),
    }
    axes = over(N=LOADS[:2]) | {"perturbation_u": 1e-9 * np.arange(4)}
    study = xr.Dataset(data, axes, stated(horizon=30.0))
    return Example(
        {"starts": "perturbation_u"},
        {"study": study},
        (
            Shown(0, "x", "Time", [0.0, 8, 12, 20, 30, 0, 25, 30], "s", "linear"),
            Shown(
                0,
                "y",
                "Share of starts that have separated",
                [0.0, 0.25, 0.5, 0.75, 0.75, 0, 0.25, 0.25],
                "",
                "linear",
            ),
        ),
    )


def bifurcation() -> Example:
    psi = np.array([[0.040, 0.061], [0.043, 0.066], [0.045, 0.071]])
    phases = ("none", "stick", "slip", "separation")
    exponents = np.array([[-0.11, -0.12, -0.02]])
    data = {
        "psi": (("Omega", "sample"), psi, attributes("psi")),
        "phase": flag(("Omega", "sample"), np.full((3, 2), "slip"), phases),
        "settled": flag(("Omega",), ["settled"] * 3, ("undecided", "settled")),
        "kind": flag(("Omega",), ["separating"] * 3, LONG_TERM_OUTCOMES),
        "period_events": ("Omega", [1, 2, 5]),
        "status": flag(("Omega",), ["ok"] * 3, ("ok", "failed")),
    }
    study = xr.Dataset(data, over(Omega=SPEEDS), stated(section="stroboscopic"))
    numbers = {
        "exponent": (("exponent_number", "Omega"), exponents, column("lyapunov", "exponent")),
        "exponent_error": (("exponent_number", "Omega"), 0 * exponents + 0.001),
        "converged": flag(("exponent_number", "Omega"), [["yes"] * 3], ("unknown", "no", "yes")),
        "status": flag(("Omega",), ["ok"] * 3, ("ok", "failed")),
    }
    exponent_study = xr.Dataset(numbers, over(Omega=SPEEDS), stated())
    return Example(
        {"x": "Omega", "overlays": {"lyapunov": "l"}},
        {"study": study, "lyapunov": exponent_study},
        (
            Shown(0, "y", "Angle ψ once per turn of the drive", psi, "rad", "linear"),
            Shown(1, "y", "Events in a period", [1, 2, 5], "", "log"),
            Shown(2, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(
                2, "y", "Lyapunov exponents, without the trivial one", exponents, "1/s", "linear"
            ),
        ),
    )


def sensitivity() -> Example:
    from tests.studies.quantities.test_sensitivity import made_up

    study = made_up()
    words = study["cycle"].attrs["flag_meanings"].split()
    study["cycle"] = study["cycle"].copy(
        data=np.full(study["cycle"].shape, words.index("unstable"))
    )
    return Example({}, {"study": study}, (Shown(-1, "x", "P(unstable)", [1.0], "", "linear"),))


def campbell() -> Example:
    study = computed(
        quantity="campbell",
        options={},
        base={"N": 200, "n_diameters": 1},
        axes={"Omega": {"start": 9, "stop": 11, "count": 3}},
    )
    return Example(
        {},
        {"study": study},
        (
            Shown(
                0,
                "y",
                "Frequency in the slider's frame",
                study["sliding_frequency"],
                "Hz",
                "linear",
            ),
            Shown(1, "x", SPEED, study["Omega"], "rad/s", "linear"),
            Shown(
                1, "y", "Largest growth rate of the cycle", study["growth_rate"], "1/s", "linear"
            ),
        ),
    )


def sliding(parameter: str = "c_p") -> xr.Dataset:
    return computed(
        quantity="sliding",
        options={"parameter": parameter, "scan": {"start": 0, "stop": 0.4, "count": 5}},
        base={"Omega": 20, "n_diameters": 1, "N": 200},
        axes=ONE,
    )


def sliding_modes() -> Example:
    study = sliding()
    top = float(study["largest_growth_rate"].max())
    rates = study["mode_growth_rate"]
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "y", "Frequency in the slider's frame", study["frequency"], "Hz", "linear"),
            Shown(1, "x", "In-plane damper c_p", study["value"], "N s/m", "linear"),
            Shown(1, "y", "Growth rate", rates.where(abs(rates) < top), "1/s", "linear"),
        ),
    )


def sliding_outcome() -> Example:
    study = computed(
        quantity="sliding",
        options={"parameter": "c_p", "scan": {"start": 0, "stop": 0.4, "count": 5}},
        base={"Omega": 20, "n_diameters": 1},
        axes={"N": [200, 400]},
    )
    damping = study["value"].values
    words = np.full((2, damping.size), "separation")
    plane = xr.Dataset(
        {"outcome": flag(("N", "c_p"), words, OUTCOMES_TO_HORIZON)},
        over(N=[200.0, 400.0], c_p=damping),
        study.attrs | {"options": json.dumps({"horizon": 600})},
    )
    return Example(
        {"x": "c_p", "y": "N", "overlays": {"sliding": "s"}},
        {"study": plane, "sliding": study},
        (
            Shown(0, "x", "In-plane damper c_p", damping[[0, -1]], "N s/m", "linear"),
            Shown(0, "y", LOAD, [200.0, 400.0], "N", "linear"),
        ),
    )


EXAMPLES: dict[str, Callable[[], Example]] = {
    function.__name__: function
    for function in (
        heat_map,
        curve,
        history,
        poincare,
        portrait,
        spectrum,
        spectrogram,
        region_map,
        critical_speed,
        basins,
        branches,
        ramps,
        staircase,
        phase_map,
        range_law,
        late_range,
        escape,
        bifurcation,
        sensitivity,
        campbell,
        sliding_modes,
        sliding_outcome,
    )
}
