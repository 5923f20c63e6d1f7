"""Made-up studies in which each mark, colour and class occurs, and their figures."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from disc_model.analysis.classify import ANSWER
from disc_model.data.variables import (
    LONG_TERM_OUTCOMES,
    OUTCOMES_TO_HORIZON,
    PHASES,
    STATUSES,
    attributes,
)
from disc_model.figures.kinds import kind_of
from disc_model.figures.render import render
from disc_model.studies.quantities.campbell import EFFECTS, KINDS, LINES
from tests.figures import every_kind
from tests.figures.every_kind import column, flag, over, stated
from tests.figures.reading import draw

NAN = np.nan
SEED = 3
"""Of made-up numbers that differ from each other."""


def status(dims: tuple[str, ...], words: Any) -> tuple[Any, ...]:
    return flag(dims, words, STATUSES)


# ---- Motions over one parameter


def bifurcation(section: str = "stroboscopic", width: str = "page") -> Figure:
    """Seven speeds: two settled, one not, one that slides, one without events, one failed."""
    speeds = np.array([8.0, 9.0, 10.0, 11.0, 12.0, 13.0])
    words = [
        ["stick", "slip"],
        ["slip", "separation"],
        ["stick", "separation"],
        ["none", "none"],
        ["none", "none"],
        ["slip", "slip"],
    ]
    psi = np.array([[0.040, 0.061], [0.043, 0.066], [0.045, 0.071], *[[NAN, NAN]] * 2, [0.5, 0.5]])
    settled = ["settled", "settled", "undecided", "settled", "settled", "settled"]
    kinds = ["separating", "separating", "undecided", "steady_sliding", "at_rest", "failed"]
    data = {
        "psi": (("Omega", "sample"), psi, attributes("psi")),
        "phase": flag(("Omega", "sample"), words, ("none", *PHASES)),
        "settled": flag(("Omega",), settled, ANSWER.flags),
        "kind": flag(("Omega",), kinds, LONG_TERM_OUTCOMES),
        "period_events": ("Omega", [1, 5, 0, 0, 0, 0]),
        "status": status(("Omega",), ["ok"] * 5 + ["failed"]),
    }
    study = xr.Dataset(data, over(Omega=speeds), stated(section=section))
    exponents = np.array([[-0.11, -0.12, 0.4, 0.41, NAN, 0.3], [-0.2, -0.3, -0.4, -0.5, NAN, -0.1]])
    converged = [["yes", "no", "yes", "yes", "unknown", "yes"], ["no"] * 6]
    numbers = {
        "exponent": (("exponent_number", "Omega"), exponents, column("lyapunov", "exponent")),
        "exponent_error": (("exponent_number", "Omega"), 0.05 * np.abs(exponents)),
        "converged": flag(("exponent_number", "Omega"), converged, ("unknown", "no", "yes")),
        "status": status(("Omega",), ["ok"] * 5 + ["failed"]),
    }
    lyapunov = xr.Dataset(numbers, over(Omega=speeds), stated())
    phrase = {"x": "Omega", "paper_cases": {"F11": 10.0}, "overlays": {"lyapunov": "l"}}
    return draw("bifurcation", study, {"lyapunov": lyapunov}, width=width, **phrase)


def basins(width: str = "page", **axes: str) -> Figure:
    """Four speeds, one failed, and two energies of three starts each; over the speed, unless other axes are
    given."""
    speeds = np.array([8.0, 11.0, 14.5, 16.0])
    classes = [str(word) for word in LONG_TERM_OUTCOMES]
    rng = np.random.default_rng(SEED)
    shares = np.zeros((4, 2, len(classes)))
    for i in range(4):
        for j in range(2):
            chosen = rng.choice(len(classes), 3, replace=False)
            shares[i, j, chosen] = [1 / 6, 2 / 6, 3 / 6]
    kinds = [
        ["quiet", "separating", "irregular"],
        ["separating", "quiet", "other_cycle"],
        ["quasi_periodic", "separating", "quiet"],
        ["quiet", "separating", "undecided"],
    ]
    dims = ("Omega", "attractor")
    data = {
        "basin_fraction": (("Omega", "attractor_class"), shares.mean(axis=1)),
        "basin_fraction_by_energy": (("Omega", "energy", "attractor_class"), shares),
        "attractor_kind": flag(dims, kinds, LONG_TERM_OUTCOMES),
        "attractor_starts": (dims, [[4, 2, 0], [3, 2, 1], [1, 3, 2], [6, 0, 0]]),
        "attractor_range": (dims, 1e-3 * rng.uniform(0.1, 30, (4, 3))),
        "critical_energy": ("Omega", [0.4, 0.1, 0.0, NAN]),
        "critical_energy_sampled": ("Omega", [0.5, 0.2, 0.02, NAN]),
        "status": status(("Omega",), ["ok", "ok", "ok", "failed"]),
    }
    coords = over(Omega=speeds) | {"attractor_class": classes, "energy": [0.02, 0.5]}
    study = xr.Dataset(data, coords, stated(horizon=60)).assign_coords(start=range(3))
    return draw("basins", study, **(axes or {"x": "Omega"}), width=width)


def curves() -> xr.Dataset:
    """A fold at 15.1 rad/s and 385 N with a name, one at 11 rad/s, and a neutral curve."""
    dims = ("curve", "curve_point")
    data = {
        "kind": flag(("curve",), ["fold", "fold", "neutral"], ("none", "neutral", "fold")),
        "x": (dims, [[14.8, 15.0, 15.2, 15.4], [10.8, 11.0, 11.2, 11.4], [9.0, 10.0, 11.5, NAN]]),
        "y": (dims, [[360.0, 380, 390, 400]] * 2 + [[150, 200, 300, NAN]]),
        "adjoins_stable_cycle": flag(dims, np.full((3, 4), "yes"), ("unknown", "no", "yes")),
        "resonance_harmonic": ("curve", [2.0, 3.0, NAN]),
        "resonance_frequency": ("curve", [135.42, 201.5, NAN]),
        "resonance_diameters": ("curve", [2, 3, -1]),
        "resonance_sign": ("curve", [-1, 1, 0]),
        "resonance_detuning": ("curve", [0.2, 5.0, NAN]),
        "status": ((), np.int8(0), {"flag_meanings": "ok failed"}),
    }
    return xr.Dataset(data, {}, stated(x="Omega", y="N"))


def sensitivity() -> Figure:
    """Three parameters, of which one decides, over two preloads, with failed samples."""
    rng = np.random.default_rng(SEED)
    samples = 60
    values = rng.uniform(0.9, 1.1, (2, samples, 3))
    score = 10 * (values - 1) @ np.array([0.2, 1.0, 0.0])
    words = np.where(score > 0.2, "unstable", "stable").astype(object)
    words[:, ::13] = "failed"
    words[0, 5:9] = "no_cycle"
    dims = ("N", "sample")
    meanings = ("failed", "stable", "unstable", "no_cycle")
    data = {
        "parameter_values": ((*dims, "parameter"), values),
        "cycle": flag(dims, words, meanings),
        "status": flag(dims, np.full((2, samples), "ok"), (*STATUSES, "excluded")),
        "probability_unstable": ("N", [0.4, 0.55]),
    }
    coords = over(N=[200.0, 385.0]) | {"parameter": ["k", "mu_s", "c_p"]}
    return draw("sensitivity", xr.Dataset(data, coords, stated()))


def campbell_study() -> xr.Dataset:
    """A mode of the slider and two of the disc; two peaks, of which one has a crossing, and a gap."""
    speeds = np.linspace(8.0, 18.0, 21)
    rate = np.full(21, -0.05)
    rate[5] = 0.4
    rate[4] = 0.35
    rate[12] = 0.2
    rate[11] = 0.15
    rate[16:18] = NAN
    growth = np.stack([rate - 0.1, rate, rate - 0.3], axis=1)
    disc = np.stack([np.full(21, 71.0), 130 + speeds, 200 - speeds], axis=1)
    dims = ("Omega", "mode")
    data = {
        "status": flag(("Omega",), np.where(np.isnan(rate), "no_cycle", "ok"), ("ok", "no_cycle")),
        "growth_rate": ("Omega", rate, column("campbell", "growth_rate")),
        "stick_slip_frequency": ("Omega", 60 + 0.2 * speeds),
        "rotation_frequency": ("Omega", speeds / (2 * np.pi)),
        "mode_kind": flag(dims, [["slider", "disc", "disc"]] * 21, KINDS),
        "diameters": (dims, [[0, 2, 3]] * 21),
        "sliding_frequency": (dims, disc, column("campbell", "sliding_frequency")),
        "cycle_growth_rate": (dims, growth, column("campbell", "cycle_growth_rate")),
        "crossing_Omega": ("crossing", [10.52, 10.48, 14.1]),
        "crossing_frequency": ("crossing", [140.5, 189.5, 2.2]),
        "crossing_mode": ("crossing", [2, 3, 3]),
        "crossing_line": flag(("crossing",), ["stick_slip", "stick_slip", "rotation"], LINES),
        "crossing_multiple": ("crossing", [2.5, 3.0, 1.0]),
        "crossing_effect": flag(("crossing",), ["rises", "none", "rises"], EFFECTS),
    }
    coords = over(Omega=speeds) | {"mode": [1, 2, 3]}
    return xr.Dataset(data, coords, stated())


def campbell(**phrase: Any) -> Figure:
    return draw("campbell", campbell_study(), **phrase)


# ---- Steady sliding


def sliding(outcome: bool = False) -> xr.Dataset:
    """Three modes along mu_k: one that grows from the third value on, one that changes its nodal
    diameters, and one that ends; at the last value growth is at 0 Hz."""
    rates = np.array(
        [[-0.3, -0.1, 0.2, 0.4, 0.1], [-1.0, -1.1, -1.2, -1.3, -1.4], [-0.5, -0.6, NAN, NAN, NAN]]
    )
    frequency = np.array(
        [[130.0, 131, 132, 133, 134], [200, 199, 198, 197, 196], [70, 60, NAN, NAN, NAN]]
    )
    dims = ("mode", "value")
    data = {
        "mode_growth_rate": (dims, rates, column("sliding", "mode_growth_rate")),
        "frequency": (dims, frequency, column("sliding", "frequency")),
        "diameters": (dims, [[2, 2, 2, 2, 2], [3, 3, 3, 1, 1], [-1, -1, -1, -1, -1]]),
        "largest_growth_rate": (
            "value", [-0.3, -0.1, 0.2, 0.4, 0.9], column("sliding", "largest_growth_rate"),
        ),
        "status": status((), "ok"),
    }  # fmt: skip
    coords = {"value": ("value", [0.1, 0.2, 0.3, 0.4, 0.5], attributes("mu_k")), "mode": [1, 2, 3]}
    return xr.Dataset(data, coords, stated(parameter="mu_k"))


def sliding_modes(**phrase: Any) -> Figure:
    return draw("sliding_modes", sliding(), **phrase)


# ---- Charts over speed and preload


def regions() -> xr.Dataset:
    """Outcomes and growth at five loads and six speeds, with an isolated cell and all classes."""
    words = np.array(
        [
            ["quiet", "quiet", "quiet", "growing", "separation", "separation"],
            ["quiet", "quiet", "separation", "quiet", "separation", "separation"],
            ["quiet", "quiet", "quiet", "undecided", "separation", "at_rest"],
            ["quiet", "other_cycle", "other_cycle", "separation", "separation", "failed"],
            ["steady_sliding", "quiet", "growing", "separation", "separation", "separation"],
        ]
    )
    rates = np.array(
        [
            [-0.20, -0.15, -0.02, 0.05, 0.10, NAN],
            [-0.21, -0.14, -0.03, 0.06, 0.25, NAN],
            [-0.22, -0.13, 0.04, 0.07, NAN, NAN],
            [-0.23, 0.50, 0.05, 0.08, NAN, NAN],
            [NAN, -0.12, 0.06, 0.09, 0.11, 0.12],
        ]
    )
    cycle = np.where(np.isfinite(rates), "followed", "no_cycle").astype(object)
    cycle[4, 0] = "nearby_only"
    dims = ("N", "Omega")
    data = {
        "outcome": flag(dims, words, OUTCOMES_TO_HORIZON),
        "cycle": flag(dims, cycle, column_flags("regions", "cycle")),
        "growth_rate": (dims, rates, column("regions", "growth_rate")),
        "status": status(dims, np.full(rates.shape, "ok")),
        "branch_continues_first": flag(dims, np.full(rates.shape, "yes"), ("no", "yes")),
        "branch_continues_second": flag(dims, second_joined(rates), ("no", "yes")),
    }
    axes = over(N=[100.0, 180.0, 260.0, 340.0, 420.0], Omega=[8.0, 10.0, 12.0, 13.0, 14.0, 16.0])
    attrs = stated(horizon=900.0)
    return xr.Dataset(data, axes, attrs).expand_dims(normalization=["as_published"], axis=2)


def second_joined(rates: np.ndarray) -> np.ndarray:
    """Branches continue along the second dimension, but for one."""
    joined = np.full(rates.shape, "yes", dtype=object)
    joined[2, 1] = "no"
    return joined


def column_flags(quantity: str, name: str) -> tuple[str, ...]:
    return every_kind.quantity_of(quantity).COLUMNS[name].flags


def thresholds() -> xr.Dataset:
    """Critical speeds at five loads, of which one failed; separation ends again at one."""
    dims = ("N", "horizon", "crossing_number")
    lowest = np.array([[11.5], [12.7], [NAN], [13.8], [14.0]])
    crossing = [
        [[11.5, 14.5, NAN]],
        [[12.7, NAN, NAN]],
        [[NAN] * 3],
        [[13.8, 14.9, 15.5]],
        [[14.0, NAN, NAN]],
    ]
    kinds = [
        [["begins", "ends", "none"]],
        [["begins", "none", "none"]],
        [["none"] * 3],
        [["begins", "ends", "begins"]],
        [["begins", "none", "none"]],
    ]
    data = {
        "critical_speed": (dims[:2], lowest, column("critical_speed", "critical_speed")),
        "crossing": (dims, crossing, column("critical_speed", "crossing")),
        "crossing_kind": flag(dims, kinds, ("none", "begins", "ends")),
        "status": status(("N",), ["ok", "ok", "failed", "ok", "ok"]),
    }
    coords = over(N=[100.0, 180.0, 260.0, 340.0, 420.0]) | {
        "horizon": [900.0],
        "crossing_number": [1, 2, 3],
        "scan_Omega": np.arange(8.0, 17.0),
    }
    return xr.Dataset(data, coords, stated())


def sweeps() -> xr.Dataset:
    """Onset and end of separation on sweeps, at four loads, of which one failed."""
    data = {
        "onset_speed": ("N", [13.5, 15.0, NAN, 16.0], column("hysteresis", "onset_speed")),
        "offset_speed": ("N", [9.5, 10.5, 12.0, 9.0], column("hysteresis", "offset_speed")),
        "status": status(("N",), ["ok", "ok", "ok", "failed"]),
    }
    speeds = np.arange(8.0, 16.5, 0.5)
    kept = np.zeros((4, 2, speeds.size))
    data["separation_rate"] = (("N", "direction", "sweep_Omega"), kept)
    coords = over(N=[100.0, 220.0, 340.0, 420.0])
    coords |= {"direction": ["up", "down"], "sweep_Omega": speeds}
    return xr.Dataset(data, coords, stated())


def shares() -> xr.Dataset:
    """Shares of starts at 385 N; both motions occur from 12 to 14 rad/s, and at 16."""
    quiet = [[0.9], [0.5], [0.4], [0.2], [0.0], [0.1]]
    data = {
        "basin_fraction_low": (("Omega", "attractor_class"), quiet),
        "separating_fraction_low": ("Omega", [0.0, 0.1, 0.2, 0.3, 0.6, 0.4]),
    }
    speeds = [11.0, 12.0, 13.0, 14.0, 15.0, 16.0]
    return xr.Dataset(data, over(Omega=speeds) | {"attractor_class": ["quiet"]}, stated())


def critical_speed(with_shares: bool = False) -> Figure:
    others = {"curves": curves(), "hysteresis": sweeps(), "cycle": regions().isel(normalization=0)}
    if with_shares:
        others["basins"] = shares()
    overlays = dict.fromkeys(others, "s")
    points = {"paper": (200, 12.6), "another": (385, 15.1)}
    return draw("critical_speed", thresholds(), others, paper_points=points, overlays=overlays)


# ---- Any variable


def plane(values: Any, name: str = "period", **attrs: Any) -> xr.Dataset:
    """A study of a variable over k_p and c_p."""
    data = {name: (("k_p", "c_p"), np.asarray(values), attrs or column("floquet", "period"))}
    words = np.full(np.shape(values), "ok", dtype=object)
    words[0, -1] = "failed"
    data["status"] = status(("k_p", "c_p"), words)
    axes = over(k_p=[2e4, 3e4, 5e4], c_p=[0.02, 0.05, 0.08])
    return xr.Dataset(data, axes, stated())


PERIODS = [[0.0148, 0.0151, NAN], [0.0161, 0.0164, 0.0172], [0.0149, NAN, 0.0201]]


def heat_map(log: bool = False) -> Figure:
    return draw("heat_map", plane(PERIODS), variable="period", x="c_p", y="k_p", log=log)


def growth() -> Figure:
    """Rates of both signs, a single one that differs, and one that is missing."""
    values = [[-0.2, -0.1, NAN], [-0.15, 0.25, -0.1], [-0.2, -0.12, -0.1]]
    study = plane(values, "growth_rate", **column("floquet", "growth_rate"))
    return draw("heat_map", study, variable="growth_rate", x="c_p", y="k_p")


def classes() -> Figure:
    """Outcomes of cells, one between two that are alike."""
    words = [["quiet", "quiet", "failed"], ["quiet", "separation", "quiet"], ["growing"] * 3]
    study = plane(PERIODS)
    study["outcome"] = flag(("k_p", "c_p"), words, OUTCOMES_TO_HORIZON)
    return draw("heat_map", study, variable="outcome", x="c_p", y="k_p")


def curve(variable: str = "period", **phrase: Any) -> Figure:
    study = plane(PERIODS)
    rates = [[-0.2, 0.5, NAN], [-0.15, -0.1, -0.05], [-0.02, NAN, 0.03]]
    study["growth_rate"] = (("k_p", "c_p"), rates, column("floquet", "growth_rate"))
    words = [["quiet", "quiet", "failed"], ["quiet", "separation", "quiet"], ["growing"] * 3]
    study["outcome"] = flag(("k_p", "c_p"), words, OUTCOMES_TO_HORIZON)
    return draw("curve", study, variable=variable, x="c_p", by="k_p", **phrase)


# ---- Examples of kinds


def of_example(kind: str) -> Figure:
    """Return the example of a kind."""
    example = every_kind.EXAMPLES[kind]()
    inputs = {}
    for name, given in example.inputs.items():
        if isinstance(given, xr.DataTree):
            inputs[name] = given
        else:
            inputs[name] = xr.DataTree(given)
    plot = kind_of(kind).model_validate({"kind": kind, **example.phrase})
    return render(plot, inputs)
