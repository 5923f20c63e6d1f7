"""The paper's cases and claims under the two normalisations of the modes: as published, and by Eq. (17)."""

import math
from collections.abc import Mapping, Sequence

import pandas as pd

from disc_model.data.dataset import Missing
from disc_model.data.texts import Section, fill
from disc_model.data.variables import values_text
from disc_model.disc.plate import plate_modes
from disc_model.paper import section2
from disc_model.paper.ledger import ROWS
from disc_model.paper.measures import CaseView, rate_text
from disc_model.paper.model import NOT_COMPUTED, judge, read_texts
from disc_model.paper.survival import CONCLUSIONS
from disc_model.parameters import Parameters

TEXTS: dict[str, str] = read_texts("pages.yaml")["normalisation"]


def compare(published: Mapping[str, CaseView], orthonormal: Mapping[str, CaseView]) -> list[Section]:
    """What changes with orthonormal modes, as sections of a page: in the modes, the cases and the verdicts."""
    shared = _once([case for name, case in published.items() if name in orthonormal])
    pairs = {name: (published[name], orthonormal[name]) for name in shared}
    failed = [name for name, pair in pairs.items() if "failed" in (case.status for case in pair)]
    whole = {name: pair for name, pair in pairs.items() if name not in failed}
    separates = {name: tuple(case.separates for case in pair) for name, pair in whole.items()}
    lost, gained, both = (
        [name for name, kind in separates.items() if kind == wanted]
        for wanted in ((True, False), (False, True), (True, True))
    )
    rates = {name: [case.growth_rate for case in pair] for name, pair in whole.items()}
    known = {name: pair for name, pair in rates.items() if not any(map(math.isnan, pair))}
    higher = [name for name, (before, after) in known.items() if after > before]
    text = fill(
        TEXTS["cases"], shared=shared, lost=lost, gained=gained, both=both, known=known, higher=higher, failed=failed
    )
    new = [case for name, case in orthonormal.items() if name not in published]
    return [
        ("The modes", TEXTS["modes"], _modes()),
        ("The cases of the paper", text, _cases(*zip(*pairs.values(), strict=True))),
        *([("Where instability goes instead", TEXTS["instead"], _cases(new))] if new else []),
        ("Statements of the paper whose verdict changes", TEXTS["verdicts"], _verdicts(published, orthonormal)),
    ]


def _once(cases: Sequence[CaseView]) -> list[str]:
    """Names of cases from the static start, without repetitions at another tolerance."""
    names: dict[Parameters, str] = {}
    for case in cases:
        if case.from_rest:
            names.setdefault(case.parameters, case.name)
    return [*names.values()]


def _modes() -> pd.DataFrame:
    models = {", as published": section2.BASE, ", Eq. (17)": section2.BASE.replace(normalization="orthonormal")}
    modes = plate_modes(section2.BASE)
    squares = {f"psi²{which} (1/kg)": plate_modes(p)["psi"].to_numpy() ** 2 for which, p in models.items()}
    before, after = squares.values()
    shifted = {
        f"With slider{which} (rad/s)": [f"{f:.2f}" for f in section2.shifted_frequencies(p)]
        for which, p in models.items()
    }
    return pd.DataFrame(
        {"Nodal diameters": modes["diameters"].astype(str), "Disc alone (rad/s)": modes["omega"].map("{:.2f}".format)}
        | {name: [f"{x:.4f}" for x in values] for name, values in squares.items()}
        | {"ratio": [f"{ratio:.2f}" for ratio in before / after]}
        | shifted
    )


def _cases(cases: Sequence[CaseView], new: Sequence[CaseView] = ()) -> pd.DataFrame:
    """Results of the cases, beside those of the same cases with orthonormal modes if these are given."""
    models = {", as published": cases, ", Eq. (17)": new} if new else {"": cases}
    values = [values_text(dict(case.parameters)) + (", separation ignored" if case.bonded else "") for case in cases]
    return pd.DataFrame(
        {"Case": [case.name for case in cases], "Parameters": values}
        | {f"First separation{which}": [_first(case) for case in those] for which, those in models.items()}
        | {
            f"Growth{which} (1/s)": [rate_text(case.growth_rate, without="–") for case in those]
            for which, those in models.items()
        }
        | {f"P in the end{[*models][-1]} (N)": [_late(case) for case in new or cases]}
    )


def _verdicts(published: Mapping[str, CaseView], orthonormal: Mapping[str, CaseView]) -> pd.DataFrame:
    table = judge([row for row in ROWS if row.cases], {"published": published, "orthonormal": orthonormal})
    old, new = (part.set_index("id") for _, part in table.groupby("model", sort=False))
    changed = (old["verdict"] != new["verdict"]) & (old["verdict"] != NOT_COMPUTED)
    by_model = new.index.isin([row.also for row in CONCLUSIONS])
    columns = {
        "Place": pd.Series({row.id: row.place for row in ROWS}),
        "Statement": pd.Series({row.id: f"“{row.quote}”" for row in ROWS}),
        "As published": old["verdict"],
        "With Eq. (17)": new["verdict"].mask(by_model, "see model sensitivity"),
        "Found with Eq. (17)": new["here"],
    }
    return pd.DataFrame(columns).loc[changed[changed].index]


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
