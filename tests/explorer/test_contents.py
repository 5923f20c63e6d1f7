"""What the page is told of studies and motions."""

import base64
import json
import zlib

import numpy as np
import pytest

from disc_model.explorer.page import BITS, LEVELS, motion_contents
from disc_model.studies.motions import SAMPLES
from tests.explorer import made_up


def numbers(stored, kind: str) -> np.ndarray:
    size = np.dtype(kind).itemsize
    planes = np.frombuffer(zlib.decompress(base64.b64decode(stored["data"])), np.uint8).reshape(size, -1)
    return np.frombuffer(planes.T.tobytes(), kind)


@pytest.fixture
def contents():
    return made_up.contents()[0]


def test_numbers_flags_and_messages_come_through(contents):
    """Each as its words, whatever numbers stand for them; as JSON, and with units."""
    assert json.loads(json.dumps(contents, allow_nan=False)) == contents
    study = made_up.plane()
    told = {variable["name"]: variable for variable in contents["variables"]}
    assert set(told) == set(study.data_vars) - {"message"}
    shape = {dim["name"]: len(dim["values"]) for dim in contents["dims"]}
    for name in ("growth_rate", "releases"):
        found = numbers(told[name], "<f4").reshape([shape[dim] for dim in told[name]["dims"]])
        np.testing.assert_allclose(found, study[name].transpose(*told[name]["dims"]), rtol=2.0 ** -(BITS + 1))
    assert (told["growth_rate"]["unit"], told["growth_rate"]["title"]) == ("s-1", "growth rate")
    words = np.array(told["outcome"]["flags"])[numbers(told["outcome"], "u1")]
    assert words.tolist() == np.where(study["outcome"].values == 0, "separation", "quiet").ravel().tolist()
    text = np.array(contents["messages"]["words"])[numbers(contents["messages"], "<u4")].reshape(3, 4, 2)
    assert (text[tuple(made_up.FAILED.values())], (text != "").sum()) == (made_up.MESSAGE, 1)
    spring = {"name": "k", "title": "spring of the slider, normal to the disc", "unit": "N m-1", "value": 5e4}
    assert contents["fixed"] == [spring]


def test_motions_are_right_to_half_a_step_and_failed_ones_are_left_out(contents):
    motions = contents["motions"]
    assert [motion["at"] for motion in motions["points"]] == [[100, 5, "as_published"], [385, 20, "as_published"]]
    assert {trace["name"]: trace["unit"] for trace in motions["traces"]} == {"P": "N", "u": "m", "psi": "rad"}
    assert motions["points"][0]["phase"] == [[0, 1], [SAMPLES // 4, 2], [SAMPLES // 2, 3], [3 * SAMPLES // 4, 1]]
    told = motions["traces"][0]
    found = numbers(told, "<u2").reshape(2, SAMPLES)
    for i, motion in enumerate(motions["points"]):
        expected = made_up.force(motion["at"][0]).astype(float)
        error = np.abs(told["least"][i] + told["step"][i] * found[i] - expected).max()
        # half a step, and rounding of what is about 600
        assert error <= np.ptp(expected) / LEVELS / 2 + 1e-12
    lost = made_up.motions()
    lost["status"][:] = 1
    assert motion_contents(lost)["points"] == []
