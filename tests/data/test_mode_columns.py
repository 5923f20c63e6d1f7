"""Tables of modes, where a dataset has room for more modes than a disc has."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import disc_model as dm

NAN = np.nan


def of_modes() -> xr.Dataset:
    """Two modes at each of two speeds, in a dataset with room for four."""
    dims = ("Omega", "mode")
    return xr.Dataset(
        {
            "sliding_frequency": (dims, [[70.0, 135.0, NAN, NAN], [71.0, 135.0, NAN, NAN]]),
            "diameters": (dims, [[0, 1, 0, 0], [0, 1, 0, 0]]),
        },
        {"Omega": [11.0, 12.0], "mode": [1, 2, 3, 4]},
    )


def test_modes_that_do_not_exist_have_no_columns(tmp_path: Path) -> None:
    """They had a diameter of 0, like a mode without nodal diameters."""
    study = of_modes().assign(status=("Omega", ["ok", "ok"]))
    dm.save(study, tmp_path / "modes.csv")
    heads = pd.read_csv(tmp_path / "modes.csv").columns
    assert [head for head in heads if "diameters" in head] == ["diameters[1]", "diameters[2]"]


def test_columns_of_one_number_a_point_come_first(tmp_path: Path) -> None:
    """Dozens of multipliers stood before the growth rate."""
    study = of_modes().assign(status=("Omega", ["ok", "ok"]), growth_rate=("Omega", [1.0, 2.0]))
    dm.save(study, tmp_path / "modes.csv")
    heads = [*pd.read_csv(tmp_path / "modes.csv").columns]
    assert heads[:3] == ["Omega", "status", "growth_rate"]
    assert all("[" in head for head in heads[3:])


def test_modes_that_do_not_exist_have_no_rows(tmp_path: Path) -> None:
    dm.save(of_modes(), tmp_path / "modes.csv")
    table = pd.read_csv(tmp_path / "modes.csv")
    assert table["mode"].tolist() == [1, 2, 1, 2]


def test_a_mode_without_a_number_at_one_point_keeps_its_row(tmp_path: Path) -> None:
    study = of_modes()
    study["sliding_frequency"].values[0, 1] = NAN
    dm.save(study[["sliding_frequency"]], tmp_path / "modes.csv")
    table = pd.read_csv(tmp_path / "modes.csv")
    assert table["mode"].tolist() == [1, 2, 1, 2]


def test_the_message_offers_both_tables_of_crossings_and_speeds(tmp_path: Path) -> None:
    """It offered the one of the crossings alone."""
    study = of_modes().assign(crossing_Omega=("crossing", [11.5]), status=("Omega", ["ok", "ok"]))
    with pytest.raises(dm.ParameterError, match=r'data\[\["crossing_Omega"\]\]') as told:
        dm.save(study, tmp_path / "modes.csv")
    assert 'data.drop_dims(["crossing"])' in str(told.value)
    dm.save(study.drop_dims(["crossing"]), tmp_path / "modes.csv")
