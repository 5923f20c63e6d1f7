"""One kind of study file: a grid, named cases, or both, with figures of either."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from disc_model.studies.files import StudyError
from disc_model.studies.schema import load_study, parse_study
from tests.studies.refused import faults_of

ROOT = Path(__file__).parents[2]
GRID: dict[str, Any] = {
    "study": "mine",
    "quantity": "floquet",
    "base": {"N": 200, "Omega": 20},
    "axes": {"mu_s": [0.3, 0.4], "mu_k": [0.1, 0.2, 0.3]},
    "figures": {"growth": {"kind": "heat_map", "variable": "growth_rate", "x": "mu_s", "y": "mu_k"}},
}
CASES: dict[str, Any] = {
    "study": "mine",
    "cases": {
        "A": {
            "title": "one",
            "parameters": {"N": 200, "Omega": 20},
            "t_end": 10,
            "record": {
                "windows": {"whole": {"rate": 100, "envelope": 10}, "late": {"last": 3, "rate": 4000}},
                "poincare": {},
            },
        }
    },
}


def figures(**figure: Any) -> dict[str, Any]:
    """One figure, of a grid's growth if it does not say otherwise."""
    return {"figures": {"f": {"kind": "heat_map", "x": "mu_s", "variable": "period"} | figure}}


def test_a_grid_alone_is_a_study() -> None:
    study = parse_study(GRID)
    assert (study.specs, study.claims, study.figures) == ({}, False, ())
    grids, asked = study.grids()
    assert (grids["mine"].n_points, asked) == (6, ("mine",))


def test_cases_alone_are_a_study_without_claims() -> None:
    study = parse_study(CASES)
    assert (list(study.specs), study.grid, study.claims) == (["A"], None, False)
    assert study.grids() == ({}, ())


def test_a_file_can_say_both_and_figures_of_both() -> None:
    both = GRID["figures"] | {"seen": {"kind": "history", "case": "A", "window": "whole"}}
    study = parse_study(GRID | CASES | {"figures": both})
    assert study.grid is not None
    assert list(study.grid.plots) == ["growth"]
    assert list(study.plots) == ["seen"]
    assert "seen" in study.drawable


def test_the_papers_study_asks_for_claims_and_for_its_figures() -> None:
    study = load_study(ROOT / "config" / "paper.yaml")
    assert study.claims
    assert len(study.figures) == 31
    assert set(study.figures) <= set(study.drawable)


def test_what_is_drawable_has_its_cases_and_windows() -> None:
    """A figure of the paper that a study does not list can still be asked for, if there is all that it needs."""
    assert parse_study(CASES | {"cases": {"F04": CASES["cases"]["A"]}}).drawable == ("fig04",)
    assert parse_study(CASES).drawable == ()


@pytest.mark.parametrize("path", sorted((ROOT / "config" / "studies").rglob("*.yaml")), ids=lambda path: path.stem)
def test_a_file_of_a_grid_is_given_as_it_is(path: Path) -> None:
    """What its figures show besides is found beside it."""
    study = load_study(path)
    grids, names = study.grids([Path(), path.parent])
    assert names == (study.name,)
    assert {other for plot in grids[study.name].plots.values() for other in plot.others.values()} <= grids.keys()


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        ({"axis": {}}, "axis = {}: unknown key, did you mean axes? (known: study, title, base, figures,"),
        ({"base": {"N": 200, "Omega": 20, "mu_s": 0.4}}, "base.mu_s = 0.4: varies as well"),
        ({"study": "bench"}, "study = 'bench': is the name of another folder of results"),
        ({"figures": 3}, "figures = 3: must be a mapping of names to {kind: ...}, or a list of the paper's figures"),
        ({"figures": {"f": {"kind": "heat"}}}, "f.kind = 'heat': unknown kind of figure, did you mean heat_map?"),
        (
            figures(y="mu_k", variable="growth"),
            "figures.f.variable = 'growth': unknown variable, did you mean growth_rate? (known: status,",
        ),
        (
            figures(z="mu_k"),
            "figures.f.z = 'mu_k': unknown key (known: kind, title, others, variable, x, at, by, log, y)",
        ),
        (figures(kind="curve"), "figures.f.at.mu_k: is required, or by: mu_k; one of 0.1, 0.2, 0.3"),
        (figures(kind="curve", at={"mu_k": 0.15}), "figures.f.at.mu_k = 0.15: must be one of 0.1, 0.2, 0.3"),
        (figures(y="mu_s"), "figures.f.y = 'mu_s': must differ from the other dimensions shown"),
        (figures(kind="curve", x="k"), "figures.f.x = 'k': is no dimension of period (known: mu_s, mu_k)"),
        ({"figures": {"f": {"kind": "poincare", "case": "A"}}}, "f.case = 'A': no such case (known: none)"),
        ({"batch": {"sise": 3}}, "batch.sise = 3: unknown key, did you mean size? (known: over, size, tile)"),
    ],
)  # fmt: skip
def test_faults_of_a_grid_are_told_with_what_is_known(changes: dict[str, Any], fault: str) -> None:
    assert fault in "\n".join(faults_of(parse_study, GRID | changes))


@pytest.mark.parametrize(
    ("figure", "fault"),
    [
        ({"kind": "history", "window": "all"}, "is not recorded by case A (known: whole, late, poincare)"),
        ({"kind": "portrait", "window": "whole"}, "window = 'whole': must have no envelope"),
        ({"kind": "spectrogram", "window": "poincare"}, "window = 'poincare': must be a window"),
        ({"kind": "spectrogram", "window": "late", "highest": 3000}, "needs a rate of 6000 Hz or more"),
        ({"kind": "heat_map", "x": "N", "y": "c", "variable": "period"}, "shows a grid, and this study has none"),
        ({"kind": "poincare", "window": "late"}, "window = 'late': must be 'poincare'"),
        ({"kind": "history", "window": "late", "variables": ["v"]}, "variables.0 = 'v'"),
    ],
)  # fmt: skip
def test_faults_of_figures_of_cases(figure: dict[str, Any], fault: str) -> None:
    assert fault in "\n".join(faults_of(parse_study, CASES | {"figures": {"f": {"case": "A", **figure}}}))


def test_keys_inside_a_case_are_told_with_those_that_there_are() -> None:
    case = CASES["cases"]["A"] | {"record": {"windows": {"w": {"rate": 1, "stopp": 2}}}}
    found = "\n".join(faults_of(parse_study, CASES | {"cases": {"A": case}}))
    assert "stopp = 2: unknown key, did you mean stop? (known: start, stop, last, rate, theta, envelope)" in found


def test_what_says_nothing_to_compute_is_refused() -> None:
    (fault,) = faults_of(parse_study, {"study": "mine"})
    assert "must say what to compute: cases, or quantity and axes, or studies" in fault


def test_a_grid_without_what_its_figure_shows_names_what_there_is(tmp_path: Path) -> None:
    path = tmp_path / "map.yaml"
    figure = "{kind: growth_map, others: {curves: elsewhere}}"
    path.write_text(f"study: map\nquantity: floquet\naxes: {{N: [1, 2], Omega: [1, 2]}}\nfigures: {{f: {figure}}}\n")
    study = load_study(path)
    with pytest.raises(StudyError, match=r"'elsewhere': no such study \(known: map\)"):
        study.grids([tmp_path])


def test_a_name_of_two_studies_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("study: mine\nquantity: floquet\naxes: {N: [1, 2], Omega: [1, 2]}\n")
    study = parse_study(CASES | {"studies": ["*.yaml"]})
    with pytest.raises(StudyError, match="is the name of another folder of results"):
        study.grids([tmp_path])
