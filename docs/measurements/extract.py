"""Make the small tables of docs/measurements/tables from the sources' raw data.

    python -m docs.measurements.extract FOLDER

The folder holds copies of the four repositories by the name of each: stickslip,
Advanced_Dynamic_Project, and Friction-Measurements-Between-PLA-and-Silicone. Only this script needs
them.
"""

from pathlib import Path

import numpy as np
import pandas as pd
from docs.measurements.signals import slips
from scipy.io import loadmat
from scipy.optimize import least_squares

from disc_model.errors import script

TABLES = Path(__file__).parent / "tables"
MOST = 600
"""Slips of a run that are kept, from its beginning."""
MODES = {2: (660.0, 675.0), 3: (1600.0, 1650.0), 4: (2820.0, 2880.0), 5: (4200.0, 4310.0)}
"""Bands of the wheel's axial modes, Hz, by numbers of nodal diameters."""
LOADS = "CoF-Measurements.csv"


def write(name: str, comment: str, table: pd.DataFrame) -> None:
    """Write a table with a comment that names its source."""
    text = "".join(f"# {line}\n" for line in comment.splitlines())
    (TABLES / name).write_text(text + table.to_csv(index=False), encoding="utf-8")


# ---- Paper dragged over paper


def stick_slip(folder: Path) -> None:
    """Write the slips of the nine runs."""
    rows = []
    for stiffness in (168, 1002, 2254):
        for speed in (42, 1100, 4300):
            data = loadmat(folder / "data_raw" / f"k{stiffness}Nm_v{speed}.mat")
            force = data["Fnorm"].ravel()
            found = slips(force)
            for slip in found[:MOST]:
                rows.append((stiffness, speed, *slip))
            print(stiffness, speed, len(found), force.size)
    head = ["stiffness_N_per_m", "speed_um_per_s", "start_s", "before", "after", "duration_s"]
    comment = (
        "Slips of paper on paper, at most 600 of each run; before, after: force over weight.\n"
        "From the force of github.com/npusteln/stickslip (J. Colas, N. Pustelnik and others,\n"
        "accepted by Physical Review E, 2019; licence CeCILL-B), by docs/measurements/extract.py."
    )
    table = pd.DataFrame(rows, columns=head).round(
        {"start_s": 4, "before": 4, "after": 4, "duration_s": 4}
    )
    write("stick_slip.csv", comment, table)


# ---- Wheel


def resonance(frequency: np.ndarray, response: np.ndarray) -> tuple[float, float]:
    """Return the natural frequency (Hz) and damping ratio of one mode from responses at all places,
    in a band around it.

    Each place has its own complex amplitude and residual; the mode has one frequency and one
    damping ratio.
    """
    omega = 2 * np.pi * frequency

    def deviation(x: np.ndarray) -> np.ndarray:
        natural, damping = 2 * np.pi * x[0], x[1]
        mode = -(omega**2) / (natural**2 - omega**2 + 2j * damping * natural * omega)
        shapes = np.stack([mode, np.ones_like(mode)], axis=1)
        parts, *_ = np.linalg.lstsq(shapes, response, rcond=None)
        rest = (shapes @ parts - response).ravel()
        return np.concatenate([rest.real, rest.imag])

    peak = frequency[np.abs(response).sum(axis=1).argmax()]
    search = least_squares(deviation, [peak, 0.005], x_scale=[1.0, 1e-3])
    return float(search.x[0]), float(search.x[1])


def wheel(folder: Path) -> None:
    """Write frequencies and damping ratios of the wheel's modes, and its responses there."""
    data = loadmat(folder / "Assignment 1" / "Data.mat")
    frequency, response, coherence = data["freq"].ravel(), data["frf"], data["cohe"]
    rows = []
    for diameters, (low, high) in MODES.items():
        band = (frequency > low) & (frequency < high)
        natural, damping = resonance(frequency[band], response[band])
        nearest = np.abs(frequency - natural).argmin()
        for place in range(response.shape[1]):
            value = response[nearest, place]
            alone = resonance(frequency[band], response[band][:, [place]])
            entry = (natural, damping, 15 * place, value.real, value.imag)
            rows.append((diameters, *entry, coherence[nearest, place], alone[0]))
    head = [
        "diameters",
        "frequency_Hz",
        "damping_ratio",
        "angle_deg",
        "real",
        "imaginary",
        "coherence",
        "own_frequency_Hz",
    ]
    comment = (
        "Axial inertance (m/s2 per N) of a light rail wheel at its natural frequencies, on the rim.\n"
        "own_frequency_Hz: natural frequency from the response at this place alone.\n"
        "From Data.mat of github.com/Alessandra200107/Advanced_Dynamic_Project (Politecnico di\n"
        "Milano, Advanced Dynamics of Mechanical Systems, L. Lanzillo), by docs/measurements/extract.py."
    )
    table = pd.DataFrame(rows, columns=head)
    digits = {"frequency_Hz": 2, "damping_ratio": 6, "own_frequency_Hz": 2}
    digits |= dict.fromkeys(("real", "imaginary", "coherence"), 4)
    write("wheel.csv", comment, table.round(digits))


# ---- Friction over load


def load(folder: Path) -> None:
    """Write the friction of PLA on two silicones, a row for each load."""
    data = pd.read_csv(folder / LOADS, index_col=0)
    groups = data.groupby(["DataName", "NominalLoad"])["CoF.mean"]
    table = groups.agg(["median", "std", "count"]).reset_index()
    table.columns = pd.Index(["series", "load_mN", "friction", "deviation", "cycles"])
    comment = (
        "Coefficient of friction of PLA on silicone over the load; deviation: of cycles.\n"
        "From github.com/tolstoys19/Friction-Measurements-Between-PLA-and-Silicone (MIT),\n"
        "by docs/measurements/extract.py."
    )
    write("load.csv", comment, table.round({"friction": 4, "deviation": 4}))


@script
def main(folder: str) -> None:
    """Write all tables."""
    TABLES.mkdir(exist_ok=True)
    stick_slip(Path(folder, "stickslip"))
    wheel(Path(folder, "Advanced_Dynamic_Project"))
    load(Path(folder, "Friction-Measurements-Between-PLA-and-Silicone"))
