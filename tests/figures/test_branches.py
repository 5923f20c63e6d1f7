"""Continuation diagrams."""

import numpy as np
import pytest
from matplotlib.text import Annotation

from disc_model.figures.drawing import BLACK, GREY, SEPARATED
from disc_model.studies.quantities.branches import Branches
from tests.figures.reading import draw
from tests.studies.conftest import computed


def test_stable_stretches_are_thick_and_jumps_have_arrows(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quiet branch with a fold at 13, and one that separates above it."""
    values = {
        "status": "ok",
        "n_branches": 2,
        "separations": [0, 2],
        "value": [[10.0, 12.0, 13.0, 12.0], [11.0, 14.0]],
        "range": [[1e-5, 2e-5, 3e-5, 1e-4], [2e-2, 3e-2]],
        "growth_rate": [[-0.1, -0.1, -0.01, 0.2], [-0.1, -0.1]],
        "sweep_range": np.array([[1e-5, 1e-5, 2e-5, 2e-5, 3e-2], [1e-5, 2e-2, 2e-2, 2e-2, 3e-2]]),
        "sweep_separation_rate": np.array([[0, 0, 0, 0, 135.0], [0, 135.0, 135.0, 135.0, 135.0]]),
        "sweep_settled": np.full((2, 5), 2),
        "sliding_growth_rate": [0.1, 0.1, -0.1, -0.1, -0.1],
    }
    monkeypatch.setattr(Branches, "compute_point", lambda *_, **__: (values, ""))
    options = {"scan": {"start": 10, "stop": 14, "step": 1}, "dwell": 1, "evaluation_time": 1}
    study = computed(quantity="branches", options=options, base={"N": 385}, axes={"normalization": ["as_published"]})
    figure = draw("branches", study, paper_cases={"F11": 12}, title="t")
    (ax,) = figure.axes
    thick = [line for line in ax.lines if line.get_linewidth() == 2 and len(line.get_xdata())]
    assert [(line.get_color(), [*line.get_xdata()]) for line in thick] == [
        (BLACK, [10, 12, 13]),
        (SEPARATED, [11, 14]),
        (GREY, [12, 13, 14]),  # steady sliding, which the text called thick and was not
    ]
    arrows = [text for text in ax.texts if isinstance(text, Annotation) and text.arrow_patch is not None]
    assert [(arrow.xyann[0], arrow.xy[0]) for arrow in arrows] == [(13, 14), (11, 10)]
