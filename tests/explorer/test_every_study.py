"""Studies of every quantity in the explorer: each variable is shown, and the call of its point
gives its value."""

import json
import math
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.explorer import Stated, page
from disc_model.explorer import study_contents as contents_of
from disc_model.studies.point_calls import call_of
from disc_model.studies.registry import quantity_names, quantity_of
from tests import needs
from tests.explorer.test_in_browser import READY
from tests.studies.conftest import computed
from tests.studies.test_quantities import SCAN, grid
from tests.workflow.browser import Page, browser

pytestmark = [pytest.mark.slow, pytest.mark.compiled, needs.BROWSER.mark]

DISC = {"diameters": [2], "circles": [0], "omega": [3000.0], "amplitude": [0.5]}
SHOW = """
const [name, done] = arguments;
(async () => {
  const study = contents.studies.find((one) => one.name === name);
  const rows = [];
  for (const variable of study.variables) {
    await follow(`study=${name}`);
    const axes = study.dims.filter((dim) => variable.dims.includes(dim.name) && dim.values.length > 1);
    const [across, up] = axes.length ? axes : study.dims;
    Object.assign(view, {variable, x: across.name, y: axes.length > 1 ? up.name : ""});
    chooseAxes();
    view.place = opening();
    update();
    const text = (id) => element(id).innerText;
    const gap = gapAt(study, variable, view.place);
    rows.push({
      asked: variable.name, shown: view.variable.name, place: view.place, gap: gap && gap.label,
      title: text("map-title"), says: text("call-says"), call: text("call"), motion: text("motion-call"),
      of_motion: text("motion-says"),
    });
  }
  return rows;
})().then(done, (error) => done(String(error.stack)));
"""
"""Shows each variable of a study along its own dimensions, and returns what the page says."""


def studies() -> dict[str, dict[str, Any]]:
    """Small studies of every quantity, and of kinds of case that differ from one another."""
    found = {name: grid(name) for name in quantity_names()}
    kicked = grid("outcome")
    kicked["axes"]["perturbation_u"] = [0.0, 1e-4]
    found["kicked"] = kicked
    started = grid("lyapunov")
    started["options"] = started["options"] | {"prerun": {"parameters": {"Omega": 16}, "time": 0.2}}
    found["started"] = started
    without = grid("locking")  # its dimension of places of the map has no values
    without["options"] = {key: x for key, x in without["options"].items() if key != "probes"}
    found["without_probes"] = without
    rising = grid("sliding")
    rising["options"] = {"parameter": "mu_k", "scan": {"start": 0.2, "stop": 0.6, "count": 3}}
    rising["base"] = {"N": 200, "Omega": 15, "n_diameters": 1}
    found["rising"] = rising
    of_mode = grid("sliding")
    of_mode["options"] = {"parameter": "omega_2_0", "scan": SCAN | {"start": 2900, "stop": 3100}}
    of_mode["base"] = {"N": 200, "Omega": 15, "disc": DISC}
    found["of_mode"] = of_mode
    found["zipped"] = grid("sensitivity")
    found["zipped"]["zip"] = {"N": [200, 385], "Omega": [12.6, 15]}
    found["zipped"]["base"] = {"n_diameters": 1}
    spread = {"distribution": "uniform", "low": 0.9, "high": 1.1, "relative": True}
    distributions = found["zipped"]["options"]["distributions"] | {"m": spread}
    found["zipped"]["options"] = found["zipped"]["options"] | {"distributions": distributions}
    return found


class Shown:
    """The page of the small studies, opened, and their datasets."""

    def __init__(self, opened: Page, datasets: dict[str, xr.Dataset]) -> None:
        self.page = opened
        self.datasets = datasets

    def rows(self, name: str) -> list[dict[str, Any]]:
        """What the page says of each variable of a study."""
        answer = self.page.call("POST", "/execute/async", {"script": SHOW, "args": [name]})
        assert not isinstance(answer, str), answer
        return answer


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Shown]:
    folder = tmp_path_factory.mktemp("explorer")
    datasets = {}
    told = []
    for name, raw in studies().items():
        dataset = computed(**raw).assign_attrs(title=f"Title of {name}")
        quantity = quantity_of(raw["quantity"]).model_validate(raw["options"])
        call = json.loads(json.dumps(call_of(raw["quantity"], quantity).plain))
        told.append(contents_of(name, dataset, stated=Stated(call=call)))
        datasets[name] = dataset
    path = folder / "explorer.html"
    path.write_text(page("Small", told, []), encoding="utf-8")
    with browser(folder / "profile") as opened:
        opened.resize(1280, 800)
        opened.open(path)
        opened.wait_for(READY)
        yield Shown(opened, datasets)


