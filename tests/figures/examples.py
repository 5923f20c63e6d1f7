"""Small studies and cases for every kind of figure, and what each of its axes has to show.

Words and units are written by hand, values are taken from the data in SI units: a test converts
them by the unit in the label.
"""

import functools
from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr

from disc_model import Parameters, Poincare, Window, run_study, simulate
from disc_model.data.variables import WORDS, attributes
from disc_model.studies.quantity import QUANTITIES, found, quantity_of
from tests.figures.measured import Shown

CLASSES = (*WORDS["long_term"][1:], WORDS["long_term"][0])

RECORDED = {
    "history": Window(stop=60, rate=200, envelope=100, theta=0.5),
    "zoom": Window(start=56, stop=56.035, rate=1e5, theta=0.5),
    "spectrum_a": Window(start=0, stop=3, rate=4e3, theta=0.5),
    "orbit": Window(start=59, rate=5e3, theta=0.5),
    "poincare": Poincare(theta=0.5),
}
SPEED = "Speed Ω"
LOAD = "Preload N"
DAMPER = "In-plane damper c_p"
GROWTH = "Growth rate of the cycle"
SPEEDS = [8.0, 11.0, 14.5]  # rad/s
LOADS = [120.0, 310.0, 475.0]  # N
ONE = {"normalization": ["as_published"]}


@functools.cache
def simulated(separates: bool) -> xr.DataTree:
    """A minute with windows; contact is first lost at 54.4 s, or never."""
    Omega = 15.1 if separates else 15.0
    return simulate(Parameters(N=385, Omega=Omega), 60, RECORDED).to_tree()


class Example(NamedTuple):
    """A figure as a file asks for it, what it is drawn from, what its axes have to show, and what
    legend and titles have to say."""

    phrase: Mapping[str, Any]
    inputs: Mapping[str, xr.Dataset | xr.DataTree]
    shown: tuple[Shown, ...] = ()
    said: tuple[str, ...] = ()


def computed(**raw: Any) -> xr.Dataset:
    """A small study, computed."""
    study = run_study({"study": "small", **raw})
    assert isinstance(study, xr.Dataset)
    return study


def study_of(
    quantity: str,
    axes: Mapping[str, Any],
    columns: Mapping[str, Any],
    own: Mapping[str, Any] = MappingProxyType({}),
    **raw: Any,
) -> xr.Dataset:
    """A study of a quantity, of which values are given in place of what it computes.

    columns : shapes are those of the axes, and of dimensions of the quantity's own; flags are words
    own : values along these; else they are numbered
    raw : what a study file says beside
    """
    known = quantity_of(quantity)
    values = {"status": np.full([len(along) for along in axes.values()], "ok"), **columns}
    arrays = {name: np.asarray(column) for name, column in values.items()}
    along = dict(own)
    for column in known.columns.values():
        along.update((dim, [0]) for dim in column.dims if dim not in along)
    for name, array in arrays.items():
        sizes = zip(known.columns[name].dims, array.shape[len(axes) :], strict=True)
        along.update((dim, range(size)) for dim, size in sizes if dim not in own)

    def at(*place: int) -> xr.Dataset:
        cells = {name: array[(*place, ...)].tolist() for name, array in arrays.items()}
        return found(quantity, cells, **along)

    def result(case: Parameters, **options: Any) -> xr.Dataset:
        kicks = dict(options["start"]) if "start" in options else {}
        place = []
        for name, values in axes.items():
            value = getattr(case, name, kicks.get(name.removeprefix("perturbation_"), 0))
            place.append([*values].index(value) if len(values) > 1 else 0)
        return at(*place)

    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(QUANTITIES, quantity, replace(known, function=result))
        return computed(quantity=quantity, axes=dict(axes), **{"options": {}, **raw})


# ---- General kinds

PERIODS = np.array([[0.0148, 0.0151, 0.0153], [0.0161, 0.0164, 0.0172]])  # s
DAMPERS = [0.02, 0.05, 0.08]  # N s/m
SPRINGS = [2e4, 5e4]  # N/m


def periods() -> xr.Dataset:
    axes = {"k_p": SPRINGS, "c_p": DAMPERS}
    columns = {"status": np.full((2, 3), "ok"), "period": PERIODS}
    return study_of("floquet", axes, columns, base={"N": 200, "Omega": 15})


