"""Figures: data in readers' units, five ways to draw them, and the figures made of these.

Here is what a reader calls, which imports matplotlib when something is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from disc_model.display import drawings

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from disc_model.parameters import Parameters


def plot_sweep(
    study: xr.Dataset | xr.DataTree,
    variable: str = "",
    x: str = "",
    *,
    ax: Axes | None = None,
    units: Mapping[str, str] | None = None,
    **look: Any,
) -> Axes:
    """Draw a variable of a sweep or of a grid study: a line along one dimension, or colours over
    two.

    Over two dimensions of numbers, the first along the horizontal axis, it is a map; with `x` it is a line for each
    value of the other dimension, and so are words, such as the direction of a sweep. Where a variable has several
    values at each point, such as the samples of `bifurcation`, or more than 12 lines, all are points. Shares of starts
    are stacked bars. Paired samples are points over one of their columns. "What marks say" in the page "Compute many
    cases at once" of the documentation has the rules.

    Parameters
    ----------
    study : such as `disc_model.sweep`, `run_study`, `hysteresis` and `basins` return. Of a variable of three
        dimensions choose values first, as by ``study.sel(N=385)``
    variable : if not given, the shares of starts, the growth rate, the outcome, the critical speed, or the first
        that there is but the status
    x : the dimension, or the column of paired values or of their names, along the horizontal axis
    ax : axes to draw on; a second line there has the next colour. In a new figure without them
    units : by the names of parameters or sampled variables, such as ``{"Omega": "rpm", "P": "kN"}``
    look : options of matplotlib for lines (``label="soft spring"``), or for colours of numbers (``cmap="viridis"``,
        ``norm=plt.Normalize(0, 2)``)

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

    A line for each preload, in place of a map, over rotations per minute:

    >>> grid = dm.sweep(dm.floquet, dm.Parameters(N=300, Omega=15), Omega=[10, 12, 14], N=[350, 400])
    >>> ax = dm.plot_sweep(grid, "growth_rate", x="Omega", units={"Omega": "rpm"})
    >>> ax.get_xlabel(), [text.get_text() for text in ax.get_legend().get_texts()][:2]
    ('Speed Ω (rpm)', ['N = 350 N', 'N = 400 N'])
    """
    axes: Axes = drawings().sweep(study, variable, x, ax, units, **look)
    return axes


def plot_campbell(
    study: xr.Dataset,
    *,
    highest: float | str | None = None,
    multiples: Sequence[float] = (),
    units: Mapping[str, str] | None = None,
) -> NDArray[Any]:
    """Draw a Campbell diagram: frequencies of steady sliding over the speed, above growth rates of the
    stick-slip cycle.

    Lines are thick where a mode of steady sliding grows. Speeds without a cycle are shaded, with what there is in its
    place. The table of the study has all crossings.

    Parameters
    ----------
    study : of `campbell`, along the speed alone
    highest : Hz, or with a unit, such as "3 kHz": upper end of the axis of frequencies; all of them if not given
    multiples : such as ``[2, 2.5]``: these multiples of the stick-slip frequency are drawn, too
    units : as in `plot_sweep`, such as ``{"Omega": "rpm"}``

    Returns
    -------
    array of two Axes, that of frequencies first

    Raises
    ------
    ParameterError
        If an argument breaks a rule, or the study varies along a further axis.

    Examples
    --------
    >>> import disc_model as dm
    >>> study = dm.campbell(dm.Parameters(N=385, Omega=10), bounds=(10, 10.2), step=0.01)
    >>> frequencies, rates = dm.plot_campbell(study, highest=400, multiples=[2, 3])
    >>> rates.get_xlabel()
    'Speed Ω (rad/s)'
    """
    axes: NDArray[Any] = drawings().campbell(study, highest, multiples, units)
    return axes


def plot_modes(case: Parameters, most: int = 15) -> NDArray[Any]:
    """Draw the shapes of the modes of a case from above, with their nodal lines and frequencies.

    Parameters
    ----------
    case : the case; a disc that is given by its modes needs shapes at two radii or more
    most : number of modes that are drawn, by ascending frequency

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
    axes: NDArray[Any] = drawings().modes(case, most)
    return axes
