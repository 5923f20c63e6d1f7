"""Sentences of the ledger and columns of its tables have their numbers in the units that they name.

The evidence is made up: its quantities are known in SI units.
"""

import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model.data.texts import fill
from tests.figures.measured import UREG
from workflow.paper import TABLE_CASES, measures, section41, section43
from workflow.paper.judging_tables import COMPLIANT, ENERGIES, POWERS
from workflow.paper.ledger import ROWS
from workflow.paper.measures import Range
from workflow.paper.paper_tables import impact_law

BY_NAME = {row.id: row for row in ROWS}
NUMBER = r"(-?\d+(?:\.\d+)?)"


def row_of(check: str) -> Any:
    """The first row that is judged by a check."""
    return next(row for row in ROWS if row.check is not None and row.check.__name__ == check)


def said(row: Any, *cases: Any, **tables: pd.DataFrame) -> str:
    """What a row says of some cases, and of tables that its check is given."""
    answer = row.check(*cases, **tables, **row.given)
    place = getattr(cases[0], "place", "")
    return fill(row.here, place=place, stated={}, **row.given, **answer.values)


def in_si(text: str, before: str, unit: str) -> float:
    """The number that stands after some words and before a unit, in SI units."""
    found = re.search(rf"{before} {NUMBER} {unit}\b", text)
    assert found is not None, text
    return float(UREG.Quantity(float(found[1]), unit.replace("µ", "u")).to_base_units().magnitude)


def case(**known: Any) -> Any:
    """A case that knows what a row asks for."""
    scalars = {"N": 385.0, "Omega": 15.0, "h": 0.002, "k": 5e4, "u_0": 0.0, "first_separation": 1.0}
    view = SimpleNamespace(**{"place": "385 N, 15 rad/s", "fate": "Contact is kept.", **known})
    view_type = type("Known", (SimpleNamespace,), {"__getitem__": lambda self, key: scalars[key]})
    return view_type(**vars(view))


def test_separations_last_milliseconds() -> None:
    text = said(
        row_of("separations_are_short"),
        case(longest_separation=9.63e-4, rate_of=lambda kind: 135.4),
    )
    assert in_si(text, "lasts", "ms") == pytest.approx(9.63e-4, rel=0.01)
    assert "13 to 13 % of" in text or "13 %" in text


def test_releases_come_after_milliseconds() -> None:
    text = said(row_of("releases_regularly"), case(intervals=lambda: np.full(4, 0.014821)))
    assert in_si(text, "is released every", "ms") == pytest.approx(0.014821, rel=1e-3)


def test_a_quiet_disc_moves_through_millimetres() -> None:
    quiet = case(
        early=Range(380.0, 390.0),
        late=Range(381.0, 390.5),
        range_of=lambda *_: Range(-0.0112, 0.0101),
        disc=Range(-0.0113, 0.0104),
        late_range=lambda name: Range(0.0, 4.2e-5),
        separates=False,
    )
    text = said(row_of("quiet"), quiet)
    widths = [1e-3 * float(found) for found in re.findall(rf"{NUMBER} mm", text)]
    # the last is the thickness
    assert widths == pytest.approx([0.0213, 0.0217, 4.2e-5, 2e-3], abs=5.1e-6)


def test_a_small_vibration_is_in_micrometres_under_the_slider_and_in_millimetres_beside(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    row = row_of("stays_small")
    monkeypatch.setattr(section43, "_different_points", lambda *_: 1)
    monkeypatch.setattr(section43, "stays_steady", lambda _: True)
    small = case(
        intervals=lambda: np.full(4, 0.0148),
        late=Range(49.0, 51.0),
        early=Range(49.0, 51.0),
        disc=Range(-0.0012, 0.0011),
        late_range=lambda name: Range(0.0, 3.4e-6),
        separates=False,
        node={},
    )
    text = said(row, small)
    assert in_si(text, "slider varies by", "µm") == pytest.approx(3.4e-6, rel=1e-3)
    assert in_si(text, "fixed on the disc by", "mm") == pytest.approx(2.3e-3, rel=1e-2)


def test_a_section_has_displacements_in_millimetres() -> None:
    samples = xr.Dataset(
        {
            "w_point": ("time", [-0.012, -0.004, 0.009]),
            "phase": ("time", [measures.SEPARATION, 1, 1]),
        },
        {"time": [2.0, 3.0, 4.0]},
    )
    text = said(row_of("seen_in_section"), case(samples=lambda _: samples))
    assert "displacement is -12.0 mm at those" in text
    assert "-12.0 to 9.0 mm at all" in text


def test_energies_of_a_period_are_in_millijoules(monkeypatch: pytest.MonkeyPatch) -> None:
    """As the table has them, whose columns name the unit; powers are in watts."""
    free, bonded = (case(name=contact) for contact in ("unilateral", "bilateral"))
    monkeypatch.setattr(section41, "pairs", lambda cases: [(free, bonded)])
    table = pd.DataFrame({"case": ["unilateral"]})
    table[ENERGIES + POWERS] = [3.7, 5.92, 2.22, 1.48, 3.7, 1.0, -2.0]
    table[COMPLIANT] = [2.96, 2.22, 3.33]
    text = said(row_of("excites_less"), free, bonded, energies=table)
    assert [float(found) for found in re.findall(rf"{NUMBER} mJ", text)] == [3.7, 5.92]
    assert "supplies 1.00 W and takes 2.00 W" in text


def test_the_table_of_impacts_is_in_milliseconds_percent_and_millimetres() -> None:
    known = case(
        rate_of=lambda kind: 135.4,
        longest_separation=9.6e-4,
        phase_share=lambda phase: 0.13,
        stick=0.25,
        disc=Range(-0.027, 0.029),
        late_motion="periodic",
    )
    table: pd.DataFrame = impact_law(dict.fromkeys(TABLE_CASES["impact_law"], known))
    first = table.iloc[0]
    assert first["longest_ms"] == pytest.approx(0.96)
    assert (first["separated_%"], first["stick_%"]) == pytest.approx((13, 25))
    assert first["range_mm"] == pytest.approx(56)