def heat_map() -> Example:
    return Example(
        {"variable": "period", "x": "c_p", "y": "k_p"},
        {"study": periods()},
        (
            Shown(0, "x", DAMPER, [0.02, 0.08], "N s/m", "linear"),
            Shown(0, "y", "In-plane spring k_p", SPRINGS, "N/m", "linear"),
            Shown(1, "bar", "Period of the cycle", PERIODS, "s"),
        ),
    )


def curve() -> Example:
    return Example(
        {"variable": "period", "x": "c_p", "by": "k_p"},
        {"study": periods()},
        (
            Shown(0, "x", DAMPER, DAMPERS, "N s/m", "linear"),
            Shown(0, "y", "Period of the cycle", PERIODS, "s", "linear"),
        ),
        ("k_p = 20 kN/m", "k_p = 50 kN/m"),
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
        "w_point": ("Disc at r_0, θ = 0.5 rad", "m"),
        "w_point_velocity": ("Disc velocity at r_0, θ = 0.5 rad", "m/s"),
        "psi": ("Angle ψ", "rad"),
        "psi_velocity": ("dψ/dt", "rad/s"),
    }
    shown = [
        Shown(i, "y", words, samples("zoom", name)[::50], unit, "linear")
        for i, (name, (words, unit)) in enumerate(labels.items())
    ]
    time = Shown(len(labels) - 1, "x", "Time", samples("zoom", "time")[::50], "s", "linear")
    phrase = {"case": "A", "window": "zoom", "variables": [*labels]}
    return Example(phrase, {"A": simulated(True)}, (*shown, time), ("stick", "separation"))


def poincare() -> Example:
    where = ", θ = 0.5 rad"
    disc = samples("poincare", "w_point"), samples("poincare", "w_point_velocity")
    return Example(
        {"case": "A"},
        {"A": simulated(True)},
        (
            Shown(0, "x", "Angle ψ", samples("poincare", "psi"), "rad"),
            Shown(0, "y", "dψ/dt", samples("poincare", "psi_velocity"), "rad/s"),
            Shown(1, "x", f"Disc at r_0{where}", disc[0], "m"),
            Shown(1, "y", f"Disc velocity at r_0{where}", disc[1], "m/s"),
        ),
        ("first separation at 54.4", "thickness h = 2 mm", "before the first separation"),
    )


def portrait() -> Example:
    return Example(
        {"case": "A", "window": "orbit", "x": "u", "y": "psi_velocity"},
        {"A": simulated(True)},
        (
            Shown(0, "x", "Slider u", samples("orbit", "u")[::20], "m"),
            Shown(0, "y", "dψ/dt", samples("orbit", "psi_velocity")[::20], "rad/s"),
        ),
        ("slip", "stick", "separation"),
    )


TONE = 70.0  # Hz
SIZE = 2e-3  # m


def vibration() -> xr.DataTree:
    """A window in which the disc vibrates at one frequency."""
    time = np.arange(0, 4, 1 / 2000)
    window = simulated(True)["spectrum_a"].to_dataset().isel(time=slice(time.size))
    vibrating = ("time", SIZE * np.sin(2 * np.pi * TONE * time), attributes("w"))
    window = window.assign_coords(time=time).assign(w=vibrating)
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


# ---- Kinds of planes of two parameters

WIDE = [8.0, 10.0, 12.0, 14.0, 16.0]  # rad/s
RATES = np.array(
    [[-0.2, -0.2, -0.1, 0.1, 0.2], [-0.2, -0.1, -0.1, 0.1, np.nan], [-0.2, -0.1, -0.1, 0.2, 0.25]]
)


def regions() -> xr.Dataset:
    shape = (*RATES.shape, 1)
    words = np.full(shape, "separation", dtype=object)
    words[:, :3] = "stick_slip"
    words[1, 3] = "growing"
    cycle = np.where(np.isfinite(RATES), "followed", "no_cycle").reshape(shape)
    columns = {"outcome": words, "cycle": cycle, "growth_rate": RATES[..., None]}
    axes = {"N": LOADS, "Omega": WIDE, **ONE}
    return study_of("regions", axes, columns, options={"horizon": 900})


