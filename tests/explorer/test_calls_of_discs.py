"""Calls of points of a study whose disc is a table of modes."""

from pathlib import Path

import pytest

import disc_model as dm
from disc_model.explorer import Stated
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.point_calls import call_of
from disc_model.studies.study import load_study
from tests import needs
from tests.explorer.test_finding import Open, opened

pytestmark = [pytest.mark.slow, pytest.mark.compiled, needs.BROWSER.mark]

__all__ = ["opened"]  # a fixture

TABLE = "diameters,frequency_Hz,amplitude_per_sqrt_kg\n2,1200,0.5\n"
ONE_DISC = "base: {N: 200, r_0: 0.1, Omega: 15, disc: one.csv}\naxes: {mu_k: [0.2, 0.25]}\n"
TWO_DISCS = "base: {N: 200, r_0: 0.1, Omega: 15}\naxes: {disc: [one.csv, other.csv]}\n"
NAMED_DISCS = (
    "base: {N: 200, r_0: 0.1, Omega: 15}\naxes: {disc: [soft, stiff]}\n"
    "discs: {soft: one.csv, stiff: other.csv}\n"
)


@pytest.mark.parametrize("grid", [ONE_DISC, TWO_DISCS, NAMED_DISCS])
@pytest.mark.parametrize("quantity", ["floquet", "lyapunov"])
def test_a_call_reads_the_disc_from_its_table(
    opened: Open, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, grid: str, quantity: str
) -> None:
    """It spelled the disc as a mapping of all its numbers."""
    monkeypatch.chdir(tmp_path)
    Path("one.csv").write_text(TABLE)
    Path("other.csv").write_text(TABLE.replace("1200", "1500"))
    options = "{}" if quantity == "floquet" else "{transient: 0.1, duration: 0.1}"
    head = f"study: mine\nquantity: {quantity}\noptions: {options}\n"
    Path("mine.yaml").write_text(head + grid)
    study = load_study("mine.yaml")
    assert study.grid is not None
    call = call_of(quantity, study.grid.options).plain
    contents = contents_of(
        "mine", dm.run_study("mine.yaml"), stated=Stated(call=call, tables=study.tables)
    )
    with opened([contents]) as shown:
        [along] = study.grid.dims
        for i, point in enumerate(study.grid.points_along([along])):
            shown.page.run("choose({...view.place, [arguments[0]]: arguments[1]})", along.name, i)
            lines = shown.text("call").split("\n")
            assert 'dm.Disc.from_csv("o' in lines[0]
            assert "r_0=0.1" in lines[0], "a case without it is doubted"
            assert "omega" not in "".join(lines)
            names = {"dm": dm}
            exec("\n".join(lines[:-1]), names)
            assert names["case"] == study.grid._case_at(point)
