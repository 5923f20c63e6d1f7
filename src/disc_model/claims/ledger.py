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
from disc_model.parameters import Parameters
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
    tree : merged cases, see `disc_model.simulation.api`
    scans : merged grid studies by name, of `disc_model.claims.SCANS`; claims that look at others are not computed
    """
    cases = _views(dict(tree.children) | {name: xr.DataTree(scan) for name, scan in (scans or {}).items()})
    rows = []
    for claim in CLAIMS:
        found = claim.evaluate(cases)
        said = (claim.id, claim.location, claim.text, claim.paper, found.ours, claim.tolerance, claim.reason)
        rows.append((*said, found.verdict, found.remark))
    return pd.DataFrame(rows, columns=list(COLUMNS))


# ----------------------------------------------------------------------------------------------------
# The same cases under both normalisations, side by side

BASE = Parameters(N=200, Omega=20)
MODES = ("as_published", "orthonormal")


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


def _views(nodes: Mapping[str, xr.DataTree]) -> dict[str, CaseView]:
    return {name: CaseView(name, node) for name, node in nodes.items()}


def compare(published: xr.DataTree, orthonormal: xr.DataTree) -> Comparison:
    """Compare merged cases (see `disc_model.data.dataset`) of the two normalisations."""
    old, new = _views(published.children), _views(orthonormal.children)
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
    only = [name for name in new if name not in old]
    sections = [
        ("The modes", _MODES_TEXT, _modes()),
        ("The cases of the paper", text, _cases(old, new, shared)),
    ]
    if only:
        sections.append(("Where instability goes instead", _INSTEAD, _elsewhere(new, only)))
    sections.append(("Statements of the paper whose verdict changes", _VERDICTS, _verdicts(published, orthonormal)))
    return Comparison("What changes when the modes are normalised as Eq. (17) says", tuple(sections))


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
    modes = {name: plate_modes(BASE.replace(normalization=name)) for name in MODES}
    squares = {name: frame["psi"].to_numpy() ** 2 for name, frame in modes.items()}
    attached = {name: slider_at_rest_frequencies(BASE.replace(normalization=name)) for name in MODES}
    disc = modes[MODES[0]]["omega"].to_numpy()
    shifted = {name: [f for f in values if np.min(np.abs(f - disc)) > 1e-6 * f] for name, values in attached.items()}
    return pd.DataFrame(
        {
            "Nodal diameters": [str(n) for n in modes[MODES[0]]["diameters"]],
            "Disc alone (rad/s)": [f"{f:.2f}" for f in disc],
            "psi², as published (1/kg)": [f"{x:.4f}" for x in squares[MODES[0]]],
            "psi², Eq. (17) (1/kg)": [f"{x:.4f}" for x in squares[MODES[1]]],
            "ratio": [f"{a / b:.2f}" for a, b in zip(*squares.values(), strict=True)],
            "With slider, as published (rad/s)": [f"{f:.2f}" for f in shifted[MODES[0]]],
            "With slider, Eq. (17) (rad/s)": [f"{f:.2f}" for f in shifted[MODES[1]]],
        }
    )


def _cases(old: dict[str, CaseView], new: dict[str, CaseView], names: list[str]) -> pd.DataFrame:
    rows = []
    for name in names:
        rows.append(
            {
                "Case": name,
                "Parameters": _said(old[name].parameters),
                "First separation, as published": _first(old[name]),
                "First separation, Eq. (17)": _first(new[name]),
                "Growth, as published (1/s)": _growth(old[name]),
                "Growth, Eq. (17) (1/s)": _growth(new[name]),
                "P in the end, Eq. (17) (N)": _late(new[name]),
            }
        )
    return pd.DataFrame(rows)


def _elsewhere(new: dict[str, CaseView], names: list[str]) -> pd.DataFrame:
    rows = [
        {
            "Case": name,
            "Parameters": _said(new[name].parameters),
            "First separation": _first(new[name]),
            "Growth (1/s)": _growth(new[name]),
            "P in the end (N)": _late(new[name]),
        }
        for name in names
    ]
    return pd.DataFrame(rows)


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


def _said(p: Parameters) -> str:
    return said_parameters(p) + (", separation ignored" if p.contact == "bonded" else "")


def _first(case: CaseView) -> str:
    time = case["first_separation"]
    if case.status == "failed":
        return "failed"
    if case.parameters.contact == "bonded":
        return "ignored"
    return f"none in {case['time_reached']:g} s" if math.isnan(time) else f"{time:.2f} s"


def _growth(case: CaseView) -> str:
    try:
        return f"{measures.growth_rate(case):+.4f}"
    except Missing:
        return "–"


def _late(case: CaseView) -> str:
    try:
        late = measures.late_range(case, "P")
    except Missing:
        return "–"
    return f"{late.low:.1f}..{late.high:.1f}"
