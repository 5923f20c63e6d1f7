"""Pictures that results draw of themselves: the functions behind their methods `plot`, `plot_spectrum`, ...

Each returns the axes on which it drew: those of a new figure in the common style, or those of its argument `ax`.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.errors import Fault, ParameterError, raise_faults, require, suggestion, violations
from disc_model.figures import disc, drawing, general, motion
from disc_model.figures.bifurcation import draw_branch
from disc_model.figures.drawing import BLACK, BLUE, COLUMN, GREY, PAGE, SEPARATED, Axes, by_itself
from disc_model.figures.maps import patches
from disc_model.figures.uncertain import LOOKS, draw_shares, outcomes_in
from disc_model.parameters import RATIOS, Parameters, foreign_case
from disc_model.units import is_number, is_whole

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch
    from disc_model.stability.curves import Critical, NeutralCurves
    from disc_model.stability.cycle import FloquetResult
    from disc_model.stability.lyapunov import Lyapunov
    from disc_model.stability.sliding import SteadySliding


def _title(ax: Axes, p: Parameters, *varied: str, ours: bool = True) -> None:
    """Write the values of a case but those of what varies above a new figure, or nothing above that of a reader."""
    if ours:
        figure: Any = ax.figure
        values = p.replace(**{name: p.numbers[name] for name in varied}).stated
        text = drawing.what_case({name: value for name, value in values.items() if name not in varied})
        figure.suptitle(drawing.head_text(figure.get_figwidth(), "", text), fontsize=8)


def axes_for(ax: Any, width: float, height: float, rows: int = 1, columns: int = 1, **shared: Any) -> list[Axes]:
    """The axes to draw on, as `drawing.axes_for`; raises `ParameterError` for what is no axes."""
    from matplotlib.axes import Axes as Known

    right = ax is None or all(isinstance(one, Known) for one in np.ravel(np.asarray(ax, dtype=object)))
    require((right, "ax", ax, "must be axes of matplotlib"))
    return drawing.axes_for(ax, width, height, rows, columns, **shared)


# ---- Runs


def window_of(case: xr.DataTree, name: object, which: str = "window", **variables: object) -> xr.Dataset:
    """A window of a run by its name; raises `ParameterError` if there is none, or it lacks one of the variables.

    **variables : names of variables, or several, by the arguments of the picture that ask for them
    """
    known = [str(child) for child in case.children if child not in ("events", "poincare")]
    if not (isinstance(name, str) and name in case.children):
        raise ParameterError(Fault.of((which,), name, f"was not recorded{suggestion(name, known)}"))
    window = dataset.group(case, name)
    kept = dict.fromkeys(str(kept).removesuffix("_min").removesuffix("_max") for kept in window if kept != "phase")
    for argument, names in variables.items():
        for one in names if argument == "variables" else [names]:  # type: ignore[attr-defined]
            if not (isinstance(one, str) and one in kept):
                raise ParameterError(Fault.of((argument,), one, f"is not in the window {name}{suggestion(one, kept)}"))
    return window


@by_itself
def plot_run(case: xr.DataTree, windows: Sequence[str], variables: Sequence[str], ax: Any = None) -> np.ndarray:
    """Draw variables of a run, a row each, in windows, a column each."""
    several = isinstance(variables, list | tuple) and len(variables) > 0
    rules = (several, "variables", variables), (len(windows) > 0, "windows", windows)
    require(*((*rule, "must be a list of one or more") for rule in rules))
    shown = [window_of(case, name, "windows", variables=variables) for name in windows]
    rows, columns = len(variables), len(windows)
    width = PAGE if columns > 1 else 1.3 * COLUMN
    axes = axes_for(ax, width, 0.7 + 1.25 * rows, rows, columns, sharex="col", sharey="row" if columns > 1 else False)
    grid: Any = np.array(axes, dtype=object).reshape(rows, columns)
    handles: list[Any] = []
    for column, window in zip(grid.T, shown, strict=True):
        handles = motion.draw_history(column, case, window, variables) or handles
    if ax is None:
        _title(axes[0], Parameters.model_validate_json(case.attrs["parameters"]))
        axes[0].figure.align_ylabels()
        if handles:
            axes[0].figure.legend(handles=handles, loc="outside lower right", ncols=3)
    elif handles:
        drawing.legend_above(axes[0], handles=handles)
    return grid if rows * columns > 1 else grid[0, 0]


@by_itself
def plot_phase_portrait(case: xr.DataTree, window: str, x: str, y: str, ax: Any = None) -> Axes:
    """Draw one variable over another, coloured by phase."""
    samples = window_of(case, window, x=x, y=y)
    if "phase" not in samples:
        raise ParameterError(Fault.of(("window",), window, "must hold samples, not their ranges"))
    [axes] = axes_for(ax, COLUMN, 2.9)
    motion.draw_portrait(axes, samples, x, y)
    _title(axes, Parameters.model_validate_json(case.attrs["parameters"]), ours=ax is None)
    return axes


@by_itself
def plot_spectrum(case: xr.DataTree, window: str, variable: str, highest: float | None, ax: Any = None) -> Axes:
    """Draw the amplitude of a variable over the frequency."""
    known = highest is None or (is_number(highest) and highest > 0)
    require((known, "highest", highest, "must be a number > 0, in Hz"))
    samples = window_of(case, window, variable=variable)
    if variable not in samples:
        raise ParameterError(Fault.of(("window",), window, "must hold samples, not their ranges"))
    span = float(np.ptp(samples["time"].values)) if samples["time"].size else 0.0
    half = (samples["time"].size - 1) / (2 * span) if span else 0.0  # of the rate
    highest = min(1000.0, half) if highest is None else highest
    rule = f"must be at least the resolution of the window, {1 / span if span else 0:.3g} Hz"
    most = f"must be at most half the rate of the window, {half:.6g} Hz"
    require((not span or highest * span >= 1, "highest", highest, rule))
    require((not span or highest <= half * (1 + 1e-9), "highest", highest, most))  # the span is rounded
    [axes] = axes_for(ax, 1.3 * COLUMN, 2.6)
    try:
        motion.draw_spectrum(axes, samples, variable, highest)
    except Missing as reason:
        raise ParameterError(Fault.of(("window",), window, str(reason))) from None
    _title(axes, Parameters.model_validate_json(case.attrs["parameters"]), ours=ax is None)
    return axes


@by_itself
def plot_poincare(case: xr.DataTree, ax: Any = None) -> np.ndarray:
    """Draw the sections of slider and disc, once a turn of the drive."""
    axes = axes_for(ax, PAGE, 2.9, 1, 2)
    samples = dataset.group(case, "poincare")
    handles = motion.draw_sections(axes, case, samples)
    _title(axes[0], Parameters.model_validate_json(case.attrs["parameters"]), ours=ax is None)
    if ax is None:
        axes[0].figure.legend(handles=handles, loc="outside lower right", ncols=len(handles), handletextpad=0.2)
    else:
        axes[1].legend(handles=handles, fontsize="small")
    return np.array(axes)


def animate(p: Parameters, states: Sequence[Any], window: xr.Dataset, path: str | Path | None, fps: int) -> Any:
    """Make a film of disc, slider and contact force through states; written to a path if there is one."""
    from matplotlib.animation import writers
    from matplotlib.figure import Figure

    file = Path(path) if isinstance(path, str | Path) else None
    writer = {".gif": "pillow", ".mp4": "ffmpeg"}.get(file.suffix if file else "", "")
    rules: list[Any] = [(is_number(fps) and fps > 0, "fps", fps, "must be a number > 0")]
    if path is not None:
        there, available = file and file.absolute().parent.is_dir(), not writer or writers.is_available(writer)
        rules += [
            (there, "path", str(path), "must be in a folder that exists"),
            (writer, "path", str(path), "must end in .gif or .mp4; a window is given by window="),
            (available, "path", str(path), f"needs the program {writer}"),
        ]
    require(*rules)
    with drawing.styled():
        figure = Figure(figsize=(6.4, 2.7), layout="constrained")
        film = disc.film(figure, disc.Motion.of(p, states), window["time"].values, window["P"].values)
        if path is not None:
            film.save(path, writer=writer, fps=fps, dpi=100)
        return film


# ---- Stability


@by_itself
def plot_multipliers(cycle: FloquetResult, ax: Any = None) -> Axes:
    """Draw the multipliers of a cycle in the complex plane, and the unit circle."""
    [axes] = axes_for(ax, COLUMN, 3.2)
    angle = np.linspace(0, 2 * np.pi, 200)
    axes.plot(np.cos(angle), np.sin(angle), color=GREY, linewidth=0.8)
    axes.axhline(0, color=GREY, linewidth=0.4, zorder=0)
    axes.axvline(0, color=GREY, linewidth=0.4, zorder=0)
    values = cycle.multipliers
    outside = np.abs(values) > 1
    for mask, mark, colour, name in ((~outside, "o", BLUE, "decays"), (outside, "D", SEPARATED, "grows")):
        if mask.any():
            axes.plot(values[mask].real, values[mask].imag, mark, color=colour, markersize=4, label=name)
    axes.text(0, 0.08, f"largest |κ| = {abs(values[0]):.5g}", ha="center", fontsize=7)
    word = "stable" if cycle.stable else "unstable"
    axes.set(xlabel="Re κ", ylabel="Im κ", aspect="equal")
    period = f"{cycle.period:.4g} s" if cycle.period > 1 else f"{1e3 * cycle.period:.4g} ms"
    axes.set_title(f"{word}, growth rate {cycle.growth_rate:.3g}/s, period {period}", loc="left")
    axes.margins(0.12)
    axes.legend(loc="lower right")
    _title(axes, cycle.parameters, ours=ax is None)
    return axes


@by_itself
def plot_eigenvalues(sliding: SteadySliding, ax: Any = None) -> Axes:
    """Draw frequency over growth rate of the eigenvalues of steady sliding; unstable ones with their frequency."""
    if not sliding.eigenvalues.size:
        raise ParameterError(Fault(("status",), sliding.status.value, f"there are no eigenvalues: {sliding.message}"))
    [axes] = axes_for(ax, COLUMN, 3.0)
    values = sliding.eigenvalues[sliding.eigenvalues.imag >= 0]
    rate, frequency = values.real, values.imag / (2 * np.pi)
    axes.axvline(0, color=BLACK, linewidth=0.6)
    grows = np.isin(values, sliding.growing)
    for mask, mark, colour in ((~grows, "o", BLUE), (grows, "D", SEPARATED)):
        axes.plot(rate[mask], frequency[mask], mark, color=colour, markersize=4)
    for x, y in zip(rate[grows], frequency[grows], strict=True):
        drawing.say(axes, f"{y:.0f} Hz", (x, y), (4, 0), fontsize=7, color=SEPARATED)
    low, high = axes.get_xlim()
    span = max(abs(low), abs(high)) * 1.25
    axes.set(xlabel="Growth rate (1/s)", ylabel="Frequency (Hz)", xlim=(-span, span), ylim=(0, None))
    axes.margins(y=0.08)
    for x, name in ((0.02, "decays"), (0.98, "grows")):
        axes.text(x, 1.02, name, transform=axes.transAxes, ha="left" if x < 0.5 else "right", fontsize=7, color=GREY)
    axes.set_title(drawing.fill(sliding.message, 34), loc="center")
    return axes


@by_itself
def plot_branch(branch: Branch, y: str, ax: Any = None) -> Axes:
    """Draw a variable of the cycles along a branch over its parameter, or its second parameter over its first."""
    [axes] = axes_for(ax, 1.3 * COLUMN, 2.8)
    label, factor = drawing.axis_of(branch.parameters[0])
    x, stable = branch.values[:, 0] * factor, branch.growth_rate < 0
    if len(branch.parameters) > 1:
        name, scale = drawing.axis_of(branch.parameters[1])
        values = branch.values[:, 1] * scale
    else:
        labels = {"growth_rate": "Growth rate of the cycle (1/s)", "period": "Period (ms)", "stick_fraction": "Stick"}
        if not isinstance(y, str) or y not in labels:
            raise ParameterError(Fault.of(("y",), y, f"must be one of {', '.join(labels)}"))
        name, values = labels[y], getattr(branch, y) * (1e3 if y == "period" else 1.0)
    draw_branch(axes, x, values, stable, BLACK, np.inf)
    axes.plot(x, values, ".", color=BLACK, markersize=3)  # what lies between is not computed
    if y == "growth_rate" and len(branch.parameters) == 1:
        general.scale_rates(axes)
    for width, text in ((2.0, "stable"), (0.7, "unstable")):
        axes.plot([], [], color=BLACK, linewidth=width, label=text)
    folds = np.reshape(branch.folds, (-1, len(branch.parameters)))
    if len(folds):
        i = [int(np.argmin(np.abs(branch.values - fold).sum(axis=1))) for fold in folds]
        text = "fold at " + ", ".join(f"{fold:.5g}" for fold in folds[:, 0] * factor)
        axes.plot(folds[:, 0] * factor, values[i], "s", color=SEPARATED, markersize=4, label=text)
    axes.margins(0.04)
    axes.set(xlabel=label, ylabel=name)
    drawing.legend_above(axes)
    _title(axes, branch.case, *branch.parameters, ours=ax is None)
    return axes


@by_itself
def plot_neutral_curves(curves: NeutralCurves, ax: Any = None) -> Axes:
    """Draw neutral curves and folds in the plane of two parameters, thick beside a stable cycle, with their names."""
    [axes] = axes_for(ax, 1.3 * COLUMN, 3.0)
    factors = []
    for side, (name, ends) in zip("xy", curves.bounds.items(), strict=True):
        label, factor = drawing.axis_of(name)
        axes.set(**{f"{side}label": label, f"{side}lim": tuple(factor * end for end in ends)})
        factors.append(factor)
    names: list[np.ndarray] = []
    for curve in curves:
        x, y = curve.values.T * np.array(factors)[:, None]
        colour = BLACK if curve.kind == "neutral" else SEPARATED
        draw_branch(axes, x, y, curve.adjoins_stable_cycle, colour)
        text = drawing.typeset(curve.resonance.label)
        share = axes.transAxes.inverted().transform(axes.transData.transform(np.column_stack([x, y])))
        free = [i for i, at in enumerate(share) if all(at > 0.02) and at[0] < 0.75 and at[1] < 0.98
                and all(np.any(np.abs(at - other) > (0.27, 0.06)) for other in names)]  # fmt: skip
        if free:  # otherwise there is no room for its name
            i = free[len(free) // 2]
            names.append(share[i])
            drawing.say(axes, text, (x[i], y[i]), (8, 0), fontsize=6, color=colour, path_effects=drawing.halo())
    kinds = {curve.kind for curve in curves}
    for kind, colour, text in (("neutral", BLACK, "loses stability"), ("fold", SEPARATED, "ends in a fold")):
        if kind in kinds:
            axes.plot([], [], color=colour, linewidth=2.0, label=f"cycle {text}")
    drawing.legend_above(axes)
    _title(axes, curves.parameters, *curves.bounds, ours=ax is None)
    return axes


@by_itself
def plot_critical(critical: Critical, ax: Any = None) -> Axes:
    """Draw the growth rate of the cycle over the parameter; shaded: the motion near the start is unstable."""
    [axes] = axes_for(ax, 1.3 * COLUMN, 2.8)
    label, factor = drawing.axis_of(critical.name)
    x, ends = critical.values * factor, critical.unstable * factor
    for i, (low, high) in enumerate(ends):
        text: dict[str, Any] = {"label": "unstable near the static start"} if i == 0 else {}
        axes.axvspan(low, high, facecolor=SEPARATED, alpha=0.3, linewidth=0.8, edgecolor=SEPARATED, zorder=0, **text)
    axes.plot(x, critical.growth_rate, ".-", color=BLACK, markersize=3, linewidth=0.7, label="cycles computed")
    general.scale_rates(axes)
    axes.set(xlabel=label, ylabel="Growth rate of the cycle (1/s)", xlim=(x[0], x[-1]))
    drawing.legend_above(axes)
    _title(axes, critical.parameters, critical.name, ours=ax is None)
    return axes


@by_itself
def plot_exponents(lyapunov: Lyapunov, ax: Any = None) -> Axes:
    """Draw the exponents with their errors, those that have converged filled; what has vanished is left out."""
    [axes] = axes_for(ax, COLUMN, 2.6)
    number = np.arange(1, len(lyapunov.exponents) + 1)
    finite = np.isfinite(lyapunov.exponents)
    for mask, face, text in ((lyapunov.converged, BLUE, "converged"), (~lyapunov.converged, "white", "not converged")):
        if (shown := mask & finite).any():
            axes.errorbar(
                number[shown], lyapunov.exponents[shown], lyapunov.errors[shown], fmt="o", color=BLUE, label=text,
                markerfacecolor=face, markersize=4, capsize=3, linewidth=0.8,
            )  # fmt: skip
    axes.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    axes.set(xlabel="Number", ylabel="Lyapunov exponent (1/s)", xticks=number, xlim=(0.5, number[-1] + 0.5))
    axes.set_title(f"over {lyapunov.duration:g} s, {lyapunov.separations} separations", loc="left")
    axes.legend()
    return axes


# ---- Grids and discs
NAMES = {*Parameters.model_fields, *RATIOS}  # coordinates of one value that titles state
SHARES = ("basin_fraction_by_energy", "basin_fraction")
PREFERRED = (*SHARES, "growth_rate", "outcome", "critical_speed", "separation_rate", "scan_first_separation", "kind")
"""Variables that a sweep shows first."""


def plot_modes(p: Parameters, most: int = 15, ax: Any = None) -> np.ndarray:
    """Draw the shapes of the modes of a case from above, with their nodal lines and frequencies.

    Parameters
    ----------
    p : the case; a disc that is given by its modes needs shapes at two radii or more
    most : number of modes that are drawn, by ascending frequency
    ax : axes to draw on, one for each mode

    Returns
    -------
    array of Axes

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the disc has no shapes.

    Examples
    --------
    >>> import disc_model as dm
    >>> dm.plot_modes(dm.Parameters(N=385, Omega=15.1)).size
    5
    """
    return draw_modes(p, most, True, ax=ax)


@by_itself
def draw_modes(p: Parameters, most: int, slider: bool, ax: Any = None) -> np.ndarray:
    """As `plot_modes`, with or without the slider."""
    counts = (is_whole(most) and most >= 1, "most", most, "must be a whole number >= 1")
    raise_faults(foreign_case(p) + violations(counts))
    drawable = p.n_diameters >= 0 or p.disc is not None
    raise_faults(violations((drawable, "n_diameters", p.n_diameters, "must be >= 0: a rigid disc has no modes")))
    disc.radial_range(p)
    count = min(most, len(disc.mode_arrays(p).omega))
    columns = min(count, 5)
    rows = -(-count // columns)
    axes = axes_for(ax, 1.45 * columns + 0.1, 1.65 * rows + 0.3, rows, columns)
    for spare in axes[count:]:
        spare.set_axis_off()
    disc.draw_modes(axes[:count], p, slider)
    if ax is None:
        what = "slider and nodal lines" if slider else "nodal lines"
        axes[0].figure.suptitle(f"Modes (nodal diameters, nodal circles), {what}", fontsize=8)
    return np.array(axes)


@by_itself
def plot_sweep(study: xr.Dataset, variable: str = "", x: str = "", *, log: bool = False, ax: Any = None) -> Axes:
    """Draw a variable of a sweep or of a grid study: a line along one dimension, or colours over two.

    A second dimension of words, such as the direction of a sweep, gives a line for each. What starts come to is drawn
    as bars of their shares, at each energy or along a parameter. A hatched cell is "unresolved": its value is right,
    but all neighbours differ from it by a tenth of the scale or more, so that the grid misses what lies between.

    Parameters
    ----------
    study : such as `disc_model.sweep`, `run_study`, `hysteresis` and `basins` return; of one or two dimensions of
        several values
    variable : the shares of starts, the growth rate, the outcome or the first number there is if not given
    x : the dimension along the horizontal axis; the first of numbers if not given
    log : whether the scale of the variable is logarithmic
    ax : axes to draw on

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or more than two dimensions vary.

    Examples
    --------
    >>> import disc_model as dm
    >>> growth = dm.sweep(dm.floquet, dm.Parameters(N=300, Omega=15), Omega=[10, 12, 14])
    >>> dm.plot_sweep(growth).get_xlabel()
    'Speed Ω (rad/s)'
    """
    texts = (isinstance(value, str | None) for value in (variable, x))
    require(
        (isinstance(study, xr.Dataset), "study", study, "must be an xarray.Dataset"),
        *zip(texts, ("variable", "x"), (variable, x), ("must be a name",) * 2, strict=True),
        (isinstance(log, bool), "log", log, "must be True or False"),
    )
    alone = "basin_fraction" in study and study["basin_fraction"].size == study.sizes["attractor_class"]  # one case
    study = study.squeeze([dim for dim, size in study.sizes.items() if size == 1 and not (alone and dim == "energy")])
    numbers = [str(dim) for dim in study.dims if dim in study.coords and study[dim].dtype.kind in "fi"]
    choices = [str(name) for name, values in study.items()
               if {*values.dims} & {*numbers} and {*values.dims} <= {*study.coords}]  # fmt: skip
    flat = [name for name in choices if study[name].ndim < 3]
    first = [name for name in flat if study[name].dtype.kind in "fi"] + choices
    named = variable or next((name for name in PREFERRED if name in flat), (*first, "")[0])
    if named not in choices:
        raise ParameterError(Fault.of(("variable",), named, f"must be one over the grid{suggestion(named, choices)}"))
    dims = [str(dim) for dim in study[named].dims]
    possible = [dim for dim in dims if dim in numbers]
    across = x or possible[0]
    if across not in possible or len(dims) > 2:
        rule = f"must be one of {', '.join(possible)}, and one or two must vary: select values of others"
        raise ParameterError(Fault.of(("x",), across, rule))
    [axes] = axes_for(ax, 1.3 * COLUMN, 2.9)
    handles: Sequence[Any]
    if named in SHARES and not log:
        handles = _draw_shares(axes, study[named], across)
    elif len(dims) == 1 or len(possible) == 1:
        general.draw_lines(axes, study, named, across, log)
        handles = axes.get_legend_handles_labels()[0]
    else:
        [up] = [dim for dim in dims if dim != across]
        handles = general.draw_maps(axes.figure, [axes], study, named, across, up, log)
        if study[up].dtype.kind == "i" and axes.get_yscale() == "linear":
            axes.locator_params(axis="y", integer=True)
    if handles:
        axes.figure.legend(handles=handles, loc="outside lower right", ncols=3)
    base = next((what for what in ("base", "parameters") if what in study.attrs), "")
    case = drawing.stated_in(study, base) if base else {}
    shown = {str(name).removeprefix("sweep_").removeprefix("scan_") for name in study.coords}
    fixed = {str(name): at.item() for name, at in study.coords.items() if not at.ndim and str(name) in NAMES}
    values = {name: value for name, value in case.items() if name not in shown} | fixed
    if ax is None:
        figure: Any = axes.figure
        figure.suptitle(drawing.head_text(figure.get_figwidth(), "", drawing.what_case(values)), fontsize=8)
    return axes


def _draw_shares(axes: Axes, shares: xr.DataArray, across: str) -> Sequence[Any]:
    """Draw shares of outcomes as bars, equally far apart for energies, which may be 0; returns entries of a legend."""
    label, factor = drawing.label_of(shares[across])
    along, classes = shares[across].values * factor, outcomes_in(shares)
    places = np.arange(along.size) if across == "energy" else along
    draw_shares(axes, shares, classes, places, 0.9 * np.diff(places).min(initial=1.0))
    if across == "energy":
        axes.set_xticks(places, [f"{energy:g}" for energy in along])
    axes.set(xlabel=label, ylabel=drawing.label_of(shares)[0], xmargin=0.04)
    return patches(LOOKS, classes)
