"""Rules of study files one by one, and merging of batches whose points take no time."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.data.inputs import InputsError, each_intact
from disc_model.figures.grids.kinds import PLOTS
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.studies.cases.merge import merge_cases
from disc_model.studies.cases.run import run_case
from disc_model.studies.cases.schema import parse_study, study_from_config
from disc_model.studies.cases.spec import CaseSpec
from disc_model.studies.faults import StudyError, read_yaml
from disc_model.studies.grids.merge import MergeError, failures, merge_batches
from disc_model.studies.grids.quantities.preparation import prepared
from disc_model.studies.grids.quantities.schema import QUANTITIES, SettlingOptions
from disc_model.studies.grids.run import run_batch
from disc_model.studies.grids.schema import load_grids, parse_grid

#: The slider stays where it is on the disc: nothing has to be computed.
STILL = {"study": "still", "quantity": "floquet", "base": {"k_p": 0}, "axes": {"N": [100, 200], "Omega": [10, 20]}}


def faults_of(parse, *arguments: Any) -> str:
    with pytest.raises(StudyError) as error:
        parse(*arguments)
    return "\n".join(error.value.faults)


def grid(**changes: Any) -> dict[str, Any]:
    return {"study": "x", "quantity": "outcome", "options": {"horizon": 2}, "axes": {"N": [1], "Omega": [1]}} | changes


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"axes": {"N": {"start": 1, "stop": 9, "step": 1, "scale": "log"}}}, "a logarithmic range must give count"),
        ({"axes": {"N": {"start": 0, "stop": 9, "count": 3, "scale": "log"}}}, "a logarithmic range must give count"),
        ({"axes": {"N": {"blocks": [[1]], "step": 2}}}, "axes.N.step = 2: unknown key"),
        ({"axes": {"N": {"blocks": 3}}}, "axes.N.blocks = 3: must be a list of lists or ranges"),
        ({"axes": {}}, "axes: is required: at least one axis or zip"),
        ({"zip": {"rho": [1]}}, "zip.rho: cannot be an axis"),
        ({"zip": {"c": "x"}}, "zip.c = 'x': must be a list of values"),
        ({"zip": {"c": [-1]}}, "zip.c = -1.0: must be >= 0"),
        ({"figures": {"f": {"kind": "critical_speed"}}}, "figures.f.kind = 'critical_speed': needs the quantity"),
        ({"figures": {"f": {"kind": "stability_map", "y": "N"}}}, "figures.f.x"),
        ({"options": {"horizon": 2, "late": 3}}, "late must be <= after_separation and <= horizon"),
    ],
)  # fmt: skip
def test_rules_of_grids(changes: dict[str, Any], fault: str) -> None:
    assert fault in faults_of(parse_grid, grid(**changes))


def span(start: float, stop: float, count: int, **more: Any) -> dict[str, Any]:
    return {"start": start, "stop": stop, "count": count, **more}


@pytest.mark.parametrize(
    ("quantity", "options", "fault"),
    [
        ("critical_speed", {"horizons": [1], "scan": span(1, 9, 3, scale="log")}, "scan must be linear"),
        ("critical_speed", {"horizons": [1], "scan": span(1, 2, 4)}, "must be a multiple of precision"),
        ("hysteresis", {"scan": span(1, 2, 2), "dwell": 1, "late": 2}, "late must be <= dwell"),
        ("stability_curves", {"x_range": [2, 1], "y_lines": span(1, 2, 2)}, "x_range must ascend"),
    ],
)
def test_rules_of_options(quantity: str, options: dict[str, Any], fault: str) -> None:
    axes = {"c": [0]} if quantity == "stability_curves" else {"N": [1]}
    assert fault in faults_of(parse_grid, grid(quantity=quantity, options=options, axes=axes))


@pytest.mark.parametrize("resolution", ["fine", 0, -2, 1.5])
def test_a_resolution_is_a_whole_number(resolution: Any) -> None:
    assert f"resolution = {resolution!r}: must be a whole number >= 1" in faults_of(parse_grid, grid(), resolution)


def test_a_value_belongs_to_the_first_block_that_has_it() -> None:
    repeated = parse_grid(grid(axes={"N": {"blocks": [[1, 2], [2, 1], [3]]}, "Omega": [1]}))
    (dim,) = (dim for dim in repeated.dims if dim.names == ("N",))
    assert [value for (value,) in dim.values] == [1.0, 2.0, 3.0]


def test_names_of_files_and_of_studies_agree(tmp_path: Path) -> None:
    plot = {"kind": "stability_map", "x": "N", "y": "Omega", "others": {"growth": "elsewhere"}}
    for name, raw in (("one", grid(study="two")), ("three", grid(study="three", figures={"f": plot}))):
        (tmp_path / f"{name}.yaml").write_text(json.dumps(raw))
    with pytest.raises(StudyError) as error:
        load_grids([tmp_path / "one.yaml", tmp_path / "three.yaml"], taken=["three"])
    found = str(error.value)
    assert "study = 'two': must be the name of the file" in found
    assert "study = 'three': is the name of another folder of results" in found
    assert "three: figures.f.others.growth = 'elsewhere': no such study" in found


CASE = {"title": "", "parameters": {"N": 1, "Omega": 1}, "t_end": 1}


def recording(**record: Any) -> dict[str, Any]:
    return {"A": CASE | {"record": record}}


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"cases": {"A": 3}}, "cases.A = 3: must be a mapping"),
        ({"cases": {"A": CASE | {"parameters": 3}}}, "cases.A.parameters"),
        ({"cases": recording(events={"last": 1, "start": 0})}, "must give either last, or start and stop"),
        ({"cases": recording(events={"start": 2})}, "cases.A.record.events: must be within the run"),
        ({"cases": recording(windows={"events": {"start": 0, "rate": 1}})}, "a window must not be called so"),
        ({"cases": {"A": CASE}, "figures": 3}, "figures"),
        ({"cases": {"F13": CASE}, "figures": ["fig13", "fig11", "fig99"]}, "figures.2 = 'fig99': unknown figure"),
        ({"cases": {"F13": CASE}, "figures": ["fig13", "fig11"]}, "figures.1 = 'fig11': needs a case F11"),
        ({"cases": {"F13": CASE}, "figures": ["fig13"]}, "figures.0 = 'fig13': needs a window"),
        ({"cases": {"F04": CASE}, "figures": ["fig04"]}, "figures.0 = 'fig04': needs cases.F04.record.poincare"),
        ({"cases": {"1A": CASE}}, "a case's name must be letters"),
        ({"cases": {"status": CASE}}, "the name is taken by a variable"),
    ],
)  # fmt: skip
def test_rules_of_studies_of_cases(changes: dict[str, Any], fault: str) -> None:
    assert fault in faults_of(parse_study, {"study": "x"} | changes)


def test_a_key_given_twice_is_found_behind_a_valid_study(tmp_path: Path) -> None:
    file = tmp_path / "twice.yaml"
    file.write_text("study: x\nstudy: x\n")
    found = faults_of(study_from_config, {"study": "x", "cases": {"A": CASE}}, [file])
    assert "study: given twice" in found


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("&a [*a]", "a value contains itself"),
        ("a: &a [" + "1, " * 500 + "]\nb: &b [" + "*a, " * 500 + "]", "more than 100000 values"),
        ("a: !!timestamp x", "a value does not fit its tag"),
        ("a: [", "line 1, column 5: while parsing a flow node"),
        ("a: 1\nb: 2\n c: 3", "line 3, column 3: mapping values are not allowed here"),
    ],
)
def test_yaml_that_is_refused(text: str, fault: str) -> None:
    assert fault in faults_of(read_yaml, text)


def test_no_document_is_nothing() -> None:
    assert read_yaml("") == (None, [])


def test_every_plot_knows_its_quantity_its_dimensions_and_who_draws_it() -> None:
    needed = {"stability_map": {"x": "N", "y": "Omega"}, "bifurcation": {"x": "Omega"}}
    for kind, plot in PLOTS.items():
        made = plot(kind=kind, **needed.get(kind, {}))
        assert made.quantity in QUANTITIES
        assert made.module.startswith("disc_model.figures.")
        assert set(made.dims) <= {*Parameters.model_fields}
    from disc_model.figures.grids.kinds import Plot

    bare = Plot(kind="none")
    assert bare.dims == ()
    for name in ("quantity", "module"):
        with pytest.raises(NotImplementedError):
            getattr(bare, name)


# ---- batches and merging


@pytest.fixture
def batches() -> list[xr.Dataset]:
    return [run_batch(text) for text in parse_grid(STILL).batches.values()]


def test_merged_points_are_in_the_order_of_the_grid(batches: list[xr.Dataset]) -> None:
    study = parse_grid(STILL)
    merged = merge_batches(batches[::-1], study.grid, {"title": "t"})
    assert dict(merged["status"].sizes) == {"N": 2, "Omega": 2}
    assert merged["N"].values.tolist() == [100, 200]
    assert merged.attrs["title"] == "t"
    lines = list(failures(merged))
    assert len(lines) == 4
    assert lines[0].startswith("N = 100.0, Omega = 10.0: at_rest: ")
    # what raised an error stands before what was found not to be there
    merged["status"].values[1, 0] = merged["status"].attrs["flag_meanings"].split().index("failed")
    assert next(failures(merged)).startswith("N = 200.0, Omega = 10.0: failed")


def test_merging_refuses_what_does_not_fit(batches: list[xr.Dataset]) -> None:
    study = parse_grid(STILL)
    with pytest.raises(MergeError, match="missing: .* and 1 more" if len(batches) == 2 else "missing"):
        merge_batches(batches[1:], study.grid, {})
    with pytest.raises(MergeError, match="there twice"):
        merge_batches([*batches, batches[0]], study.grid, {})
    fewer = parse_grid(STILL | {"axes": {"N": [100], "Omega": [10, 20]}})
    with pytest.raises(MergeError, match="do not belong to the grid"):
        merge_batches(batches, fewer.grid, {})
    odd = [batches[0].assign_coords(sample=("sample", [1, 2])), *batches[1:]]
    odd[0]["extra"] = ("sample", [0.0, 1.0])
    other = batches[-1].assign_coords(sample=("sample", [3, 4]))
    other["extra"] = ("sample", [0.0, 1.0])
    with pytest.raises(MergeError, match="do not fit together"):
        merge_batches([odd[0], other], study.grid, {})


def test_attributes_of_cases_that_differ_become_a_list() -> None:
    spec = CaseSpec(Parameters(N=1, Omega=0), 0.01, 1e-6, None, (), None, None, energy=False)
    cases = {name: run_case(spec) for name in ("A", "B")}
    for name, tree in cases.items():
        tree.attrs |= {"git_commit": name, "source_hash": "same"}
    merged = merge_cases(cases, {"A": {"title": "first"}})
    assert merged.attrs["source_hash"] == "same"
    assert json.loads(merged.attrs["git_commit"]) == ["A", "B"]
    assert merged["title"].values.tolist() == ["first", ""]


def test_inputs_are_read_in_their_order(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).write_text(name)
    assert each_intact(lambda path: path.read_text(), [tmp_path / "b", tmp_path / "a"]) == ["b", "a"]
    with pytest.raises(InputsError, match="not there"):
        each_intact(lambda path: path.read_text(), [tmp_path / "c"])


def test_a_preparation_is_another_motions_end() -> None:
    from disc_model.studies.grids.quantities.schema import BifurcationOptions

    p = Parameters(N=200, Omega=50, n_diameters=1)
    asked = {"transient": 0.1, "samples": 1, "tol": 1e-8}
    assert prepared(p, BifurcationOptions(**asked)) is None
    start = prepared(p, BifurcationOptions(**asked, prepare={"parameters": {"N": 100}, "time": 0.01}))
    expected = simulate(p.replace(N=100), 0.01, tol=1e-8).final_state
    np.testing.assert_array_equal(start.a, expected.a)
    assert start.time == 0


def test_settling_options_have_the_defaults_of_following() -> None:
    assert SettlingOptions().tol == 1e-10
