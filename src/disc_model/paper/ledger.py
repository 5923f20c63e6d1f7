"""The ledger: a check of every claim of the paper, and a comparison of the two normalisations of Eq. (17)."""

import math
from collections.abc import Mapping, Sequence

import pandas as pd
import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.data.variables import values_text
from disc_model.paper import disc, measures, section41, section42, section43, section44, survival
from disc_model.paper.measures import CaseView
from disc_model.paper.model import HOLDS, NOT_COMPUTED, REMARK, claims
from disc_model.paper.pages import TEXTS, Comparison
from disc_model.parameters import Parameters
from disc_model.plate import plate_modes

CLAIMS = claims(disc, section41, section42, section43, section44)
"""All claims, in the order of the files."""


def check_claims(tree: xr.DataTree, scans: Mapping[str, xr.Dataset] | None = None) -> pd.DataFrame:
    """Check every claim: a row per claim.

    Parameters
    ----------
    tree : merged cases, see `disc_model.studies.cases`
    scans : merged grid studies by name, of `disc_model.paper.SCANS`; claims that need missing ones are not computed
    """
    cases = views(tree, scans)
    rows = []
    for claim in CLAIMS:
        found, turned = claim.settle(lambda one, *changed: one.evaluate(cases, *changed))
        row = {
            "id": claim.id,
            "location": claim.location,
            "claim": claim.claim,
            "paper_value": claim.fill(claim.paper),
            "ours": found.ours,
            "tolerance": claim.fill(claim.tolerance),
            "reason": claim.reason,
            "verdict": found.verdict,
            "remark": found.remark,
            "apart": claim.apart,
            "robust": turned,
        }
        rows.append(row)
    return pd.DataFrame(rows)


def views(tree: xr.DataTree, scans: Mapping[str, xr.Dataset] | None = None) -> dict[str, CaseView]:
    """Views of the cases and grid studies for the checks."""
    nodes = dict(tree.children) | {name: xr.DataTree(scan) for name, scan in (scans or {}).items()}
    return {name: CaseView(name, node) for name, node in nodes.items()}


# ----------------------------------------------------------------------------------------------------
# Comparison of the cases under both normalisations


def compare(published: xr.DataTree, orthonormal: xr.DataTree) -> Comparison:
    """Compare merged cases (see `disc_model.data.dataset`) of the two normalisations."""
    texts, old, new = TEXTS["normalisation"], views(published), views(orthonormal)
    shared = _once([case for name, case in old.items() if name in new])
    failed = [name for name in shared if "failed" in (old[name].status, new[name].status)]
    whole = [name for name in shared if name not in failed]
    lost, gained, both = (
        [name for name in whole if (old[name].separates, new[name].separates) == kind]
        for kind in ((True, False), (False, True), (True, True))
    )
    text = texts["cases"].format(
        shared=len(shared), before=len(lost + both), after=len(both + gained),
        lost=_listed(lost), both=_listed(both), gained=_listed(gained),
    )  # fmt: skip
    rates = {name: [each[name].growth_rate for each in (old, new)] for name in whole}
    known = {name: pair for name, pair in rates.items() if not any(map(math.isnan, pair))}
    higher = [name for name, (before, after) in known.items() if after > before]
    text += texts["growth"].format(known=len(known), lower=len(known) - len(higher), higher=_listed(higher))
    if failed:
        text += texts["failed"].format(failed=_listed(failed))
    only = [case for name, case in new.items() if name not in old]
    sections = [
        ("The modes", texts["modes"], _modes()),
        ("The cases of the paper", text, _cases([old[name] for name in shared], [new[name] for name in shared])),
    ]
    if only:
        sections.append(("Where instability goes instead", texts["instead"], _cases(only)))
    changed = _verdicts(published, orthonormal)
    sections.append(("Statements of the paper whose verdict changes", texts["verdicts"], changed))
    return Comparison(texts["title"], tuple(sections))


def _once(cases: Sequence[CaseView]) -> list[str]:
    """Names of cases from the static start, without repetitions at another tolerance."""
    names: dict[Parameters, str] = {}
    for case in cases:
        if case.from_rest:
            names.setdefault(case.parameters, case.name)
    return [*names.values()]


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"


def _modes() -> pd.DataFrame:
    both = [disc.BASE.replace(normalization=name) for name in ("as_published", "orthonormal")]
    modes = plate_modes(both[0])
    omega = modes["omega"].to_numpy()
    squares = [plate_modes(p)["psi"].to_numpy() ** 2 for p in both]
    shifted = [[f"{f:.2f}" for f in disc.shifted_frequencies(p)] for p in both]
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


def _cases(cases: Sequence[CaseView], new: Sequence[CaseView] = ()) -> pd.DataFrame:
    """Results of the cases, beside those of the same cases with orthonormal modes if these are given."""
    pairs = {", as published": cases, ", Eq. (17)": new} if new else {"": cases}
    given = [values_text(dict(case.parameters)) + (", separation ignored" if case.bonded else "") for case in cases]
    table = {"Case": [case.name for case in cases], "Parameters": given}
    table |= {f"First separation{which}": [_first(case) for case in those] for which, those in pairs.items()}
    table |= {
        f"Growth{which} (1/s)": [measures.rate_text(case.growth_rate, without="–") for case in those]
        for which, those in pairs.items()
    }
    table[f"P in the end{[*pairs][-1]} (N)"] = [_late(case) for case in new or cases]
    return pd.DataFrame(table)


def _verdicts(published: xr.DataTree, orthonormal: xr.DataTree) -> pd.DataFrame:
    old, new = map(check_claims, (published, orthonormal))
    merged = old.merge(new, on="id", suffixes=("", "_new"))
    kinds = [merged[name].replace(REMARK, HOLDS) for name in ("verdict", "verdict_new")]
    judged = ~(kinds[0] + kinds[1]).str.contains(NOT_COMPUTED)
    kept = merged[judged & (kinds[0] != kinds[1])]
    by_model = kept["id"].isin([one.also for one in survival.CONCLUSIONS])
    return pd.DataFrame(
        {
            "Statement": [f"{row.id}: {row.claim}" for row in kept.itertuples()],
            "As published": kept["verdict"],
            "With Eq. (17)": kept["verdict_new"].mask(by_model, "see model sensitivity"),
            "Found with Eq. (17)": kept["ours_new"],
        }
    )


def _first(case: CaseView) -> str:
    time = case["first_separation"]
    if case.status == "failed":
        return "failed"
    if case.bonded:
        return "ignored"
    return f"none in {case['time_reached']:g} s" if math.isnan(time) else f"{time:.2f} s"


def _late(case: CaseView) -> str:
    try:
        return f"{case.late:.1f}"
    except Missing:
        return "–"