BORDER = np.array([12.9, 13.0, 13.1])  # rad/s
FOLD = np.array([15.0, 15.2, 15.4])


def curves() -> xr.Dataset:
    """A neutral curve, and a fold."""
    columns = {
        "kind": [["neutral", "fold"]],
        "x": [[BORDER, FOLD]],
        "y": [[LOADS, LOADS]],
        "adjoins_stable_cycle": np.full((1, 2, 3), "yes"),
    }
    lines = [{"start": 100, "stop": 500, "count": 3}]
    options = {"x": "Omega", "y": "N", "bounds": [5, 20], "lines": lines}
    return study_of("neutral_curves", ONE, columns, options=options)


def region_map() -> Example:
    mark = {"x": 15.5, "y": 400, "paper_outcome": "separation"}
    return Example(
        {"x": "Omega", "y": "N", "marks": {"Case A": mark}, "overlays": {"curves": "c"}},
        {"study": regions(), "curves": curves()},
        (
            Shown(0, "x", SPEED, [*WIDE, 15.5], "rad/s", "linear"),
            Shown(0, "y", LOAD, [LOADS[0], LOADS[-1], 400], "N", "linear"),
            Shown(1, "x", SPEED, [WIDE[0], WIDE[-1], *BORDER], "rad/s", "linear"),
            Shown(2, "bar", GROWTH, RATES, "1/s"),
        ),
        (
            "outcome within 900 s",
            "stick-slip, small",
            "growing, in contact",
            "separation",
            "no cycle found",
            "cycle loses stability",
            "paper: separation",
        ),
    )


def sliding_outcome() -> Example:
    study = computed(
        quantity="sliding_modes",
        options={"name": "c_p", "bounds": [0, 0.4], "step": 0.1},
        base={"Omega": 20, "n_diameters": 1},
        axes={"N": [200, 400]},
    )
    damping = study["value"].values.tolist()
    words = np.full((2, 5), "separation", dtype=object)
    words[0] = "stick_slip"
    axes = {"N": [200.0, 400.0], "c_p": damping}
    base = {"Omega": 20, "n_diameters": 1}
    plane = study_of("outcome", axes, {"outcome": words}, base=base, options={"horizon": 600})
    stable = float((study["largest_growth_rate"] <= 1e-9).sel(N=400).mean()) / 2
    return Example(
        {"x": "c_p", "y": "N", "overlays": {"sliding": "s"}},
        {"study": plane, "sliding": study},
        (
            Shown(0, "x", DAMPER, [damping[0], damping[-1]], "N s/m", "linear"),
            Shown(0, "y", LOAD, [200.0, 400.0], "N", "linear"),
        ),
        ("outcome within 600 s", f"sliding unstable, separating: {100 * (0.5 - stable):.0f} %"),
    )


# ---- Where separation begins


def critical_speed() -> Example:
    critical = np.array([9.5, 11.25, 13.0])
    crossings = np.array([[9.5, 10.1], [11.25, 12.0], [13.0, 13.9]])
    columns = {
        "critical_speed": critical[:, None, None],
        "crossing": crossings[:, None, None],
        "crossing_kind": np.full((3, 1, 1, 2), "begins"),
    }
    scan = {"bounds": [8, 16], "step": 1}
    axes = {"N": LOADS, **ONE}
    options = {"horizon": [900], **scan}
    own = {"horizon": [900.0], "scan_Omega": np.arange(8.0, 17)}
    onset = np.array([10.0, 12.0, 14.0])
    offset = np.array([8.5, 9.0, 12.5])
    hysteresis = {
        "onset_speed": onset[:, None],
        "offset_speed": offset[:, None],
        "sweep_settled": np.full((3, 1, 2, 9), "settled"),
        "separation_rate": np.zeros((3, 1, 2, 9)),
    }
    both = {"direction": ["up", "down"], "sweep_Omega": np.arange(8.0, 17)}
    sweep = study_of("hysteresis", axes, hysteresis, both, options={**scan, "dwell": 60})
    return Example(
        {
            "overlays": dict.fromkeys(["hysteresis", "cycle", "curves", "basins"], "s"),
            "paper_points": {"P": [310, 12.6]},
        },
        {
            "study": study_of("critical_speed", axes, columns, own, options=options),
            "hysteresis": sweep,
            "cycle": regions(),
            "curves": curves(),
            "basins": starts(),
        },
        (
            Shown(0, "x", SPEED, [*crossings.ravel(), 12.6, *BORDER], "rad/s", "linear"),
            Shown(0, "y", LOAD, LOADS, "N", "linear"),
            Shown(
                1, "x", SPEED, [*crossings.ravel(), *onset, *offset, 11.0, 14.5], "rad/s", "linear"
            ),
        ),
        (
            "from the static start, within 900 s",
            "sweeps in steps of 1 rad/s",
            "cycle loses stability",
        ),
    )


