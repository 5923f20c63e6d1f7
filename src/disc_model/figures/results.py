"""Pictures that results draw of themselves, on new or given axes: the functions behind their
methods `plot`, ..."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.errors import Fault, ParameterError, raise_faults, require, suggestion, violations
from disc_model.figures import drawing, general, motion
from disc_model.figures.cells import entries
from disc_model.figures.drawing import BLACK, BLUE, COLUMN, GREY, PAGE, SEPARATED, Axes, mpl
from disc_model.figures.labels import break_labels
from disc_model.figures.legends import figure_legend, legend_above, legend_inside
from disc_model.figures.over_parameter import draw_branch, draw_shares, outcomes_in
from disc_model.parameters import Parameters, foreign_case
from disc_model.units import is_number, is_whole

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch
    from disc_model.stability.curves import Critical, NeutralCurves
    from disc_model.stability.cycle import FloquetResult
    from disc_model.stability.lyapunov import Lyapunov
    from disc_model.stability.sliding import SteadySliding


def _stated(case: Parameters | xr.DataTree, *varied: str) -> str:
    """The values of a case, such as that of a run, but those of what varies."""
    p = (
        case
        if isinstance(case, Parameters)
        else Parameters.model_validate_json(case.attrs["parameters"])
    )
    values = p.replace(**{name: p.numbers[name] for name in varied}).stated
    return drawing.what_case({name: value for name, value in values.items() if name not in varied})


@contextmanager
def canvas(
    ax: Any,
    width: float,
    height: float,
    rows: int = 1,
    columns: int = 1,
    title: str | None = None,
    **shared: Any,
) -> Iterator[list[Axes]]:
    """The axes that a reader gives, one for each panel, or those of a new figure of pyplot in the
    common style."""
    if ax is not None:
        given, count = list(np.ravel(np.asarray(ax, dtype=object))), rows * columns
        fit = len(given) == count and all(isinstance(each, mpl.axes.Axes) for each in given)
        require((fit, "ax", given, f"must be {count} axes of matplotlib, one for each panel"))
        yield given
        return
    with drawing.styled():
        figure = mpl.pyplot.figure(figsize=(width, height), layout="constrained")
        yield list(figure.subplots(rows, columns, squeeze=False, **shared).flat)
        break_labels(figure)
        if title is not None:
            figure.suptitle(drawing.head_text(width, "", title), fontsize=8)


def window_of(
    case: xr.DataTree,
    name: object,
    *variables: tuple[str, object],
    which: str = "window",
    samples: bool = False,
) -> xr.Dataset:
    """A window of a run, if it holds what is needed: samples, and variables, each after the
    argument that names it."""
    known = [str(child) for child in case.children if child not in ("events", "poincare")]
    if not (isinstance(name, str) and name in case.children):
        raise ParameterError(Fault.of((which,), name, f"was not recorded{suggestion(name, known)}"))
    window = dataset.group(case, name)
    columns = dict.fromkeys(
        str(x).removesuffix("_min").removesuffix("_max") for x in window if x != "phase"
    )
    for argument, x in variables:
        if not (isinstance(x, str) and x in columns):
            raise ParameterError(
                Fault.of((argument,), x, f"is not in the window {name}{suggestion(x, columns)}")
            )
    require(("phase" in window or not samples, which, name, "must hold samples, not their ranges"))
    return window


def plot_run(
    case: xr.DataTree, windows: Sequence[str], variables: Sequence[str], ax: Any = None
) -> np.ndarray:
    """Draw variables of a run, a row each, in windows, a column each."""
    several, rule = (
        isinstance(variables, list | tuple) and len(variables) > 0,
        "must be a list of one or more",
    )
    require((several, "variables", variables, rule), (len(windows) > 0, "windows", windows, rule))
    named = [("variables", variable) for variable in variables]
    shown = [window_of(case, name, *named, which="windows") for name in windows]
    rows, columns = len(variables), len(windows)
    width = PAGE if columns > 1 else 1.3 * COLUMN
    shared: dict[str, Any] = {"sharex": "col", "sharey": "row" if columns > 1 else False}
    with canvas(ax, width, 0.7 + 1.25 * rows, rows, columns, _stated(case), **shared) as axes:
        grid: Any = np.array(axes, dtype=object).reshape(rows, columns)
        handles: list[Any] = []
        for column, window in zip(grid.T, shown, strict=True):
            handles = motion.draw_history(column, case, window, variables) or handles
        if ax is None:
            axes[0].figure.align_ylabels()
        if handles and ax is None:
            figure_legend(axes[0].figure, handles)
        elif handles:
            legend_inside(axes[0], handles)
    return grid if rows * columns > 1 else grid[0, 0]


def plot_phase_portrait(case: xr.DataTree, window: str, x: str, y: str, ax: Any = None) -> Axes:
    samples = window_of(case, window, ("x", x), ("y", y), samples=True)
    with canvas(ax, COLUMN, 2.9, title=_stated(case)) as [axes]:
        handles = motion.draw_portrait(axes, samples, x, y)
        if ax is None:
            figure_legend(axes.figure, handles)
        else:
            legend_inside(axes, handles)
    return axes


def plot_spectrum(
    case: xr.DataTree, window: str, variable: str, highest: float | None, ax: Any = None
) -> Axes:
    known = highest is None or (is_number(highest) and highest > 0)
    require((known, "highest", highest, "must be a number > 0, in Hz"))
    samples = window_of(case, window, ("variable", variable), samples=True)
    span = float(np.ptp(samples["time"].values)) if samples["time"].size else 0.0
    half = (samples["time"].size - 1) / (2 * span) if span else 0.0  # of the rate
    least = 1 / span if span else 0.0  # resolution
    rule = f"must be within {least:.3g} Hz, the resolution, and {half:.6g} Hz, half the rate of the window"
    within = highest is None or not span or least <= highest <= half * (1 + 1e-9)
    require((within, "highest", highest, rule))  # the span is rounded
    try:
        with canvas(ax, 1.3 * COLUMN, 2.6, title=_stated(case)) as [axes]:
            motion.draw_spectrum(axes, samples, variable, highest)
    except dataset.Missing as reason:
        raise ParameterError(Fault.of(("window",), window, str(reason))) from None
    return axes


def plot_poincare(case: xr.DataTree, ax: Any = None) -> np.ndarray:
    with canvas(ax, PAGE, 2.9, 1, 2, _stated(case)) as axes:
        handles = motion.draw_sections(axes, case, dataset.group(case, "poincare"))
        if ax is None:
            figure_legend(axes[0].figure, handles, handletextpad=0.2)
        else:
            axes[1].legend(handles=handles, fontsize="small")
    return np.array(axes)


def animate(
    p: Parameters, states: Sequence[Any], window: xr.Dataset, path: str | Path | None, fps: int
) -> Any:
    """Make a film of disc, slider and contact force through states; written to a path if there is
    one."""
    file = Path(path) if isinstance(path, str | Path) else Path()
    writer = {".gif": "pillow", ".mp4": "ffmpeg"}.get(file.suffix, "")
    available = not writer or mpl.animation.writers.is_available(writer)
    require(
        (is_number(fps) and fps > 0, "fps", fps, "must be a number > 0"),
        (
            path is None or writer,
            "path",
            str(path),
            "must end in .gif or .mp4; a window is given by window=",
        ),
        (file.absolute().parent.is_dir(), "path", str(path), "must be in a folder that exists"),
        (available, "path", str(path), f"needs the program {writer}"),
    )
    with drawing.styled():
        figure = mpl.figure.Figure(figsize=(6.4, 2.7))
        film = motion.film(
            figure, motion.Motion.of(p, states), window["time"].values, window["P"].values
        )
        if path is not None:
            film.save(path, writer=writer, fps=fps, dpi=100)
        return film


def plot_multipliers(cycle: FloquetResult, ax: Any = None) -> Axes:
    values, angle = cycle.raise_for_status().multipliers, np.linspace(0, 2 * np.pi, 200)
    outside = np.abs(values) > 1
    with canvas(ax, COLUMN, 3.2, title=_stated(cycle.parameters)) as [axes]:
        axes.plot(np.cos(angle), np.sin(angle), color=GREY, linewidth=0.8)
        axes.axhline(0, color=GREY, linewidth=0.4, zorder=0)
        axes.axvline(0, color=GREY, linewidth=0.4, zorder=0)
        for mask, mark, colour, name in (
            (~outside, "o", BLUE, "decays"),
            (outside, "D", SEPARATED, "grows"),
        ):
            if mask.any():
                axes.plot(
                    values[mask].real,
                    values[mask].imag,
                    mark,
                    color=colour,
                    markersize=4,
                    label=name,
                )
        axes.text(0, 0.08, f"largest |κ| = {abs(values[0]):.5g}", ha="center", fontsize=7)
        axes.set(xlabel="Re κ", ylabel="Im κ", aspect="equal")
        word = "stable" if cycle.stable else "unstable"
        period = f"{cycle.period:.4g} s" if cycle.period > 1 else f"{1e3 * cycle.period:.4g} ms"
        axes.set_title(
            f"{word}, growth rate {cycle.growth_rate:.3g}/s, period {period}", loc="left"
        )
        axes.margins(0.12)
        axes.legend(loc="lower right")
    return axes


def plot_eigenvalues(sliding: SteadySliding, ax: Any = None) -> Axes:
    """Draw frequency over growth rate of the eigenvalues of steady sliding; unstable ones with
    their frequency."""
    if not sliding.eigenvalues.size:
        raise ParameterError(
            Fault(("status",), sliding.status.value, f"there are no eigenvalues: {sliding.message}")
        )
    values = sliding.eigenvalues[sliding.eigenvalues.imag >= 0]
    rate, frequency, grows = (
        values.real,
        values.imag / (2 * np.pi),
        np.isin(values, sliding.growing),
    )
    with canvas(ax, COLUMN, 3.0) as [axes]:
        axes.axvline(0, color=BLACK, linewidth=0.6)
        for mask, mark, colour in ((~grows, "o", BLUE), (grows, "D", SEPARATED)):
            axes.plot(rate[mask], frequency[mask], mark, color=colour, markersize=4)
        for x, y in zip(rate[grows], frequency[grows], strict=True):
            drawing.say(axes, f"{y:.0f} Hz", (x, y), (4, 0), fontsize=7, color=SEPARATED)
        span = max(map(abs, axes.get_xlim())) * 1.25
        axes.set(
            xlabel="Growth rate (1/s)", ylabel="Frequency (Hz)", xlim=(-span, span), ylim=(0, None)
        )
        axes.margins(y=0.08)
        for x, name, side in ((0.02, "decays", "left"), (0.98, "grows", "right")):
            axes.text(x, 1.02, name, transform=axes.transAxes, ha=side, fontsize=7, color=GREY)
        axes.set_title(drawing.fill(sliding.message, 34), loc="center")
    return axes


def plot_branch(branch: Branch, y: str, ax: Any = None) -> Axes:
    """Draw a variable of the cycles along a branch over its parameter, or its second parameter over
    its first."""
    first, *second = branch.parameters
    label, factor = drawing.axis_of(first)
    x = branch.values[:, 0] * factor
    if second:
        name, scale = drawing.axis_of(second[0])
        values = branch.values[:, 1] * scale
    else:
        labels = {
            "growth_rate": "Growth rate of the cycle (1/s)",
            "period": "Period (ms)",
            "stick_fraction": "Stick",
        }
        known = isinstance(y, str) and y in labels
        require((known, "y", y, f"must be one of {', '.join(labels)}"))
        name, values = labels[y], getattr(branch, y) * (1e3 if y == "period" else 1.0)
    with canvas(ax, 1.3 * COLUMN, 2.8, title=_stated(branch.case, *branch.parameters)) as [axes]:
        draw_branch(axes, x, values, branch.growth_rate < 0, BLACK)
        axes.plot(x, values, ".", color=BLACK, markersize=3)  # what lies between is not computed
        if y == "growth_rate" and not second:
            general.scale_rates(axes)
        for width, text in ((2.0, "stable"), (0.7, "unstable")):
            axes.plot([], [], color=BLACK, linewidth=width, label=text)
        folds = np.reshape(branch.folds, (-1, len(branch.parameters)))
        if len(folds):
            i = [int(np.argmin(np.abs(branch.values - fold).sum(axis=1))) for fold in folds]
            text = "fold at " + ", ".join(f"{fold:.5g}" for fold in folds[:, 0] * factor)
            axes.plot(
                folds[:, 0] * factor, values[i], "s", color=SEPARATED, markersize=4, label=text
            )
        axes.margins(0.04)
        axes.set(xlabel=label, ylabel=name)
        legend_above(axes)
    return axes


def plot_neutral_curves(curves: NeutralCurves, ax: Any = None) -> Axes:
    labels, factors = zip(*map(drawing.axis_of, curves.bounds), strict=True)
    low, high = np.transpose([*curves.bounds.values()]) * factors
    kinds = {"neutral": (BLACK, "loses stability"), "fold": (SEPARATED, "ends in a fold")}
    with canvas(ax, 1.3 * COLUMN, 3.0, title=_stated(curves.parameters, *curves.bounds)) as [axes]:
        axes.set(xlabel=labels[0], ylabel=labels[1], xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        names: list[np.ndarray] = []
        for curve in curves:
            points, (colour, _) = curve.values * factors, kinds[curve.kind]
            draw_branch(axes, points[:, 0], points[:, 1], curve.adjoins_stable_cycle, colour)
            share = axes.transAxes.inverted().transform(axes.transData.transform(points))
            inside = np.all(share > 0.02, axis=1) & (share[:, 0] < 0.75) & (share[:, 1] < 0.98)
            for name in names:  # where there is room beside other names
                inside &= np.any(np.abs(share - name) > (0.27, 0.06), axis=1)
            if (free := np.flatnonzero(inside)).size:
                i = free[free.size // 2]
                names.append(share[i])
                look: dict[str, Any] = {
                    "fontsize": 6,
                    "color": colour,
                    "path_effects": drawing.halo(),
                }
                drawing.say(axes, drawing.typeset(curve.resonance.label), points[i], (8, 0), **look)
        for kind, (colour, text) in kinds.items():
            if any(curve.kind == kind for curve in curves):
                axes.plot([], [], color=colour, linewidth=2.0, label=f"cycle {text}")
        legend_above(axes)
    return axes


def plot_critical(critical: Critical, ax: Any = None) -> Axes:
    """Draw the growth rate of the cycle over the parameter; shaded: the motion near the start is
    unstable."""
    label, factor = drawing.axis_of(critical.name)
    x = critical.values * factor
    with canvas(ax, 1.3 * COLUMN, 2.8, title=_stated(critical.parameters, critical.name)) as [axes]:
        for i, ends in enumerate(critical.unstable * factor):
            entry = "_nolegend_" if i else "unstable near the static start"
            axes.axvspan(*ends, color=SEPARATED, alpha=0.3, linewidth=0.8, zorder=0, label=entry)
        axes.plot(
            x,
            critical.growth_rate,
            ".-",
            color=BLACK,
            markersize=3,
            linewidth=0.7,
            label="cycles computed",
        )
        general.scale_rates(axes)
        axes.set(xlabel=label, ylabel="Growth rate of the cycle (1/s)", xlim=(x[0], x[-1]))
        legend_above(axes)
    return axes


def plot_exponents(lyapunov: Lyapunov, ax: Any = None) -> Axes:
    """Draw the exponents with their errors, those that have converged filled; what has vanished is
    left out."""
    number = np.arange(1, len(lyapunov.exponents) + 1)
    finite, done = np.isfinite(lyapunov.exponents), lyapunov.converged
    with canvas(ax, COLUMN, 2.6) as [axes]:
        for mask, face, text in (
            (done & finite, BLUE, "converged"),
            (~done & finite, "white", "not converged"),
        ):
            if mask.any():
                points = number[mask], lyapunov.exponents[mask], lyapunov.errors[mask]
                axes.errorbar(
                    *points,
                    fmt="o",
                    color=BLUE,
                    ms=4,
                    mfc=face,
                    capsize=3,
                    linewidth=0.8,
                    label=text,
                )
        axes.axhline(0, color=GREY, linewidth=0.6, zorder=0)
        axes.set(
            xlabel="Number",
            ylabel="Lyapunov exponent (1/s)",
            xticks=number,
            xlim=(0.5, number[-1] + 0.5),
        )
        axes.set_title(
            f"over {lyapunov.duration:g} s, {lyapunov.separations} separations", loc="left"
        )
        axes.legend()
    return axes


SHARES = ("basin_fraction_by_energy", "basin_fraction")
PREFERRED = (
    *SHARES,
    "growth_rate",
    "outcome",
    "critical_speed",
    "separation_rate",
    "scan_first_separation",
    "kind",
)


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
    counts = (is_whole(most) and most >= 1, "most", most, "must be a whole number >= 1")
    raise_faults(foreign_case(p) + violations(counts))
    drawable = p.n_diameters >= 0 or p.disc is not None
    require((drawable, "n_diameters", p.n_diameters, "must be >= 0: a rigid disc has no modes"))
    motion.radial_range(p)
    count = min(most, len(motion.mode_arrays(p).omega))
    columns = min(count, 5)
    rows = -(-count // columns)
    with canvas(ax, 1.45 * columns + 0.1, 1.65 * rows + 0.3, rows, columns) as axes:
        for spare in axes[count:]:
            spare.set_axis_off()
        motion.draw_modes(axes[:count], p)
        if ax is None:
            axes[0].figure.suptitle(
                "Modes (nodal diameters, nodal circles), slider and nodal lines", fontsize=8
            )
    return np.array(axes)


def plot_sweep(
    study: xr.Dataset | xr.DataTree,
    variable: str = "",
    x: str = "",
    *,
    log: bool = False,
    ax: Any = None,
) -> Axes:
    """Draw a variable of a sweep or of a grid study: a line along one dimension, or colours over
    two.

    A second dimension of words, such as the direction of a sweep, gives a line for each. What
    starts come to is drawn as bars of their shares, at each energy or along a parameter. A hatched
    cell is "unresolved": its value is right, but all neighbours differ from it by a tenth of the
    scale or more, so that the grid misses what lies between.

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
    require(
        (isinstance(study, xr.Dataset), "study", study, "must be an xarray.Dataset"),
        (isinstance(variable, str | None), "variable", variable, "must be a name"),
        (isinstance(x, str | None), "x", x, "must be a name"),
        (isinstance(log, bool), "log", log, "must be True or False"),
    )
    alone = (
        "basin_fraction" in study and study["basin_fraction"].size == study.sizes["attractor_class"]
    )  # one case
    study = study.squeeze(
        [dim for dim, size in study.sizes.items() if size == 1 and not (alone and dim == "energy")]
    )
    counted = {"branch", "branch_point"}  # what numbers their values count is no quantity
    numbers = [
        str(x)
        for x in study.dims
        if x in study.coords and x not in counted and study[x].dtype.kind in "fi"
    ]
    over = {str(name): {*values.dims} for name, values in study.items()}
    choices = [name for name, dims in over.items() if dims & {*numbers} and dims <= {*study.coords}]
    flat = [name for name in choices if len(over[name]) < 3]
    first = [name for name in flat if study[name].dtype.kind in "fi"] + choices
    named = variable or next((name for name in PREFERRED if name in flat), (*first, "")[0])
    require(
        (
            named in choices,
            "variable",
            named,
            f"must be one over the grid{suggestion(named, choices)}",
        )
    )
    dims = [str(dim) for dim in study[named].dims]
    possible = [dim for dim in dims if dim in numbers]
    across = x or possible[0]
    rule = f"varies along {', '.join(dims)}: select values of all but two"
    require((len(dims) < 3, "variable", named, rule))
    require((across in possible, "x", across, f"must be one of {', '.join(possible)}"))
    case = json.loads(study.attrs.get("base", study.attrs.get("parameters", "{}")))
    shown = {str(name).removeprefix("sweep_").removeprefix("scan_") for name in study.coords}
    fixed = {str(name): x.item() for name, x in study.coords.items() if not x.ndim}
    title = drawing.what_case(
        {name: value for name, value in case.items() if name not in shown} | fixed
    )
    with canvas(ax, 1.3 * COLUMN, 2.9, title=title) as [axes]:
        if named in SHARES and not log:
            (label, along), handles = (
                drawing.along(study[across]),
                entries(outcomes_in(study[named])),
            )
            places = (
                np.arange(along.size) if across == "energy" else along
            )  # equally far apart, as one may be 0
            draw_shares(axes, study[named], outcomes_in(study[named]), places)
            if across == "energy":
                axes.set_xticks(places, [f"{energy:g}" for energy in along])
            axes.set(xlabel=label, ylabel=drawing.label_of(study[named])[0], xmargin=0.04)
        elif len(dims) == 1 or len(possible) == 1:
            general.draw_lines(axes, study, named, across, log)
            handles = axes.get_legend_handles_labels()[0]
        else:
            [up] = [dim for dim in dims if dim != across]
            handles = general.draw_maps(axes.figure, [axes], study, named, across, up, log)
            if study[up].dtype.kind == "i" and axes.get_yscale() == "linear":
                axes.locator_params(axis="y", integer=True)
        figure_legend(axes.figure, handles)
    return axes
