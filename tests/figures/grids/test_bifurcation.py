"""Bifurcation diagrams with their exponents."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.parts import save
from tests.figures.grids.reading import crosses, draw, labels, lines
from tests.studies.grids.conftest import SMALL, computed, made_up_samples, with_failed


def test_diagrams_mark_points_that_failed() -> None:
    samples, exponents = made_up_samples()
    others = {"lyapunov": with_failed(exponents, N=3)}
    above, below = draw("bifurcation", with_failed(samples, N=2), others, x="N").axes
    assert [crosses(ax) for ax in (above, below)] == [[[2]], [[3]]]
    assert above.lines[0].get_xdata().tolist() == [1, 1, 3, 3]
    assert not crosses(draw("bifurcation", samples, x="N").axes[0])


def test_a_motion_without_switches_has_not_failed() -> None:
    samples, _ = made_up_samples()
    samples["phase"][{"N": 1}] = 0  # not reached, as where a motion slides steadily
    (ax,) = draw("bifurcation", samples, x="N").axes
    assert not crosses(ax)
    assert lines(ax)["slides steadily"].get_xdata() == [2]


def test_samples_at_switches_are_not_named_after_phases_and_the_start_is_said() -> None:
    samples, _ = made_up_samples()
    study = samples.assign_attrs(
        base=json.dumps({"normalization": "orthonormal", "Omega": 15, "k": 5e4, "c_p": 1.0}),
        options=json.dumps({"section": "switch", "prepare": {"parameters": {"N": 385, "Omega": 15.1}, "time": 70}}),
    )
    figure = draw("bifurcation", study, x="N", title="Made up")
    assert labels(figure.axes[0]) == ["at release of stick"]
    assert figure.get_suptitle() == "Made up\nΩ = 15 rad/s, $c_p$ = 1 N s/m, orthonormal modes"  # k is that of Table 1
    assert "from the state of N = 385 N, Ω = 15.1 rad/s after 70 s" in figure.get_supxlabel()
    assert "published start" in draw("bifurcation", samples, x="N").get_supxlabel()


def test_what_is_not_steady_is_grey_and_what_has_not_converged_ringed() -> None:
    samples, exponents = made_up_samples()
    words = {"flag_meanings": "unknown no yes"}
    samples["steady"] = ("N", np.array([2, 1, 2], np.int8), words)
    exponents["converged"] = (("N", "exponent_number"), np.array([[2], [2], [1]], np.int8), words)
    above, below = draw("bifurcation", samples, {"lyapunov": exponents}, x="N").axes
    assert list(lines(above)["not steady"].get_xdata()) == [2, 2]
    assert 2 not in lines(above)["stick"].get_xdata()
    ring, _in_the_legend = (line for line in below.lines if line.get_markerfacecolor() == "none")
    assert list(ring.get_xdata()) == [3]
    assert ring.get_color() == lines(below)["largest exponent"].get_color()


def test_diagrams_show_samples_and_exponents(tmp_path) -> None:
    options = {"transient": 0.1, "samples": 2, "tol": 1e-8}
    samples = computed(quantity="bifurcation", options=options, base={"N": 200} | SMALL, axes={"Omega": [45, 50]})
    assert flag_names(samples["phase"]).shape == (2, 2)
    assert set(np.unique(flag_names(samples["phase"]))) <= {"stick", "slip", "separation"}
    options = {"transient": 0.01, "duration": 0.04, "exponents": 2, "tol": 1e-8}
    exponents = computed(quantity="lyapunov", options=options, base={"N": 200} | SMALL, axes={"Omega": [45, 50]})
    assert exponents["exponent"].shape == (2, 2)
    assert exponents["covered"].values == pytest.approx([0.04, 0.04])
    figure = draw("bifurcation", samples, {"lyapunov": exponents}, x="Omega")
    assert figure.axes[0].get_ylabel() == "Angle ψ (mrad)"
    save(figure, tmp_path / "diagram.png")


def test_a_diagram_without_exponents_has_one_panel() -> None:
    samples, _ = made_up_samples()
    samples["P"] = xr.full_like(samples["psi"], 1.0).assign_attrs(units="N")
    (ax,) = draw("bifurcation", samples, x="N", variable="P", scale=1.0).axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Preload N (N)", "Contact force P (N)")
    assert len(ax.lines) == 1  # all of it stick