ONSETS = np.array([15.2, 15.4, 16.1])  # rad/s
ENDS = np.array([9.7, 9.6, np.nan])


def ramps() -> Example:
    rates = {"start": 0.01, "stop": 1, "count": 3, "scale": "log"}
    columns = {
        "rate_status": [["ok"] * 3],
        "onset_speed": [ONSETS],
        "offset_speed": [ENDS],
        "top_separation_rate": [[135.0, 134.0, 133.0]],
    }
    options = {"bounds": [8, 20], "rates": rates, "dwell": 60}
    own = {"rate": [0.01, 0.1, 1.0]}
    study = study_of("ramps", ONE, columns, own, options=options, base={"N": 310})
    return Example(
        {"overlays": {"curves": "c"}},
        {"study": study, "curves": curves()},
        (
            Shown(0, "x", "Rate of the speed's ramps", [0.01, 0.1, 1], "rad/s²", "log"),
            Shown(0, "y", SPEED, [*ONSETS, *ENDS, FOLD[1]], "rad/s", "linear"),
        ),
        (
            "rising: separation begins",
            "falling, 8 to 20 rad/s: there is no separation on the way down, or it continues",
            "stable cycle ends (fold), 15.20",
        ),
    )


# ---- Motions with separation

TIMES = np.array([[12.0, np.nan, 8.0, 20.0], [np.nan, np.nan, np.nan, 25.0]])  # s


def escape() -> Example:
    words = np.where(np.isnan(TIMES), "undecided", "separation")
    axes = {"N": LOADS[:2], "perturbation_u": [0, 1e-9, 2e-9, 3e-9]}
    columns = {"outcome": words, "first_separation": TIMES}
    study = study_of("outcome", axes, columns, base={"Omega": 15}, options={"horizon": 30})
    return Example(
        {"starts": "perturbation_u"},
        {"study": study},
        (
            Shown(0, "x", "Time", [0, 8, 12, 20, 25, 30], "s", "linear"),
            Shown(0, "y", "Share of starts that separated", [0, 0.25, 0.5, 0.75], "", "linear"),
        ),
        ("N = 120 N: 3 of 4 starts", "N = 310 N: 1 of 4 starts", "95 % confidence"),
    )


DISC = {
    "omega": [1000.0, 3000.0],
    "diameters": [0, 2],
    "amplitude": [1.5, 1.2],
    "damping_ratio": [1e-3, 1e-3],
    "tangential": [0.0, 0.3],
}


