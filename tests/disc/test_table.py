"""Tables of modes: the heads that are read, those that are refused, and the discs of the studies."""

import hashlib
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import disc_model as dm
from tests.refusals import refusal

DISCS = Path(__file__).parents[2] / "config" / "discs"
HEADS = "diameters,frequency_Hz,amplitude_per_sqrt_kg"
FIELDS = ("diameters", "circles", "omega", "amplitude", "tangential", "damping_ratio")


def test_a_disc_is_written_and_read_back(tmp_path: Path) -> None:
    disc = dm.Disc(
        diameters=[0, 2, 2], circles=[0, 0, 1], omega=[1e3 / 3, 1e5 / 7, 2e4], amplitude=[0.1, -1 / 3, 2e-17],
        tangential=[0, 0.1 + 0.2, -3e-5], damping_ratio=[0, 1e-3 / 3, 0.01],
    )  # fmt: skip
    path = tmp_path / "disc.csv"
    disc.to_csv(path)
    assert dm.Disc.from_csv(path) == disc
    plain = dm.Disc(diameters=[0], omega=[1e3], amplitude=[1.0])
    plain.to_csv(path)
    assert dm.Disc.from_csv(path) == plain


def test_columns_have_any_order_and_lines_are_comments(tmp_path: Path) -> None:
    """As a spreadsheet writes it: with a byte order mark, blanks and an empty line."""
    path = tmp_path / "disc.csv"
    path.write_text(
        "\ufeff# a ring\n\n amplitude_per_sqrt_kg , frequency_Hz, diameters\n0.5, 1e3 ,2\n# not used\n",
        encoding="utf-8",
    )
    expected = dm.Disc(diameters=[2], omega=[1e3 * math.tau], amplitude=[0.5])
    assert dm.Disc.from_csv(path) == expected


@pytest.mark.parametrize("file", sorted(DISCS.glob("*.csv")), ids=lambda file: file.stem)
def test_the_discs_of_the_studies_have_the_modes_that_they_had(file: Path) -> None:
    """Every bit of them; discs.csv has the sums that the reader before this one gave."""
    known = pd.read_csv(Path(__file__).with_name("discs.csv"), index_col="disc")["sha256"]
    disc = dm.Disc.from_csv(file)
    numbers = np.array([getattr(disc, name) for name in FIELDS], dtype="<f8")
    assert hashlib.sha256(numbers.tobytes()).hexdigest() == known[file.stem]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "diameters,frequency (cpm),amplitude_per_sqrt_kg\n1,33090,0.556",
            r"frequency \(cpm\)'\]: unknown",
        ),
        (
            "diameters,pole (rad/s),amplitude_per_sqrt_kg\n1,-5.8+3463i,0.5",
            r"pole \(rad/s\)'\]: unknown",
        ),
        (f"{HEADS},q,shape_at_0.08_m\n1,551,0.5,500,1", r"\['q', 'shape_at_0.08_m'\]: unknown"),
        (HEADS.replace(",", ";") + "\n1;551;0.5", "columns=.*: unknown"),
        (f"{HEADS},omega_rad_per_s\n1,551,0.5,3462", "must have each once"),
        (f"{HEADS},diameters\n1,551,0.5,1", "must have each once"),
        ("diameters,frequency_Hz\n1,551", "must have each once"),
        (f"{HEADS}\n1,551 Hz,0.5", "frequency_Hz: could not convert string to float: '551 Hz'"),
        (
            f"{HEADS},damping_ratio\n1,551,0.5,0.1 %",
            "damping_ratio: could not convert string to float: '0.1 %'",
        ),
        (
            f"{HEADS}\n1,551,0.5\n2,1212",
            "amplitude_per_sqrt_kg: could not convert string to float: ''",
        ),
        (f"{HEADS}\n1,551,0,5", "Expected 3 fields in line 2, saw 4"),
        ("", "must be a table with commas that can be read"),
    ],
)
def test_what_is_no_such_table_is_refused_with_the_heads(
    text: str, words: str, tmp_path: Path
) -> None:
    path = tmp_path / "disc.csv"
    path.write_text(text)
    with refusal(rf"disc\.csv.*{words}.*columns are diameters, omega_rad_per_s or frequency_Hz"):
        dm.Disc.from_csv(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{HEADS}\n1,551,nan", "amplitude.0=nan"),
        (f"{HEADS}\n1.5,551,1", "diameters.0=1.5"),
        (f"{HEADS}\n2,1212,0.5\n2,1220,0.5", "pair of modes given once"),
        (
            f"{HEADS},tangential_per_sqrt_kg\n0,929,0.4,0.1",
            "tangential=.0.1.: must be 0 for a mode without",
        ),
        (HEADS, "1 to 1000 modes"),
    ],
)
def test_numbers_keep_the_rules_of_a_disc(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "disc.csv"
    path.write_text(text)
    with refusal(rf"disc\.csv\..*{words}"):
        dm.Disc.from_csv(path)


def test_a_mode_without_nodal_diameters_has_no_tangential_amplitude() -> None:
    """Steady sliding used it, and the engine did not."""
    modes = {"diameters": [2, 0], "omega": [2500, 1500], "amplitude": [1.0, 1.0]}
    with refusal(r"tangential=.*0\.3\]: must be 0 for a mode without nodal diameters"):
        dm.Disc(**modes, tangential=[-0.1, 0.3])
    assert dm.Disc(**modes, tangential=[-0.1, -0.0]).tangential == (-0.1, 0.0)
