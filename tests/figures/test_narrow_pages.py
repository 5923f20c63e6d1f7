"""Pictures on a reader's axes in figures as low and narrow as those of a journal's column."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.sizes import PAGE


def directions(up: Any, down: Any) -> xr.Dataset:
    """Ranges on the way up and down of a sweep of the speed."""
    values = ("direction", "Omega"), np.array([up, down]), {"units": "m", "long_name": "range"}
    coords = {"direction": ["up", "down"], "Omega": ("Omega", [8.0, 9.0, 10.0])}
    return xr.Dataset({"range": values}, coords)


def test_no_line_leads_to_a_value_at_the_bound_of_its_search() -> None:
    """Nothing is known of it but that it is there or below, and a gap had no reason."""
    value = {"units": "rad s-1", "long_name": "critical value of speed"}
    data = {
        "value": ("N", [12.0, 12.0, 12.6, 13.4, np.nan], value),
        "at_lower_bound": ("N", np.array([1, 1, 0, 0, 0], dtype=np.int8)),
    }
    attrs = {"function": "critical", "options": '{"bounds": [12, 14.5], "name": "Omega"}'}
    study = xr.Dataset(data, {"N": [280.0, 300.0, 320.0, 340.0, 385.0]}, attrs)
    ax = dm.plot_sweep(study, "value")
    joined = [line for line in ax.lines if line.get_linestyle() == "-"]
    lowest = [float(np.nanmin(line.get_ydata())) for line in joined if len(line.get_xdata())]
    assert min(lowest) > 12.1
    alone = [line for line in ax.lines if line.get_linestyle() == "None"]
    assert any([*line.get_xdata()] == [280.0, 300.0] for line in alone)
    [row] = rows_above(ax)
    assert row.words.get_text() == "none found from 12 to 14.5 rad/s"
    pyplot.close("all")


def named(ax: Any) -> list[str]:
    """What the legend of a panel says, in rows."""
    return [text.get_text().replace("\n", " ") for text in ax.get_legend().get_texts()]


def test_sweeps_are_named_by_options_that_differ_and_by_their_reader() -> None:
    """They were "sweep 1" and "sweep 2", and a label of the case was refused."""
    sweeps = []
    for stays in ("5.0, 5.0", "20.0, 160.0"):
        dwell, longest = stays.split(", ")
        options = f'{{"dwell": {dwell}, "max_dwell": {longest}, "tol": 1e-10}}'
        attrs = {"options": options, "base": '{"N": 300}'}
        found = directions([0.0, 0.1, 1.0], [0.5, 0.7, 0.9])
        sweeps.append(found.assign_attrs(attrs).isel(direction=0, drop=True))
    _, unnamed = pyplot.subplots(figsize=(PAGE, 4))
    for sweep in sweeps:
        dm.plot_sweep(sweep, "range", ax=unnamed)
    assert named(unnamed) == ["stays of 5 s", "stays of 20 to 160 s"]
    _, called = pyplot.subplots(figsize=(PAGE, 4))
    for sweep, name in zip(sweeps, ("short", "long"), strict=True):
        dm.plot_sweep(sweep, "range", ax=called, labels={"case": name})
    assert named(called) == ["short", "long"]
    pyplot.close("all")


def test_the_title_says_how_long_a_sweep_stays_at_each_value() -> None:
    """It was said only where sweeps differ in it."""
    attrs = {"options": '{"dwell": 20.0, "max_dwell": 160.0}', "base": '{"N": 300.0}'}
    sweep = directions([0.0, 0.1, 1.0], [0.5, 0.7, 0.9]).assign_attrs(attrs)
    sweep = sweep.isel(direction=0, drop=True)
    ax = dm.plot_sweep(sweep, "range")
    assert ax.figure.get_suptitle() == "N = 300 N, stays of 20 to 160 s"
    dm.plot_sweep(sweep.assign_attrs(base='{"N": 320.0}'), "range", ax=ax)
    assert ax.figure.get_suptitle() == "stays of 20 to 160 s"
    pyplot.close("all")


def critical_values(function: str, options: str) -> xr.Dataset:
    """Critical speeds over loads, as a function finds them with its options."""
    name = "value" if function == "critical" else "critical_speed"
    attrs = {"units": "rad/s", "long_name": "critical value of angular speed of the disc"}
    speeds = xr.DataArray([13.0, 15.0], dims="N", name=name, attrs=attrs)
    study = speeds.to_dataset().assign_coords(N=[350.0, 385.0])
    return study.assign_attrs(function=function, options=options, base="{}")


def test_critical_speeds_of_two_functions_are_named_by_what_is_sought() -> None:
    """They were named by raw options, such as "max crossings 12" and "points 201"."""
    search = critical_values("critical", '{"name": "Omega", "points": 201, "kind": "stick_slip"}')
    scan = critical_values("critical_speed", '{"horizon": 50.0, "step": 0.5, "max_crossings": 12}')
    longer = critical_values("critical_speed", '{"horizon": 90.0, "step": 0.1, "max_crossings": 9}')
    _, ax = pyplot.subplots(figsize=(PAGE, 4))
    dm.plot_sweep(search, "value", ax=ax)
    dm.plot_sweep(scan, "critical_speed", ax=ax)
    names = ["instability of the stick-slip cycle", "separation, horizon 50 s"]
    assert named(ax) == names
    _, ax = pyplot.subplots(figsize=(PAGE, 4))
    dm.plot_sweep(scan, "critical_speed", ax=ax)
    dm.plot_sweep(longer, "critical_speed", ax=ax)
    both = ["horizon 50 s, steps of 0.5 rad/s, up to 12 crossings"]
    both += ["horizon 90 s, steps of 0.1 rad/s, up to 9 crossings"]
    assert named(ax) == both
    pyplot.close("all")