def late_range() -> Example:
    tops = np.arange(1.0, 13.0).reshape(3, 2, 2, 1) * 1e-3
    speeds = tops / 0.01
    axes = {
        "Omega": SPEEDS,
        "N": LOADS[:2],
        "contact": ["unilateral", "bilateral"],
        "disc": ["thin"],
    }
    columns = {
        "outcome": np.full(tops.shape, "separation"),
        "u_max": tops,
        "u_min": -tops,
        "surface_speed": speeds,
    }
    study = study_of("outcome", axes, columns, discs={"thin": DISC}, options={"horizon": 60})
    # in the frequency of the mode that friction feeds, by the usual k = 50 kN/m and m = 0.1 kg
    lost = [2 * N / abs(5e4 - 0.1 * 3000**2) for N in LOADS[:2]]
    return Example(
        {"thickness": 0.004},
        {"study": study},
        (
            Shown(0, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(
                0,
                "y",
                "Range of the slider's height",
                [*2 * tops.ravel(), *lost, 0.004],
                "m",
                "log",
            ),
            Shown(1, "y", "Relative speed of the disc's surface", speeds, "", "linear"),
        ),
        ("N = 120 N", "ringed: separating", "dashed: separation ignored, 1.1 to 2 times the range"),
    )


def range_law() -> Example:
    pinned = np.array([[4e-3, np.nan], [8e-3, 8e-3], [16e-3, 17e-3]])
    excess = np.array([[0.01, np.nan], [0.03, 0.12], [0.02, -0.3]])
    apart = np.array([[0.1, np.nan], [0.15, 0.3], [0.12, 0.2]])
    shares = np.array([[1.0, np.nan], [0.99, 0.97], [0.98, 0.6]])
    columns = {
        "range": pinned * (1 + excess),
        "pinned_range": pinned,
        "deviation": excess,
        "separation_fraction": apart,
        "vibration_share": shares,
        "force_share": shares,
    }
    own = {"begin": ["static", "displaced"]}
    study = study_of("range_law", {"N": LOADS}, columns, own, base={"Omega": 20})
    law = "Range at which contact is lost, R = 2N/|k − mω²|"
    over_law = "Excess of the range over R"
    within = np.clip(excess, -0.25, 0.35)  # what lies beyond the panel stands at its edge
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "x", law, pinned, "m", "log"),
            Shown(0, "y", over_law, excess, "", "linear"),
            Shown(1, "x", "Share of time apart", apart, "", "linear"),
            Shown(1, "y", over_law, within, "", "linear"),
        ),
        ("within 5 %: 3 of 4 filled, 0 of 1 hollow",),
    )


# ---- Motions over a parameter


