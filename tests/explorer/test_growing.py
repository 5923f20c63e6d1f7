"""Values late in a motion that still grows, in the explorer."""

from disc_model.explorer import study_contents
from tests.explorer.left_out import ruled


def test_a_range_of_a_motion_that_still_grows_says_so() -> None:
    """The point's text was that of a motion that had settled."""
    study = ruled().isel(mu_s=[1])
    meaning = "greatest contact force over the late stretch"
    study["P_max"].attrs["long_name"] = meaning
    study["outcome"].values[0, 0] = 1
    variables = {each["name"]: each for each in study_contents("ruled", study)["variables"]}
    [doubt] = variables["P_max"]["doubts"]
    assert doubt["look"]["label"].startswith("still growing")
    assert not doubt["is_bound"]
