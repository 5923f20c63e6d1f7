"""Where the numbers of a state and of columns stand: each has a place of its own, and is found
there again."""

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine import columns, state
from disc_model.engine.model import Model, build_state, on_ramp
from disc_model.engine.series import build_series, load_at_start, load_state
from disc_model.simulation.states import engine_case

SIZES = [(0, 0), (2, 1), (5, 0)]  # diameters, circles: no pairs; several single modes; two blocks


def in_python(function):
    """A kernel's helper as a function of Python."""
    return getattr(function, "py_func", function)


def model_of(n_diameters: int, n_circles: int, compliance: float = 1e-7) -> Model:
    p = Parameters(
        N=300, Omega=20, n_diameters=n_diameters, n_circles=n_circles, contact_compliance=compliance
    )
    return engine_case(p).model


@pytest.mark.parametrize("size", SIZES)
def test_every_component_of_a_mode_has_a_place_of_its_own(size: tuple[int, int]) -> None:
    diameters = np.tile(np.arange(size[0] + 1), size[1] + 1)
    model = model_of(*size)
    places = state.mode_places(diameters)
    assert ((places < 0) == (diameters == 0) * [[False], [True], [False], [True]]).all()
    there = places[places >= 0]
    assert len(np.unique(there)) == len(there)

    # displacements of pairs are z, velocities e; those of the others y and g
    here = build_state(model)
    here.disc[:] = 0.0
    here.disc[there] = 1.0
    pairs = int((diameters > 0).sum())
    count = 2 * pairs
    assert int(here.z.sum()) == count
    assert int(here.e.sum()) == count
    assert (here.y == 1.0).all()
    assert (here.g == 1.0).all()
    # a and b of a pair, and their velocities, stand where the kernels look for them
    of_a, of_b, of_alpha, of_beta = places[:, diameters > 0]
    assert [in_python(state.other_lane)(int(a)) for a in of_a] == of_b.tolist()
    assert [in_python(state.other_lane)(int(b)) for b in of_b] == of_a.tolist()
    assert (of_alpha - of_a == len(here.z)).all()
    assert (of_beta - of_b == len(here.z)).all()
    assert model.shift[of_a].tolist() == diameters[diameters > 0].tolist()


def test_a_series_begins_with_its_state_under_drive_and_load() -> None:
    model = model_of(2, 1)
    here = build_state(model)
    series = build_series(model, 20)
    values = dict(zip(state.SCALAR_NAMES, np.arange(1.0, 8.0).tolist(), strict=True))
    state.put_scalars(here, values.values())
    load_state(model, series, here)
    at_start = {
        "psi": series.psi[0],
        "g": series.f[0],
        "u": series.u[0],
        "u_velocity": series.v[0],
        "surface_turn": series.turn[0],
    }
    assert at_start == {name: values[name] for name in at_start}
    assert series.drive[:2].tolist() == [model.Omega, 0.0]
    # a fused product and sum rounds once, where there is one
    preload = pytest.approx(model.N - model.k * model.u_0, rel=1e-15)
    assert series.preload[:2].tolist() == [preload, 0.0]
    model = on_ramp(model, 0.0, 0.0, Omega=20.0, Omega_rate=3.0, N=300.0, N_rate=5.0)
    here.x[state.DRIVE] = 21.0
    here.x[state.LOAD] = 310.0
    load_state(model, series, here)
    assert series.drive[:2].tolist() == [21.0, 3.0 * model.unit]
    preload = pytest.approx(310.0 - model.k * model.u_0, rel=1e-15)
    assert series.preload[:2].tolist() == [preload, 5.0 * model.unit]
    assert load_at_start(model, series) == pytest.approx(310.0, rel=1e-15)


def test_scalars_come_back_under_their_names() -> None:
    here = build_state(model_of(1, 0))
    values = dict(zip(state.SCALAR_NAMES, np.arange(1.0, 8.0).tolist(), strict=True))
    state.put_scalars(here, values.values())
    state.put_phase(here, state.SLIP, -1, (2, 1))
    assert state.scalars_of(here) == values
    assert state.time_of(here) == values["time"]
    assert state.phase_of(here) == state.SLIP
    assert state.direction_of(here) == -1
    assert state.known_roots(here) == (2, 1)
    other = build_state(model_of(1, 0))
    state.copy_state(here, other)
    assert (other.x == here.x).all()
    state.clear(other)
    assert not other.x.any()
    assert not other.disc.any()


@pytest.mark.parametrize("size", SIZES)
def test_a_column_of_a_state_gives_the_state_back(size: tuple[int, int]) -> None:
    model = model_of(*size)
    here = build_state(model)
    there = build_state(model)
    column = np.random.default_rng(1).normal(size=columns.n_rows(model))
    columns.put_column(here, model, column)
    np.testing.assert_array_equal(columns.column_of(here, model), column)
    assert state.phase_of(here) == state.STICK
    columns.put_column(there, model, columns.column_of(here, model))
    np.testing.assert_array_equal(there.x, here.x)


def test_rows_of_a_column_name_its_coordinates() -> None:
    model = model_of(2, 1)
    rows = columns.coordinate_rows(model, ("u",))
    of_rows = columns.diameters_of_rows(model)
    assert len(of_rows) == columns.n_rows(model)
    l = of_rows[rows]
    # two diameters with no and one circle: four pairs, a and b, displacements and velocities; l = 0
    assert [int((l == each).sum()) for each in (0, 1, 2)] == [5, 8, 8]
    assert rows[-1] == columns.n_rows(model) - 2
    # an oscillation of a mode has as much energy in its displacement as in its velocity
    scale = columns.energy_scale(model)
    omega = np.sqrt(model.stiffness[model.stiffness > 0])
    of_z = scale[: len(model.shift)]
    of_e = scale[len(model.shift) : 2 * len(model.shift)]
    np.testing.assert_allclose(of_z[model.stiffness > 0], omega * of_e[model.stiffness > 0])
    of_psi, of_f, of_u, of_v = scale[-4:]
    assert of_psi / of_f == pytest.approx(np.sqrt(model.k_p / model.m))
    of_contact = 1 / model.compliance
    stiffness = model.k + of_contact
    omega = np.sqrt(stiffness / model.m)
    assert of_u / of_v == pytest.approx(omega)
