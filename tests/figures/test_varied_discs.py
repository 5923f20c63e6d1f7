"""Titles of what is computed over a frequency of a disc given by its modes."""

import disc_model as dm
from disc_model.data.variables import axis_of
from disc_model.figures.head_texts import head_text, what_case
from disc_model.figures.stated_case import stated
from disc_model.figures.sweep_titles import values_of

DISC = dm.Disc.from_csv("config/discs/brake_3_modes.csv")
PAD = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "m": 0.5}
CASE = dm.Parameters(N=8000, Omega=10, disc=DISC, **PAD)
RANGE = "a disc given by 3 modes of 550.8 to 1212 Hz"


def swept_title(**axes: object) -> str:
    """What a title says of a sweep of some numbers of the disc."""
    study = dm.sweep(dm.steady_sliding, CASE, **axes)
    return what_case(values_of(study))


def test_a_title_does_not_state_the_frequency_that_varies() -> None:
    """It gave 550.8 Hz, while this went from 500 to 600 Hz along the axis."""
    title = swept_title(omega_1_0=["500 Hz", "600 Hz"])
    assert "a disc given by 3 modes" in title
    assert "Hz" not in title
    branch = stated(CASE, "omega_1_0")
    assert "a disc given by 3 modes," in branch
    assert RANGE in swept_title(amplitude_1_0=[0.5, 0.6])
    assert RANGE in stated(CASE, "N")


def test_a_title_states_a_frequency_that_is_selected() -> None:
    title = swept_title(omega_1_0=["500 Hz"])
    assert "a disc given by 3 modes of 500 to 1212 Hz" in title


def test_parameters_that_are_counted_are_called_so() -> None:
    """After the modes of a disc, "and 1 more" read as one more mode."""
    values = ", ".join(f"x{i} = {i} N" for i in range(40))
    assert head_text(3.5, "", values, most=2).endswith(" further parameters")


def test_amplitudes_have_one_unit() -> None:
    """The tangential one had kg^-1/2 where the other one had 1/√kg."""
    label, _ = axis_of("tangential_2_0")
    assert label == "t(2, 0) (1/√kg)"


def test_a_title_without_room_still_names_the_disc() -> None:
    """It was only counted among further parameters, behind values of the friction."""
    friction = {"mu_s": 0.45, "mu_k": 0.35, "friction_decay": 1.0, "viscous_friction": 0.01}
    said = stated(CASE.replace(**friction))
    title = head_text(2.3, "", said, most=3)
    assert "a disc given by 3 modes" in title
    assert title.endswith("further parameters")