def bifurcation() -> Example:
    psi = np.array([[0.040, 0.061], [0.043, 0.066], [0.045, 0.071]])
    exponents = np.array([[-0.11], [-0.12], [-0.02]])
    columns = {
        "psi": psi,
        "phase": np.full((3, 2), "separation"),
        "settled": ["settled", "settled", "undecided"],
        "kind": ["separating", "separating", "undecided"],
        "period_events": [1, 2, 0],
    }
    options = {"samples": 2, "transient": 9, "max_transient": 90}
    numbers = {
        "exponent": exponents,
        "exponent_error": 0 * exponents + 0.001,
        "converged": [["yes"], ["yes"], ["no"]],
    }
    axes = {"Omega": SPEEDS}
    study = study_of("bifurcation", axes, columns, options=options, base={"N": 385})
    other = study_of(
        "lyapunov_exponents",
        axes,
        numbers,
        options={"duration": 9, "transient": 9},
        base={"N": 385},
    )
    places = {"Fig. 13": 13.5}
    ends = [*(exponents - 0.004), *(exponents + 0.004)]
    return Example(
        {"x": "Omega", "overlays": {"lyapunov": "l"}, "paper_cases": places},
        {"study": study, "lyapunov": other},
        (
            Shown(0, "y", "Angle ψ", psi, "rad", "linear"),
            Shown(0, "x", SPEED, [*SPEEDS, 13.5], "rad/s", "linear"),
            Shown(1, "y", "Events in a period", [1, 2], "", "log"),
            Shown(2, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(2, "y", "Lyapunov exponent", [*exponents, *ends], "1/s", "linear"),
        ),
        ("hollow: not settled in 90 s", "not shown to repeat", "not converged", "undecided"),
    )


def branches() -> Example:
    values = np.array([8.0, 11.0, 14.5])
    ranges = np.array([2e-5, 4e-4, 2.5e-2])
    columns = {
        "n_branches": [1],
        "separations": [[0]],
        "value": [[values]],
        "range": [[ranges]],
        "growth_rate": [[[-0.1, -0.1, -0.1]]],
        "sweep_range": [[ranges, ranges]],
        "sweep_separation_rate": np.zeros((1, 2, 3)),
        "sweep_settled": np.full((1, 2, 3), "settled"),
        "sliding_growth_rate": [[0.1, 0.1, 0.1]],
    }
    options = {"bounds": [8, 14], "step": 3, "dwell": 9}
    own = {"direction": ["up", "down"], "sweep_value": [8.0, 11.0, 14.0]}
    study = study_of("branches", ONE, columns, own, options=options, base={"N": 385})
    return Example(
        {"paper_cases": {"Fig. 11": 13}},
        {"study": study},
        (
            Shown(0, "x", SPEED, [*values, 14, 13], "rad/s", "linear"),
            Shown(0, "y", "Range of the slider's height", ranges, "m", "symlog"),
        ),
        (
            "cycle in contact: stable",
            "steady sliding: unstable",
            "simulated, rising",
            "simulated, falling",
        ),
    )


ENERGIES = [0.01, 0.5]  # J


def starts() -> xr.Dataset:
    """Four starts at each of three speeds and two energies, two attractors, and critical energies."""
    kinds = np.full((3, 2, 4), "stick_slip", dtype=object)
    kinds[1:, 1, :3] = "separating"
    kinds[2, 0] = "separating"
    ranges = np.array([[2e-5, np.nan], [3e-5, 0.031], [np.nan, 0.029]])
    separating = (kinds == "separating").mean((1, 2))
    small, apart = map(CLASSES.index, ("stick_slip", "separating"))
    shares = np.zeros((3, len(CLASSES)))
    shares[:, small], shares[:, apart] = 1 - separating, separating
    by_energy = np.zeros((3, 2, len(CLASSES)))
    by_energy[..., apart] = (kinds == "separating").mean(2)
    columns = {
        "kind": kinds,
        "lost_contact": np.where(kinds == "separating", "yes", "no"),
        "basin_fraction_by_energy_low": by_energy / 2,
        "basin_fraction_by_energy_high": (1 + by_energy) / 2,
        "basin_fraction": shares,
        "basin_fraction_low": shares / 2,
        "separating_fraction_low": separating / 2,
        "attractor_kind": [
            ["stick_slip", "none"],
            ["stick_slip", "separating"],
            ["none", "separating"],
        ],
        "attractor_starts": [[8, 0], [5, 3], [0, 7]],
        "attractor_range": ranges,
        "critical_energy": CRITICAL,
        "critical_energy_sampled": [np.nan, 0.5, 0.01],
    }
    options = {"energies": ENERGIES, "n_starts": 4, "horizon": 60}
    own = {"energy": ENERGIES, "attractor_class": CLASSES, "attractor": [1, 2]}
    axes = {"Omega": SPEEDS}
    return study_of("basins", axes, columns, own, options=options, base={"N": 385})


CRITICAL = np.array([np.nan, 0.2, 0.005])  # J


def basins() -> Example:
    return Example(
        {"x": "Omega"},
        {"study": starts()},
        (
            Shown(0, "y", "Share of 4 starts, within 60 s", [0, 1, 0.5], "", "linear"),
            Shown(1, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(1, "y", "", [0, 0.75, 0.375, 0.875], "", "linear"),
            Shown(2, "x", SPEED, SPEEDS, "rad/s", "linear"),
            Shown(2, "y", "Height range on the attractor", [2e-5, 3e-5, 0.031, 0.029], "m", "log"),
            Shown(3, "y", "Critical energy", [*CRITICAL, *ENERGIES], "J", "symlog"),
        ),
        (
            "Energy = 0.01 J",
            "Energy = 0.5 J",
            "95 % interval: separating",
            "no start is known to separate",
        ),
    )


RELEASES = np.array([34, 34, 35])
SEPARATIONS = np.array([371, 371, 372])


def staircase() -> Example:
    heights = SEPARATIONS / RELEASES
    columns = {
        "motion": ["locked"] * 3,
        "period_releases": RELEASES,
        "period_separations": SEPARATIONS,
        "separations_per_release": heights,
    }
    study = study_of("locking", {"Omega": SPEEDS}, columns, base={"N": 200})
    apart = study_of("locking", {"Omega": [9.0]}, {"motion": ["without_stick"]}, base={"N": 200})
    return Example(
        {"x": "Omega", "zooms": [[7, 12]], "overlays": {"slipping": "s"}},
        {"study": study, "slipping": apart},
        (
            Shown(0, "x", SPEED, [*SPEEDS, 9.0], "rad/s", "linear"),
            Shown(0, "y", "Separations per release of stick", heights, "", "linear"),
            Shown(1, "x", SPEED, SPEEDS[:2], "rad/s", "linear"),
        ),
        ("numbers: releases in a period", "a motion that never sticks exists beside"),
    )


def phase_map() -> Example:
    phase = np.array([0.70, 0.75, 0.80, 0.82, 0.84, 0.88])
    following = np.array([0.90, 0.88, 0.83, 0.80, 0.82, 0.86])
    own = np.array([0.80, 0.83, 0.81])
    columns = {
        "map_phase": [phase],
        "map_next_phase": [following],
        "map_separations": [[17.0, 17, 17, 2, 2, 2]],
        "map_slope": [np.full(6, 0.9)],
        "release_phase": [own],
        "period_releases": [3],
    }
    options = {"probes": 6}
    study = study_of("locking", {"Omega": [19.9]}, columns, options=options, base={"N": 200})
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "x", "Phase of a release", phase),
            Shown(0, "y", "Phase of the next one", following),
            Shown(1, "x", "Phase of a release", [*phase, *own[:-1]]),
            Shown(1, "y", "Phase of the next one", [*following, *own[1:]]),
        ),
        ("motion itself: repeats after 3 releases",),
    )


