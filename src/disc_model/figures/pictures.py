"""Pictures of studies and of modes: what a reader calls, without matplotlib before something is
drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from disc_model.display import draw

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from numpy.typing import NDArray

    from disc_model.parameters import Parameters


def plot_sweep(  # noqa: PLR0913
    study: xr.Dataset | xr.DataTree,
    variable: str | Sequence[str] = "",
    x: str = "",
    *,
    lines: str | Literal[False] = "",
    points: bool = False,
    log: bool | None = None,
    cmap: str | Colormap | None = None,
    limits: tuple[float, float] | None = None,
    ax: Axes | None = None,
    legend: bool | Mapping[str, Any] = True,
    labels: Mapping[str, str] | None = None,
    title: str | bool | None = None,
    units: Mapping[str, str] | None = None,
) -> Axes:
    """Draw a variable of a sweep or of a grid study: a line along one dimension, or colours over
    two.

    Where one of two dimensions has three values or fewer, each of these has a line. Where a variable has
    several values at each point, such as the samples of `bifurcation` or an array that a function of
    your own returns, all are points over what varies, as in a bifurcation diagram, where a strip says what kind
    of motion each column is of. Values that vary together, such as paired samples, are points over one of their
    columns, which may be that of their names. A second dimension of words or of discs, such as the direction of a
    sweep, gives a line for each. What starts come to is drawn as bars of their shares, at each energy or along a
    parameter. An axis is logarithmic if three or more positive values span a decade or more and have equal ratios
    within 1e-6, as those of `numpy.geomspace`.

    Rings, filled marks and hatched cells are of values in doubt. A line of growth rates of cycles is open where
    the next point may be of another cycle. Marks on a grey strip above the panel are of points without a value.
    "What marks say" in the page "Compute many cases at once" of the documentation has the rules.

    Parameters
    ----------
    study : such as `disc_model.sweep`, `run_study`, `hysteresis` and `basins` return; of one or two dimensions of
        several values, beside one that only counts the values of a variable at each point. Over two dimensions, such
        values have marks of their own for each value of `lines`
    variable : one, or a list of variables that are lines of one unit, such as ``["onset_speed", "offset_speed"]`` of
        `hysteresis`; if not given, the shares of starts, the growth rate, the outcome, the largest Lyapunov exponent,
        the number of separations of `simulate`, the lowest coupled frequency, the angle ψ of the samples of
        `bifurcation`, or the first number there is
    x : the dimension, or the column of paired values or names, along the horizontal axis; if not given, the first of
        numbers, or the one with more values if the other has three or fewer. Over a dimension beside paired samples,
        each of these has a line: up to six are named, and more are thin
    lines : a second dimension that gives a line for each of its values, where two dimensions of numbers would be a map;
        False for a map of them also where one has few values, which `cmap` asks for as well. Of
        `basin_fraction_by_energy`, `lines="energy"` draws the share of each energy that separates
    points : whether all values at each place along the axis are points that no line joins, as in a bifurcation diagram
        of the turns that a function of your own returns
    log : whether the scale of the variable is logarithmic: on both sides of zero if some values are negative or zero,
        and then linear up to its least size, or to a thousandth of the greatest if that is more. If not given, growth
        rates beyond 0.3/s have such a scale, linear up to 0.1/s, unless they are of one sign and within a factor of
        two, and all else a linear one
    cmap : another colour map of matplotlib for a map of numbers, from the least of them to the greatest; colours with a
        middle, such as "RdBu_r", have it at zero if numbers have both signs. The usual colours of growth rates have it
        there in any case. Classes have the same colours in all pictures
    limits : ends of the axis of a variable that is drawn as lines, or of the bar of colours, in the unit that its label
        says, such as ms of a period; the legend says which lines lie outside. Without them colours of growth rates end
        at 0.3/s, or, if most rates are larger, beyond 98 % of them
    ax, legend, labels, title : as in `Result.plot`; `labels` also takes other words for the bar of colours, by
        "bar", and names of lines, by their variable, or by "case" for all of them. On axes that have lines of a
        sweep, those of another case, or of another variable of the same unit, get a colour and dashes of their own,
        and the legend names all by what differs; words along the axis are those of all. Bars and maps are not drawn
        over each other. Usual labels are the attributes `long_name` and `units` of a variable or coordinate, which are
        yours to set. In a figure without a layout engine, such as plain ``pyplot.subplots()`` makes, margins
        are widened, as by ``figure.subplots_adjust``, until labels, bar and legend lie on the page. Strips keep
        their words with ``legend=False``
    units : units in which values are drawn and said, by the names of parameters or sampled variables, such as
        ``{"Omega": "rpm", "P": "kN"}``; as `units` of a figure in a study. Without them, a coordinate of a parameter
        is drawn in the unit that its attribute `units` says

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        If an argument breaks a rule, more than two dimensions vary, or axes show another quantity already.

    Examples
    --------
    >>> import disc_model as dm
    >>> growth = dm.sweep(dm.floquet, dm.Parameters(N=300, Omega=15), Omega=[10, 12, 14])
    >>> dm.plot_sweep(growth).get_xlabel()
    'Speed Ω (rad/s)'

    A line for each preload, in place of a map, over rotations per minute:

    >>> grid = dm.sweep(dm.floquet, dm.Parameters(N=300, Omega=15), Omega=[10, 12, 14], N=[300, 400])
    >>> ax = dm.plot_sweep(grid, "growth_rate", x="Omega", lines="N", units={"Omega": "rpm"})
    >>> ax.get_xlabel(), [text.get_text() for text in ax.figure.legends[0].get_texts()]
    ('Speed Ω (rpm)', ['Preload N = 300 N', '400 N'])
    """
    looks = {"lines": lines, "points": points, "log": log, "cmap": cmap, "limits": limits}
    wishes = {"ax": ax, "legend": legend, "labels": labels, "title": title, "units": units}
    return draw("plot_sweep", study, variable, x, **looks, **wishes)


def plot_campbell(
    study: xr.Dataset,
    *,
    highest: float | str | None = None,
    multiples: Sequence[float] | None = None,
    ax: Axes | NDArray[Any] | None = None,
    legend: bool | Mapping[str, Any] = True,
    labels: Mapping[str, str] | None = None,
    title: str | bool | None = None,
    units: Mapping[str, str] | None = None,
) -> NDArray[Any]:
    """Draw a Campbell diagram: frequencies of steady sliding over the speed, above growth rates of the
    stick-slip cycle.

    At the five highest peaks of growth at most are the multiples of a frequency that meet a mode there; a peak
    without such a crossing is a diamond. One beside a step over which the line is open is hollow. All other crossings
    are in the table of the study only, unless `multiples` asks for their lines. Lines are thick and red where a mode
    of steady sliding grows. Speeds without a cycle are shaded, with what there is in its place, such as "unstable
    steady sliding". What lies above `highest` is said: a dotted edge is where modes go on, and a triangle on it is at
    the speed of a crossing above it.

    Parameters
    ----------
    study : of ``quantity: campbell``, such as `run_study` returns; one further axis, such as two preloads, has a
        column of panels for each of up to six values
    highest : Hz, or with a unit, such as "3 kHz": upper end of the axis of frequencies; all of them if not given
    multiples : whole numbers or halves, such as ``[2, 2.5]``: these multiples of the stick-slip frequency are drawn
        at all speeds with a cycle near the motion, open where it jumps, with marks where modes cross them: filled
        where a growth rate rises there. ``crossing_effect`` of the study says more
    ax : two axes to draw on, that of frequencies first, without another Campbell diagram; of a further axis, two
        for each of its values, those of frequencies first
    legend, labels, title : as in `Result.plot`
    units : as in `plot_sweep`, such as ``{"Omega": "rpm"}``

    Returns
    -------
    array of two Axes; with a further axis, of two rows of Axes, frequencies in the first

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the study varies along two further axes, or has more values along one.

    Examples
    --------
    >>> import disc_model as dm
    >>> axes = {"Omega": {"start": 10, "stop": 10.2, "step": 0.01}}
    >>> study = dm.run_study({"study": "c", "quantity": "campbell", "base": {"N": 385}, "axes": axes})
    >>> frequencies, rates = dm.plot_campbell(study, highest=400)
    >>> rates.get_xlabel()
    'Speed Ω (rad/s)'

    Twice and three times the stick-slip frequency, and the modes that cross them:

    >>> frequencies, _ = dm.plot_campbell(study, highest=400, multiples=[2, 3])
    >>> [text.get_text()[0] for text in frequencies.texts if "f_s" in text.get_text()]
    ['2', '3']
    """
    wishes = {"ax": ax, "legend": legend, "labels": labels, "title": title, "units": units}
    return draw("plot_campbell", study, highest=highest, multiples=multiples, **wishes)


def plot_modes(
    case: Parameters,
    most: int = 15,
    *,
    ax: Axes | NDArray[Any] | None = None,
    labels: Mapping[str, str] | None = None,
    title: str | bool | None = None,
) -> NDArray[Any]:
    """Draw the shapes of the modes of a case from above, with their nodal lines and frequencies.

    Parameters
    ----------
    case : the case; a disc that is given by its modes needs shapes at two radii or more
    most : number of modes that are drawn, by ascending frequency
    ax : axes to draw on, one for each mode, without other modes
    labels : as in `Result.plot`
    title : of a new figure; "" or False for none

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
    return draw("plot_modes", case, most, ax=ax, labels=labels, title=title)