@pytest.mark.parametrize("name", studies())
def test_every_variable_is_shown(shown: Shown, name: str) -> None:
    """Studies of `locking` left the study before in the page, as one of their dimensions was empty."""
    rows = shown.rows(name)
    assert rows
    for row in rows:
        assert row["shown"] == row["asked"]
        assert row["title"].startswith(f"Title of {name}: ")
        assert row["call"]
    assert [x for x in shown.page.messages() if x["level"] == "SEVERE"] == []


@pytest.mark.parametrize("name", studies())
def test_the_call_of_a_point_gives_its_value(shown: Shown, name: str) -> None:
    """It had the parameter's first value instead of the point's, and none of a sample's."""
    ran: dict[str, dict[str, Any]] = {}
    compared = 0
    for row in shown.rows(name):
        *before, last = row["call"].split("\n")
        names: dict[str, Any] = {"dm": dm}
        if not before:
            assert isinstance(eval(last, names), dm.Parameters)
            assert "No call of it alone" in row["says"]
            continue
        assert not last.startswith("found = "), "a lack of a value has an expression, too"
        text = "\n".join(before)
        assert "start = " not in text, "only the motion below begins there"
        if text not in ran:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                exec(text, names)
            ran[text] = names
        value = eval(last, ran[text])
        assert equal(value, stored(shown.datasets[name], row)), row
        compared += 1
    assert compared or name == "stability_curves", "there is no curve in so small a plane"


@pytest.mark.parametrize(
    ("name", "variable", "dim"),
    [
        ("critical_speed", "scan_outcome", "scan_Omega"),
        ("hysteresis", "separation_rate", "sweep_Omega"),
        ("branches", "sweep_range", "sweep_value"),
    ],
)
def test_the_case_of_a_scanned_point_is_that_of_the_point(
    shown: Shown, name: str, variable: str, dim: str
) -> None:
    """It had the speed at which the scan begins, and no call of the motion."""
    [row] = [row for row in shown.rows(name) if row["asked"] == variable]
    speed = shown.datasets[name][dim].values[row["place"][dim]]
    assert f"Omega={speed:g}" in row["call"].split("\n")[0]
    assert "stands where its range begins" not in row["says"]
    assert f"Omega={speed:g}" in row["motion"]
    assert ("may differ" in row["of_motion"]) == (name != "critical_speed")


def test_all_parameters_of_a_sample_are_among_its_values(shown: Shown) -> None:
    """One of them stood there, and the sample could not be told from the page."""
    shown.rows("zipped")
    names = shown.page.run(
        "return [...document.querySelectorAll('#values th')].map(x => x.textContent)"
    )
    distributed = shown.datasets["zipped"]["parameter"].values.tolist()
    assert len(distributed) == 2
    for name in distributed:
        assert f"{name}: value of the sample, SI units" in names


def stored(study: xr.Dataset, row: dict[str, Any]) -> Any:
    """The value in the study's file that the page shows."""
    variable = study[row["asked"]]
    value = variable.isel({dim: row["place"][dim] for dim in variable.dims}).item()
    if "flag_meanings" in variable.attrs:
        return variable.attrs["flag_meanings"].split()[value]
    return value


def equal(value: Any, expected: Any) -> bool:
    """Words are the same; numbers are to nine digits, or as small as rounding."""
    if isinstance(expected, str):
        return value == expected
    return math.isclose(value, expected, rel_tol=1e-9, abs_tol=1e-11) or (
        bool(np.isnan(value)) and bool(np.isnan(expected))
    )
