"""Pictures that results draw of themselves, and of sweeps: on `ax` if they have one panel, and else in
a new figure.

A second picture on the same axes is drawn in the next colour, with `label` as its name. What a reader
wishes otherwise is said to the axes that come back.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Annotated, Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from pydantic import AfterValidator, Field
from xarray import DataArray, Dataset, DataTree

from disc_model.data.dataset import Missing
from disc_model.disc.plate import mode_arrays, mode_shapes, radial_range
from disc_model.errors import Fault, ParameterError, require, suggestion
from disc_model.figures import runs, stability
from disc_model.figures.draw import bar_of, break_label, colours_of, entries, explain, shares
from disc_model.figures.modes import draw_campbell
from disc_model.figures.schema import known_units
from disc_model.figures.shown import label, shown, shown_case
from disc_model.figures.shown import window_of as shown_window
from disc_model.figures.studies import draw_lines, draw_map
from disc_model.parameters import Parameters, require_case
from disc_model.units import Count, Positive, Strict, Unit

USUAL = (
    "basin_fraction_by_energy",
    "basin_fraction",
    "value",
    "growth_rate",
    "outcome",
    "critical_speed",
    "separation_rate",
    "scan_first_separation",
    "exponent",
    "exponents",
    "largest_growth_rate",
    "n_separations",
    "omega",
    "psi",
    "kind",
)
"""Variables of sweeps that are drawn unless another one is asked for: the first that there is, or else
the first of others."""
CLASSES = "attractor_class"  # dimension along which shares of starts add up to one
ROW = 1.4  # height of a row of histories, inch
EDGE = 0.02  # share of a disc's width beside its clamped edge, which is no nodal line
LETTERS = 12.0  # per inch, of a legend in matplotlib's own style


# ---- Arguments and axes


class Wishes(Strict):
    """What a reader may ask of pictures, checked."""

    units: Annotated[dict[str, str], AfterValidator(known_units)] | None = None
    highest: Annotated[Positive, Unit("Hz")] | None = None
    multiples: tuple[Positive, ...] = ()
    most: Annotated[Count, Field(ge=1)] = 1
    variables: Annotated[tuple[str, ...], Field(min_length=1)] = ("P",)
    windows: Annotated[tuple[str, ...], Field(min_length=1)] = ("",)
    variable: str = ""
    x: str = ""


def axes_for(ax: Any) -> Axes:
    """The axes of a reader, or those of a new figure."""
    require((isinstance(ax, Axes | None), "ax", ax, "must be axes of matplotlib"))
    if ax is None:
        return plt.figure(layout="constrained").subplots()
    return ax


def explained(ax: Axes, below: bool = False) -> Axes:
    """Axes with a legend of what has a label, in them or below, and with a long label in lines."""
    break_label(ax, 3)
    if below:
        explain(ax.figure, [ax], LETTERS)
    elif handles := entries([ax]):
        ax.legend(handles.values(), handles.keys())
    return ax


def on_axes(draw: Callable[..., None]) -> Callable[..., Axes]:
    """A picture by a function that draws on axes: on those of a reader or new ones, with a legend."""

    def picture(ax: Any, *drawn: Any, **look: Any) -> Axes:
        ax = axes_for(ax)
        draw(ax, *drawn, **look)
        return explained(ax)

    return picture


# ---- Stability

multipliers = on_axes(stability.draw_multipliers)
eigenvalues = on_axes(stability.draw_eigenvalues)
exponents = on_axes(stability.draw_exponents)
critical = on_axes(stability.draw_critical)
curves = on_axes(stability.draw_curves)


def branch(ax: Any, found: Any, y: str, units: Any, **look: Any) -> Axes:
    """Draw a branch, as `Branch.plot` describes."""
    return on_axes(stability.draw_branch)(ax, found, y, Wishes(units=units).units, **look)


def campbell(study: Any, highest: Any, multiples: Any, units: Any) -> Any:
    """Draw a Campbell diagram, as `disc_model.plot_campbell` describes."""
    is_study = isinstance(study, Dataset) and "crossing_Omega" in study
    require((is_study, "study", study, "must be a study of the quantity campbell"))
    given = Wishes(highest=highest, multiples=multiples, units=units)
    data = shown(study.squeeze(), given.units)
    further = [dim for dim in data.dims if dim not in ("Omega", "mode", "crossing")]
    rule = f"must vary along Omega alone: choose a value, as by {selection(further)}"
    require((not further, "study", ", ".join(map(str, further)), rule))
    options: Any = {"sharex": True, "height_ratios": [3, 2]}
    figure, axes = plt.subplots(2, figsize=(6.4, 6.4), layout="constrained", **options)
    draw_campbell(axes, data, given.highest, given.multiples)
    for ax in axes:
        break_label(ax, 2)
    explain(figure, axes, LETTERS)
    return axes


def modes(case: Any, most: Any) -> Any:
    """Draw the shapes of modes, as `disc_model.plot_modes` describes: from above, with the slider."""
    require_case(case)
    inner, outer = radial_range(case)  # raises an error without shapes
    known = mode_arrays(case)
    count = min(Wishes(most=most).most, known.omega.size)
    require((count > 0, "n_diameters", case.n_diameters, "must be >= 0 for modes"))
    shape = (-(-count // 5), min(count, 5))
    size = (2 * shape[1], 2.2 * shape[0])
    options: Any = {"squeeze": False, "subplot_kw": {"projection": "polar"}}
    _, axes = plt.subplots(*shape, figsize=size, layout="constrained", **options)
    r = np.linspace(inner + EDGE * (outer - inner), outer, 25)
    theta = np.linspace(0, 2 * np.pi, 181)
    shapes = mode_shapes(case, r)
    for ax, i in zip(axes.flat, np.argsort(known.omega)[:count], strict=False):
        values = np.outer(shapes[i], np.cos(known.diameters[i] * theta))
        w = DataArray(values, {"r": r, "theta": theta}, ("r", "theta"))
        end = 1.6 * float(abs(w).max())  # so that lines stay visible
        runs.draw_disc(ax, w, plt.Normalize(-end, end), [0])
        ax.plot(0, case.r_0, "o", ms=3.5)
        frequency = known.omega[i] / (2 * np.pi)
        ax.set_title(f"({known.diameters[i]}, {known.circles[i]})  {frequency:.0f} Hz")
    for spare in axes.flat[count:]:
        spare.set_axis_off()
    return axes.ravel()


# ---- Runs


@contextmanager
def refused(name: str, value: object) -> Iterator[None]:
    """What a run does not hold is a fault of an argument."""
    try:
        yield
    except Missing as reason:
        raise ParameterError(Fault.of((name,), value, f"the run {reason}")) from None


def window_of(case: DataTree, name: Any, which: str = "window", **variables: Any) -> Dataset:
    """A window of a shown run; raises `ParameterError`.

    which : the argument that names the window
    variables : those whose samples it must hold, by the arguments that name them
    """
    with refused(which, name):
        samples = shown_window(case, str(name))
    for argument, variable in variables.items():
        held = isinstance(variable, str) and variable in samples
        require((held, argument, variable, f"is not among the samples of the window {name}"))
    return samples


def history(case: DataTree, windows: Sequence[str], variables: Any, units: Any) -> Any:
    """Draw variables of a run, a row each, in windows, a column each."""
    given = Wishes(windows=windows, variables=variables, units=units)
    case = shown_case(case, given.units)
    samples = [window_of(case, name, "windows") for name in given.windows]
    shape = (len(given.variables), len(samples))
    size = (1.4 + 3.4 * shape[1], 0.9 + ROW * shape[0])
    options: Any = {"sharex": "col", "sharey": "row", "squeeze": False}
    figure, axes = plt.subplots(*shape, figsize=size, layout="constrained", **options)
    with refused("variables", variables):
        for column, each in zip(axes.T, samples, strict=True):
            runs.draw_history(column, each, given.variables)
    runs.mark_first_separation(axes.flat, case)
    for ax in axes.flat:
        ax.margins(x=0)
        ax.label_outer()
        break_label(ax, ROW)
    figure.align_ylabels()
    explain(figure, [*axes.flat], LETTERS)
    return axes.squeeze()[()]


def portrait(case: DataTree, name: Any, x: str, y: str, ax: Any, units: Any, **look: Any) -> Axes:
    """Draw one variable of a run over another, coloured by phase, or in one colour beside others."""
    samples = window_of(shown_case(case, Wishes(units=units).units), name, x=x, y=y)
    ax = axes_for(ax)
    if look or ax.lines:
        ax.plot(samples[x], samples[y], **look)
        ax.set(xlabel=label(samples[x]), ylabel=label(samples[y]))
    else:
        runs.draw_portrait(ax, samples, x, y)
    return explained(ax)


def spectrum(
    case: DataTree, name: Any, variable: str, highest: Any, ax: Any, units: Any, **look: Any
) -> Axes:
    """Draw the amplitude of a variable of a run over the frequency."""
    given = Wishes(highest=highest, units=units)
    samples = window_of(shown_case(case, given.units), name, variable=variable)
    ax = axes_for(ax)
    with refused("window", name):
        runs.draw_spectrum(ax, samples, variable, given.highest, **look)
    return explained(ax)


def poincare(case: DataTree, name: str, units: Any) -> Any:
    """Draw the Poincaré sections of slider and disc."""
    case = shown_case(case, Wishes(units=units).units)
    figure, axes = plt.subplots(1, 2, figsize=(8, 3.8), layout="constrained")
    with refused("window", name):
        runs.draw_sections(axes, case, name)
    figure.suptitle(", ".join(runs.fate_of(case, name)))
    explain(figure, axes, LETTERS)
    return axes


def film(p: Parameters, states: Any, case: DataTree, name: str) -> Any:
    """Make a film of states of a run beside the contact force in a window."""
    return runs.animate(p, states, window_of(shown_case(case), name))


# ---- Sweeps: what is drawn of them


def sweep(study: Any, variable: Any, x: Any, ax: Any, units: Any, **look: Any) -> Axes:
    """Draw a variable of a sweep, as `disc_model.plot_sweep` describes."""
    is_study = isinstance(study, Dataset | DataTree)
    require((is_study, "study", study, "must be an xarray.Dataset"))
    units = Wishes(variable=variable, x=x, units=units).units
    data = study
    if isinstance(study, DataTree):
        data = study.to_dataset()
    single = [dim for dim, size in data.sizes.items() if size == 1 and dim != x]
    data = swapped(data.squeeze(single).compute(), x)
    name = chosen(data, variable, x)
    numbers = number_axes(data, name)
    data = shown(data.sortby(numbers), units)
    named = [str(dim) for dim in data[name].dims if dim in data.coords and dim != CLASSES]
    across = str(x or [*numbers, *named, *data[name].dims][0])
    below = ax is None
    ax = axes_for(ax)
    if across != CLASSES in data[name].dims:
        shares(ax, data[across], data[name], CLASSES)
        ax.set_ylabel(label(data[name]))
    elif x or len(numbers) < 2:
        below = False
        draw_lines(ax, data, name, across, joined=across in study.dims, **look)
    else:
        colours = {**colours_of(data[name]), **look}
        mesh = draw_map(ax, data.transpose(*reversed(numbers), ...), name, **colours)
        if mesh is not None:
            bar_of(ax.figure, ax, mesh, data[name])
    return explained(ax, below)


def swapped(study: Dataset, x: str) -> Dataset:
    """A study along a column of values that vary together, such as paired samples: `x`, or the first of
    numbers along a dimension without values of its own."""
    columns = {name: each.dims[0] for name, each in study.coords.items() if each.ndim == 1}
    numbers = [name for name in columns if study[name].dtype.kind in "fiu"]
    for name in (x, *numbers):
        dim = columns.get(name, name)
        if dim in study.dims and dim != name and (name == x or dim not in study.coords):
            study = study.swap_dims({dim: name})
    if {"exponents_index", "converged_index"} <= {*study.dims}:  # of `lyapunov_exponents`
        along = study["converged"].rename(converged_index="exponents_index")
        study = study.assign(converged=along)
    return study


def chosen(study: Dataset, variable: str, x: str) -> str:
    """The name of the variable that is drawn; raises `ParameterError`."""
    known = [str(name) for name in study.data_vars]
    name = variable or usual_of(study)
    require((name in known, "variable", name, f"unknown variable{suggestion(name, known)}"))
    dims = [str(dim) for dim in study[name].dims]
    others = [dim for dim in dims if dim != x]
    free = others[2 - (x in dims) :]
    rule = f"varies along {', '.join(dims) or 'nothing'}, but must vary along one or two dimensions"
    if free:
        rule += f": choose values of others, as by {selection(free)}"
    real = study[name].dtype.kind != "c"
    require(
        (real, "variable", name, "is complex: draw a part of it, such as abs(...)"),
        (dims and not free, "variable", name, rule),
        (not x or x in dims, "x", x, f"must be one of its dimensions{suggestion(x, dims)}"),
    )
    return name


def usual_of(study: Dataset) -> str:
    """The variable that is drawn unless another one is asked for, "" if none varies."""
    others = study.drop_vars(["status", "message"], errors="ignore").data_vars
    varying = [name for name in (*USUAL, *others, "status") if name in study and study[name].ndim]
    return str([*varying, ""][0])


def selection(dims: Iterable[Any]) -> str:
    """How values along dimensions are chosen."""
    return f"study.sel({', '.join(f'{dim}=...' for dim in dims)})"


def number_axes(study: Dataset, name: str) -> list[str]:
    """Dimensions of a variable that have numbers, which do not only count values at a point of the grid,
    as those of samples do."""
    dims = [str(dim) for dim in study[name].dims if dim in study.coords]
    points = study.get("status", study[name]).dims
    kinds = {dim: study[dim].dtype.kind for dim in dims}
    return [dim for dim, kind in kinds.items() if kind == "f" or (kind in "iu" and dim in points)]
