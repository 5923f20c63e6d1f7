"""What titles say of parameters."""

import json
import logging
from pathlib import Path

import pytest
import xarray as xr

from disc_model.figures import drawing
from disc_model.figures.kinds import Campbell
from tests.processes import python


@pytest.mark.parametrize(
    ("base", "text"),
    [
        ({"N": 385.0, "Omega": 15.1, "mu_s": 0.4}, "N = 385 N, Ω = 15.1 rad/s"),
        ({"N": 385.0, "c_p": 1.0}, "N = 385 N, $c_p$ = 1 N s/m"),
        # what varies, and an N or Omega of 0, which stands for one that the quantity varies by itself
        ({"N": 200.0, "Omega": 0.0, "k": 3.0}, "N = 200 N"),
        ({"N": 200.0, "normalization": "orthonormal"}, "N = 200 N, orthonormal modes"),
        ({"N": 200.0, "contact": "bonded"}, "N = 200 N, bilateral contact"),
    ],
)
def test_a_title_says_what_is_fixed_with_symbols(base: dict[str, object], text: str) -> None:
    study = xr.Dataset(coords={"k": [1.0, 2.0]}, attrs={"title": "Made up", "base": json.dumps(base)})
    figure = drawing.new_figure(drawing.COLUMN, 2)
    drawing.head(figure, study, Campbell())
    assert figure.get_suptitle() == f"Made up\n{text}"


def test_a_figure_with_a_caption_has_no_heading() -> None:
    """The paper's figures have none, and those of grids said in the picture what stood below it too."""
    figure = drawing.new_figure(drawing.COLUMN, 2)
    drawing.head(figure, xr.Dataset(attrs={"title": "Made up", "base": '{"N": 385}'}), Campbell(caption="Said below."))
    assert figure.get_suptitle() == ""


def test_a_value_stays_in_the_line_of_its_name() -> None:
    figure = drawing.new_figure(1.0, 2)
    drawing.entitle(figure, Campbell(), "", "N = 385 N, Ω = 15.1 rad/s, D* = 2e-05 N m s")
    assert figure.get_suptitle().split("\n") == ["N = 385 N,", "Ω = 15.1 rad/s,", "D* = 2e-05 N m s"]


def test_reports_on_fonts_do_not_fill_the_log_of_a_figure(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    figure = drawing.new_figure(drawing.COLUMN, 2)
    figure.suptitle("text")
    with caplog.at_level(logging.INFO):
        drawing.save(figure, tmp_path / "figure.pdf")
    assert not caplog.records


def test_the_style_needs_no_figure_of_another_kind() -> None:
    """A figure alone in its process ended in an AttributeError: other modules had imported matplotlib's styles."""
    python("from disc_model.figures.drawing import styled\nwith styled():\n    pass")
