"""Discs given by a table of their modes."""

from pathlib import Path

import numpy as np
import pytest

import disc_model as dm
from disc_model.disc.plate import mode_arrays, mode_shapes
from disc_model.simulation.states import engine_case
from tests.disc.table import disc_of
from tests.refusals import refusal
from tests.test_cli import Command

P = dm.Parameters(N=385, Omega=15.1)


def written(path: Path, p: dm.Parameters) -> dm.Parameters:
    """The case with a disc that was read from the table of its own modes."""
    disc = disc_of(p)
    disc.to_csv(path)
    left = {
        name: p.canonical[name]
        for name in ("N", "Omega", "r_0", "contact_force")
        if name in p.canonical
    }
    read = dm.Disc.from_csv(path).replace(static_compliance=disc.static_compliance)
    return dm.Parameters(**left, contact_compliance=p.contact_compliance, disc=read)


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"normalization": "orthonormal"},
        # both at once: this law's kernels are those of other quick tests
        {
            "normalization": "orthonormal",
            "contact_compliance": "residual",
            "contact_force": "normal",
        },
    ],
    ids=["published", "orthonormal", "residual, normal force"],
)
def test_a_plate_given_by_its_modes_moves_as_the_plate(
    change: dict[str, object], tmp_path: Path
) -> None:
    """Seventeen digits bring every number back; rounding is left to the damping, which comes as a
    ratio."""
    plate = P.replace(**change)
    path = tmp_path / "disc.csv"
    table = written(path, plate)
    times = [dm.simulate(p, 1.0).events["time"].to_numpy() for p in (plate, table)]
    np.testing.assert_allclose(*times, rtol=0, atol=1e-13)
    of_plate, of_table = (engine_case(p).model for p in (plate, table))
    np.testing.assert_allclose(of_table.lanes, of_plate.lanes, rtol=1e-15)
    assert of_table.compliance == of_plate.compliance
    assert of_table.has_normal_force == of_plate.has_normal_force
    # or kernels compile for seven seconds; multipliers have the disc from these constants
    if not of_plate.has_normal_force:
        growth = [dm.floquet(p.replace(Omega=15.0)).growth_rate for p in (plate, table)]
        assert growth[1] == pytest.approx(growth[0], abs=1e-9)


def test_shapes_of_a_disc_give_the_deflection_of_the_plate() -> None:
    """Splines through shapes each 4 mm: the error of the fourth order is some 1e-5 of the
    deflection."""
    plate = P.replace(normalization="orthonormal")
    r = np.linspace(P.a, P.b, 41)
    theta = np.linspace(0, 6, 13)
    given = mode_arrays(plate)
    radii = np.linspace(P.a, P.b, 20)
    disc = dm.Disc(
        diameters=given.diameters.tolist(), omega=given.omega.tolist(), amplitude=given.psi.tolist(),
        radii=radii.tolist(), shapes=mode_shapes(plate, radii).tolist(),
    )  # fmt: skip
    table = P.replace(disc=disc)
    state = dm.snapshots(plate, [0.3])
    right, found = (dm.deflection(p, state, r, theta) for p in (plate, table))
    np.testing.assert_allclose(found, right, rtol=0, atol=1e-4 * np.abs(right).max())
    under = [dm.deflection(p, state, P.r_0, theta) for p in (plate, table)]
    np.testing.assert_allclose(
        under[1], under[0], rtol=1e-12
    )  # there they are the amplitudes themselves
    with refusal(r"r=\[0\.13\]: must be within 0\.044 and 0\.12"):
        dm.deflection(table, state, 0.13, 0.0)


def test_faults_of_columns_are_named() -> None:
    given = {"diameters": [2, 2], "omega": [100, 100.5], "amplitude": [1, 1]}
    with refusal(r"omega.1=100.5: modes 1 and 2 .* 0.5 % apart"):
        dm.Disc(**given)
    assert dm.Disc(**given, circles=[0, 1]).damping_ratio == (0, 0)
    with refusal("omega=1: must be as many as diameters, 2"):
        dm.Disc(diameters=[2, 3], omega=[100], amplitude=[2, 1])
    with refusal("diameters=1001: must be 1 to 1000 modes"):
        dm.Disc(
            diameters=[2] * 1001, omega=range(100, 1101), amplitude=[1] * 1001
        )  # circles are not counted before


def test_discs_are_an_axis(tmp_path: Path) -> None:
    """By the names of their tables, or by names of the file."""
    cases = {"a.csv": P.replace(Omega=15), "b.csv": P.replace(Omega=15, h=0.0021)}
    for name, p in cases.items():
        disc_of(p).to_csv(tmp_path / name)
    head = "study: own\nquantity: floquet\nbase: {Omega: 15, N: 385}\n"
    file = tmp_path / "study.yaml"
    file.write_text(head + "axes: {disc: [a.csv, b.csv]}\n")
    study = dm.run_study(file)
    for name, p in cases.items():
        rate = dm.floquet(p).growth_rate
        assert study["growth_rate"].sel(disc=name) == pytest.approx(rate, abs=1e-9)
    discs = "discs: {thin: a.csv, thick: b.csv}\n"
    file.write_text(head + discs + "zip: {disc: [thick, thin], r_0: [0.1, 0.11]}\n")
    zipped = dm.run_study(file)
    assert zipped["disc"].values.tolist() == ["thick", "thin"]
    assert zipped["growth_rate"].values[0] == study["growth_rate"].sel(disc="b.csv")


def test_the_command_line_reads_tables(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "disc.csv"
    command = Command(capsys)
    disc_of(P.replace(damping_ratio=0.00375)).to_csv(path)
    shown = command.out("modes", f"disc={path}")
    for omega in dm.Disc.from_csv(path).omega:
        assert f"{omega:.6g}" in shown


BRAKES = Path(__file__).parents[2] / "config" / "discs"


@pytest.mark.parametrize(
    ("pads", "one"),
    [
        ("brake_two_pads", "brake"),
        ("brake_two_pads_48_modes", "brake_48_modes"),
        ("brake_two_pads_138_modes", "brake_138_modes"),
        ("brake_two_pads_heavily_damped", "brake_48_modes"),
    ],
)
def test_between_two_pads_only_the_couple_of_friction_moves_the_brake_disc(
    pads: str, one: str
) -> None:
    """Of equal modes; the ring is 12 mm thick, and the slider at 0.1 m."""
    two = dm.Disc.from_csv(BRAKES / f"{pads}.csv")
    disc = dm.Disc.from_csv(BRAKES / f"{one}.csv")
    assert two.omega == disc.omega
    couple = -0.006 * np.array(disc.diameters) * disc.amplitude / 0.1
    # nine digits in the file
    np.testing.assert_allclose(two.tangential, couple, rtol=1e-8)