# ---- Uncertain parameters


UNIFORM = {"distribution": "uniform", "low": 0.9, "high": 1.1, "relative": True}


def made_up() -> xr.Dataset:
    """Samples at two points, without the engine: cycles are unstable where the spring is stiff."""

    def evaluate(case: Parameters, tol: float, row: dict[str, Any]) -> str:
        row["cycle"] = "unstable" if case.k > 5e4 else "stable"
        row["growth_rate"] = case.k - 5e4
        return ""

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("disc_model.studies.quantities.sensitivity.evaluate_cycle", evaluate)
        options = {"distributions": {"k": UNIFORM, "mu_s": UNIFORM}, "samples": 64, "seed": 3}
        axes = {"N": [200, 385]}
        return computed(quantity="sensitivity", options=options, axes=axes, base={"Omega": 15})


def sensitivity() -> Example:
    """Cycles are unstable where the spring is stiff: in none of its lowest third of values, and in
    all of its highest."""
    name = "Probability of instability"
    shown = [Shown(i, "x", name, [0.0, 0.5, 1.0], "", "linear") for i in range(2)]
    words = ("N = 200 N", "N = 385 N", "all 64 samples", "lowest third of its values")
    return Example({}, {"study": made_up()}, tuple(shown), words)


# ---- Modes


def campbell() -> Example:
    study = computed(
        quantity="campbell",
        options={"bounds": [9, 11], "step": 1},
        base={"N": 200, "n_diameters": 1},
        axes=ONE,
    )
    study = study.isel(normalization=0)
    slips = 2 * study["stick_slip_frequency"]
    frequencies = [*study["sliding_frequency"].values.ravel(), *slips.values]
    return Example(
        {"multiples": [2]},
        {"study": study},
        (
            Shown(0, "y", "Frequency in steady sliding", frequencies, "Hz", "linear"),
            Shown(1, "x", SPEED, study["Omega"], "rad/s", "linear"),
            Shown(1, "y", GROWTH, study["growth_rate"], "1/s"),
        ),
        ("mode that grows", "2 $f_s$"),
    )


def sliding_modes() -> Example:
    study = computed(
        quantity="sliding_modes",
        options={"name": "c_p", "bounds": [0, 0.4], "step": 0.1},
        base={"Omega": 20, "n_diameters": 1, "N": 200},
        axes=ONE,
    )
    return Example(
        {},
        {"study": study},
        (
            Shown(0, "y", "Frequency of the mode", study["frequency"], "Hz", "linear"),
            Shown(1, "x", DAMPER, study["value"], "N s/m", "linear"),
            Shown(1, "y", "Growth rate of the mode", study["mode_growth_rate"], "1/s"),
        ),
        ("mode that grows",),
    )


KINDS_OF_CASES = (history, poincare, portrait, spectrum)
KINDS_OF_STUDIES = (
    heat_map,
    curve,
    region_map,
    sliding_outcome,
    critical_speed,
    ramps,
    escape,
    late_range,
    range_law,
    bifurcation,
    branches,
    basins,
    staircase,
    phase_map,
    sensitivity,
    campbell,
    sliding_modes,
)
EXAMPLES: dict[str, Callable[[], Example]] = {
    each.__name__: functools.cache(each) for each in (*KINDS_OF_CASES, *KINDS_OF_STUDIES)
}
