"""Files that a job reads, and cases put together."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from disc_model.data.inputs import InputsError, each_intact, merge_cases
from disc_model.parameters import Parameters
from disc_model.simulation.case import CaseSpec
from disc_model.studies.cases.run import run_case


def test_inputs_are_read_in_their_order(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).write_text(name)
    assert each_intact(lambda path: path.read_text(), [tmp_path / "b", tmp_path / "a"]) == ["b", "a"]
    with pytest.raises(InputsError, match="not there"):
        each_intact(lambda path: path.read_text(), [tmp_path / "c"])


def test_attributes_of_cases_that_differ_become_a_list() -> None:
    spec = CaseSpec(Parameters(N=1, Omega=0), 0.01, 1e-6, None, (), None, None, energy=False)
    cases = {name: run_case(spec) for name in ("A", "B")}
    for name, tree in cases.items():
        tree.attrs |= {"git_commit": name, "source_hash": "same"}
    merged = merge_cases(cases, {"A": {"title": "first"}})
    assert merged.attrs["source_hash"] == "same"
    assert json.loads(merged.attrs["git_commit"]) == ["A", "B"]
    assert merged["title"].values.tolist() == ["first", ""]
