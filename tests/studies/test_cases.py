"""Cases put together."""

import json

from disc_model.parameters import Parameters
from disc_model.simulation.api import run_case
from disc_model.simulation.case import CaseSpec
from disc_model.studies.cases import merge_cases


def test_attributes_of_cases_that_differ_become_a_list() -> None:
    spec = CaseSpec(parameters=Parameters(N=1, Omega=0), t_end=0.01, tol=1e-6)
    cases = {name: run_case(spec) for name in ("A", "B")}
    for name, tree in cases.items():
        tree.attrs |= {"git_commit": name, "source_hash": "same"}
    merged = merge_cases(cases, {"A": {"title": "first"}})
    assert merged.attrs["source_hash"] == "same"
    assert json.loads(merged.attrs["git_commit"]) == ["A", "B"]
    assert merged["title"].values.tolist() == ["first", ""]
