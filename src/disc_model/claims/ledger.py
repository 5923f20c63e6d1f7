"""The ledger: every claim of the paper, checked; and what changes when the modes are normalised as Eq. (17) says."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.claims import disc, measures, section41, section42, section43, section44
from disc_model.claims.cases import AGAIN
from disc_model.claims.model import HOLDS, NOT_COMPUTED, REMARK, CaseView, Claim, Missing
from disc_model.claims.pages import page, table_html
from disc_model.data.dataset import markdown_table
from disc_model.figures.paper.catalogue import said_parameters
from disc_model.plate import plate_modes, slider_at_rest_frequencies

COLUMNS = ("id", "location", "claim", "paper_value", "ours", "tolerance", "reason", "verdict", "remark")
CLAIMS: tuple[Claim, ...] = tuple(
    found
    for section in (disc, section41, section42, section43, section44)
    for found in vars(section).values()
    if isinstance(found, Claim)
)
"""In the order in which they stand in the files."""


def check_claims(tree: xr.DataTree, scans: Mapping[str, xr.Dataset] | None = None) -> pd.DataFrame:
    """Check every claim: a row per claim, columns `COLUMNS`.

    Parameters
    ----------
    tree : merged cases, see `disc_model.studies.cases`
    scans : merged grid studies by name, of `disc_model.claims.SCANS`; claims that look at others are not computed
    """
    cases = views(tree, scans)
    rows = []
    for claim in CLAIMS:
        found = claim.evaluate(cases)
        said = (claim.id, claim.location, claim.text, claim.paper, found.ours, claim.tolerance, claim.reason)
        rows.append((*said, found.verdict, found.remark))
    return pd.DataFrame(rows, columns=list(COLUMNS))


def views(tree: xr.DataTree, scans: Mapping[str, xr.Dataset] | None = None) -> dict[str, CaseView]:
    """Cases, and grid studies among them, as claims look at them."""
    nodes = dict(tree.children) | {name: xr.DataTree(scan) for name, scan in (scans or {}).items()}
    return {name: CaseView(name, node) for name, node in nodes.items()}


# ----------------------------------------------------------------------------------------------------
# The same cases under both normalisations, side by side


@dataclass(frozen=True)
class Comparison:
    """Sections of a page: heading, text, table."""

    title: str
    sections: tuple[tuple[str, str, pd.DataFrame], ...]

    def markdown(self) -> str:
        lines = [f"# {self.title}", ""]
        for heading, text, table in self.sections:
            lines += [f"## {heading}", "", text, "", *markdown_table(table.columns, table.itertuples(index=False)), ""]
        return "\n".join(lines)

    def html(self) -> str:
        body = [f"<h2>{escape(h)}</h2><p>{escape(text)}</p>{table_html(table)}" for h, text, table in self.sections]
        return page(self.title, *body)


def compare(published: xr.DataTree, orthonormal: xr.DataTree) -> Comparison:
    """Compare merged cases (see `disc_model.data.dataset`) of the two normalisations."""
    old, new = views(published), views(orthonormal)
    shared = [name for name in old if name in new and name not in AGAIN]
    failed = [name for name in shared if "failed" in (old[name].status, new[name].status)]
    lost = [name for name in shared if name not in failed and old[name].separates and not new[name].separates]
    gained = [name for name in shared if name not in failed and new[name].separates and not old[name].separates]
    both = [name for name in shared if new[name].separates and old[name].separates]
    text = (
        f"Of {len(shared)} cases of the paper, {len(lost) + len(both)} separate with the modes as published and "
        f"{len(both) + len(gained)} with normalised ones. No longer: {_listed(lost)}. At another time: "
        f"{_listed(both)}. Only now: {_listed(gained)}. Growth is that of the stick-slip cycle; a dash means that "
        "no such cycle was found near the published start, or that nothing was recorded."
    )
    if failed:
        text += f" Without a result: {_listed(failed)}."
    only = [case for name, case in new.items() if name not in old]
    instead = [("Where instability goes instead", _INSTEAD, _elsewhere(only))] if only else []
    sections = (
        ("The modes", _MODES_TEXT, _modes()),
        ("The cases of the paper", text, _cases([old[name] for name in shared], [new[name] for name in shared])),
        *instead,
        ("Statements of the paper whose verdict changes", _VERDICTS, _verdicts(published, orthonormal)),
    )
    return Comparison("What changes when the modes are normalised as Eq. (17) says", sections)


_MODES_TEXT = (
    "The published numbers come from mode shapes R scaled so that the coefficient of J_l is 1; Eq. (17) asks for "
    "2π/b² ∫ R² r dr = 1. What matters for the dynamics is psi_l², the modal amplitude under the slider: the modes "
    "with one nodal diameter take part far too strongly as published, the others too weakly. The frequencies of the "
    "disc are the same, those with the slider attached are not."
)
_INSTEAD = (
    "Higher speeds and loads, from the same start: with normalised modes the stick-slip cycle is stable, or grows far "
    "more slowly, where the paper works; separation follows further up. At large loads and low speeds the vibration is "
    "unstable and stays in contact."
)
_VERDICTS = "Judged by the same checks; statements about single times of the published cases are among them."


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"


def _modes() -> pd.DataFrame:
    both = [disc.BASE.replace(normalization=name) for name in ("as_published", "orthonormal")]
    modes = plate_modes(both[0])
    omega = modes["omega"].to_numpy()
    squares = [plate_modes(p)["psi"].to_numpy() ** 2 for p in both]
    attached = [slider_at_rest_frequencies(p) for p in both]
    shifted = [[f"{f:.2f}" for f in found if np.min(np.abs(f - omega)) > 1e-6 * f] for found in attached]
    return pd.DataFrame(
        {
            "Nodal diameters": [str(n) for n in modes["diameters"]],
            "Disc alone (rad/s)": [f"{f:.2f}" for f in omega],
            "psi², as published (1/kg)": [f"{x:.4f}" for x in squares[0]],
            "psi², Eq. (17) (1/kg)": [f"{x:.4f}" for x in squares[1]],
            "ratio": [f"{ratio:.2f}" for ratio in squares[0] / squares[1]],
            "With slider, as published (rad/s)": shifted[0],
            "With slider, Eq. (17) (rad/s)": shifted[1],
        }
    )


def _cases(old: list[CaseView], new: list[CaseView]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "Case": [case.name for case in old],
            "Parameters": [_said(case) for case in old],
            "First separation, as published": [_first(case) for case in old],
            "First separation, Eq. (17)": [_first(case) for case in new],
            "Growth, as published (1/s)": [_growth(case) for case in old],
            "Growth, Eq. (17) (1/s)": [_growth(case) for case in new],
            "P in the end, Eq. (17) (N)": [_late(case) for case in new],
        }
    )


def _elsewhere(cases: list[CaseView]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "Case": [case.name for case in cases],
            "Parameters": [_said(case) for case in cases],
            "First separation": [_first(case) for case in cases],
            "Growth (1/s)": [_growth(case) for case in cases],
            "P in the end (N)": [_late(case) for case in cases],
        }
    )


def _verdicts(published: xr.DataTree, orthonormal: xr.DataTree) -> pd.DataFrame:
    old, new = check_claims(published), check_claims(orthonormal)
    merged = old.merge(new, on="id", suffixes=("", "_new"))
    kinds = [merged[name].replace(REMARK, HOLDS) for name in ("verdict", "verdict_new")]
    judged = ~(kinds[0] + kinds[1]).str.contains(NOT_COMPUTED)
    kept = merged[judged & (kinds[0] != kinds[1])]
    return pd.DataFrame(
        {
            "Statement": [f"{row.id}: {row.claim}" for row in kept.itertuples()],
            "As published": kept["verdict"],
            "With Eq. (17)": kept["verdict_new"],
            "Found with Eq. (17)": kept["ours_new"],
        }
    )


def _said(case: CaseView) -> str:
    p = case.parameters
    return said_parameters(p) + (", separation ignored" if p.contact == "bonded" else "")


def _first(case: CaseView) -> str:
    time = case["first_separation"]
    if case.status == "failed":
        return "failed"
    if case.parameters.contact == "bonded":
        return "ignored"
    return f"none in {case['time_reached']:g} s" if math.isnan(time) else f"{time:.2f} s"


def _growth(case: CaseView) -> str:
    return measures.said_rate(measures.growth_or_nan(case.parameters), without="–")


def _late(case: CaseView) -> str:
    try:
        return measures.late_range(case, "P").said(1)
    except Missing:
        return "–"
