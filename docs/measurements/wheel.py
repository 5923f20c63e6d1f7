"""A wheel and a bronze disc as discs of the model: shapes, frequencies, damping (B, C, D)."""

import math

import numpy as np
from docs.measurements.comparison import Comparison, read, within

import disc_model as dm

SHAPES = 0.1
"""Greatest root mean square difference of a shape."""
FREQUENCIES = 0.05
"""Tolerance of natural frequencies, relative."""
DAMPING = 0.25
"""Tolerance of damping ratios, relative."""
BRONZE = {2: 299.125, 3: 712.0, 4: 1320.0}
"""Natural frequencies of the bronze disc, Hz, by nodal diameters (IHS Stuttgart, impact test)."""
PLATES = {
    "wheel": {"E": 210e9, "nu": 0.3, "rho": 7850.0, "b": 0.3, "a": 0.003, "r_0": 0.25},
    "bronze disc": {"E": 75.854e9, "nu": 0.34, "rho": 8910.0, "b": 0.1, "a": 0.001, "r_0": 0.09},
}
"""Plates that stand for both. The clamp is a hundredth of the radius, which changes modes with two or
more nodal diameters by less than a millionth. The ratios of frequencies depend on nu alone; E, rho and b
of the wheel, which are not known, and its thickness only set their scale."""


def shapes() -> list[Comparison]:
    """Return B: root mean square differences of the shapes on the rim; the prediction is 0.

    The model's shape is the deflection of a disc with the modes of the wheel, one at a time, over
    that under the hammer.
    """
    table = read("wheel.csv")
    found = []
    for diameters, rows in table.groupby("diameters"):
        angles = np.radians(rows["angle_deg"].to_numpy())
        response = rows["real"].to_numpy() + 1j * rows["imaginary"].to_numpy()
        seen = (response / response[0]).real[1:]
        model = shape(int(diameters), angles)[1:]  # type: ignore[call-overload]
        error = float(np.sqrt(np.mean((seen - model) ** 2)))
        found.append(Comparison(f"{diameters} nodal diameters", error, 0.0, "", error < SHAPES))
    return found


def shape(diameters: int, angles: np.ndarray) -> np.ndarray:
    """Return the model's deflection at angles from the hammer, 1 under it."""
    disc = dm.Disc(
        diameters=[diameters],
        omega=[1000.0],
        amplitude=[1.0],
        radii=[0.1, 0.2],
        shapes=[[1.0, 1.0]],
    )
    p = dm.Parameters(N=1, Omega=0, disc=disc, r_0=0.1)
    start = dm.simulate(p, 1e-6).final_state
    values = dm.deflection(p, start, 0.1, angles).to_numpy().ravel()
    return np.asarray(values / values[0])


def frequencies() -> list[Comparison]:
    """Return C: natural frequencies of uniform plates with a thickness fitted to the lowest."""
    table = read("wheel.csv").groupby("diameters")["frequency_Hz"].first()
    bodies = {"wheel": table.to_dict(), "bronze disc": BRONZE}
    found = []
    for body, measured in bodies.items():
        p = plate(body, measured[2], max(measured))
        modes = dm.plate_modes(p).set_index("diameters")["omega"]
        for diameters in sorted(measured)[1:]:
            value, expected = measured[diameters], modes[diameters] / math.tau
            agrees = within(value, expected, FREQUENCIES)
            what = f"{body}, {diameters} nodal diameters"
            found.append(Comparison(what, value, expected, "Hz", agrees))
    return found


def plate(body: str, lowest: float, diameters: int) -> dm.Parameters:
    """Return a uniform plate whose mode with two nodal diameters has a given frequency (Hz)."""
    known = PLATES[body]
    start = dm.Parameters(
        N=0,
        Omega=0,
        h=0.04 * known["b"],
        n_diameters=diameters,
        normalization="orthonormal",
        **known,
    )
    return dm.fit(start, ["h"], {"frequency_2_0": (lowest, 0.1)}).case


def damping() -> list[Comparison]:
    """Return D: damping ratios of the wheel by each of the two laws, set by the lowest mode."""
    table = read("wheel.csv").groupby("diameters")[["frequency_Hz", "damping_ratio"]].first()
    lowest = table.loc[2]
    start = plate("wheel", lowest["frequency_Hz"], 5).replace(D_star=1.0)
    fitted = dm.fit(start, ["D_star"], {"damping_ratio_2_0": (lowest["damping_ratio"], 1e-5)})
    found = []
    for diameters, row in table.iterrows():
        if diameters == 2:
            continue
        value = row["damping_ratio"]
        # D_star damps a mode in proportion to its frequency, here the measured one
        rising = fitted.parameters["D_star"].value / (2 * start.D) * math.tau * row["frequency_Hz"]
        for law, expected in (("D_star", rising), ("damping_ratio", lowest["damping_ratio"])):
            agrees = within(value, expected, DAMPING)
            what = f"{diameters} nodal diameters, by {law}"
            found.append(Comparison(what, value, float(expected), "", agrees))
    return found
