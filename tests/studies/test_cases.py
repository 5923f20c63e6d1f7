"""Cases put together."""

from __future__ import annotations

import json

from disc_model.parameters import Parameters
from disc_model.simulation.api import run_case
from disc_model.simulation.case import CaseSpec
from disc_model.studies.cases import merge_cases


def test_attributes_of_cases_that_differ_become_a_list() -> None:
    spec = CaseSpec(Parameters(N=1, Omega=0), 0.01, 1e-6, None, (), None, None, energy=False)
    cases = {name: run_case(spec) for name in ("A", "B")}
    for name, tree in cases.items():
        tree.attrs |= {"git_commit": name, "source_hash": "same"}
    merged = merge_cases(cases, {"A": {"title": "first"}})
    assert merged.attrs["source_hash"] == "same"
    assert json.loads(merged.attrs["git_commit"]) == ["A", "B"]
    assert merged["title"].values.tolist() == ["first", ""]
