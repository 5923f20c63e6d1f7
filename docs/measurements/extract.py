"""Make the small tables of docs/measurements/tables from the sources' raw data.

    python -m docs.measurements.extract FOLDER

The folder holds copies of three repositories, each in the state that `COMMITS` names: stickslip,
Advanced_Dynamic_Project, and Friction-Measurements-Between-PLA-and-Silicone. Only this script needs
them. The frequencies of the bronze disc were copied by hand and stand in wheel.py.
"""

from pathlib import Path

import numpy as np
import pandas as pd
from docs.measurements.resonances import harmonic, residues, resonances, shape_error
from docs.measurements.signals import LEAST_FALLS, RATE, slips
from scipy.io import loadmat

from disc_model.errors import script

TABLES = Path(__file__).parent / "tables"
COMMITS = {
    "stickslip": "84acb9815970600307a3edb4758b1594fb7f2e1c",
    "Advanced_Dynamic_Project": "62294966d24e2935cad109fcf9c00166d881d40d",
    "Friction-Measurements-Between-PLA-and-Silicone": "b970d33f3c8c5eacfb93c61c2f5235ec11024a4b",
}
"""States of the repositories from which the tables were made."""
SLIDING = (2254, 42)
"""Stiffness (N/m) and speed (µm/s) of the run that the source calls continuous sliding."""
BANDS = {
    "2": (660.0, 675.0),
    "3": (1600.0, 1650.0),
    "4": (2820.0, 2880.0),
    "5": (4200.0, 4310.0),
    "not planned, 2069 Hz": (2040.0, 2100.0),
    "not planned, 3494 Hz": (3450.0, 3560.0),
}
"""Bands of the wheel's peaks, Hz: planned ones by numbers of nodal diameters, and the two weaker peaks
of the summed responses that the plan left out."""
LOADS = "CoF-Measurements.csv"


def write(name: str, comment: str, table: pd.DataFrame) -> None:
    """Write a table with a comment that names its source."""
    text = "".join(f"# {line}\n" for line in comment.splitlines())
    (TABLES / name).write_text(text + table.to_csv(index=False), encoding="utf-8")


# ---- Paper dragged over paper


def stick_slip(folder: Path) -> None:
    """Write the slips of the runs for each least fall, and what is known of each run."""
    rows = []
    runs = []
    for stiffness in (168, 1002, 2254):
        for speed in (42, 1100, 4300):
            data = loadmat(folder / "data_raw" / f"k{stiffness}Nm_v{speed}.mat")
            force = data["Fnorm"].ravel()
            quantum = np.diff(np.unique(force)).min()
            run = [stiffness, speed, force.size / RATE, quantum, force.mean()]
            for least_fall in LEAST_FALLS:
                found = slips(force, least_fall)
                run.append(len(found))
                if (stiffness, speed) != SLIDING:
                    rows += [(least_fall, stiffness, speed, *slip) for slip in found]
            runs.append(run)
    source = (
        "From the force of github.com/npusteln/stickslip (J. Colas, N. Pustelnik and others,\n"
        "accepted by Physical Review E, 2019; licence CeCILL-B), by docs/measurements/extract.py."
    )

    head = ["least_fall", "stiffness_N_per_m", "speed_um_per_s"]
    head += ["start_s", "before", "after", "duration_s"]
    comment = (
        "Slips of paper on paper, by the least fall that counts; before, after: force over weight."
    )
    write("stick_slip.csv", f"{comment}\n{source}", pd.DataFrame(rows, columns=head).round(4))

    head = ["stiffness_N_per_m", "speed_um_per_s", "length_s", "quantum", "mean_force"]
    head += [f"slips_{least_fall}" for least_fall in LEAST_FALLS]
    comment = (
        "Runs of paper on paper: length of the record, least step of the force (over weight), its mean,\n"
        "and numbers of slips by the least fall that counts."
    )
    digits = {"length_s": 2, "quantum": 5, "mean_force": 4}
    write(
        "stick_slip_runs.csv",
        f"{comment}\n{source}",
        pd.DataFrame(runs, columns=head).round(digits),
    )


# ---- Wheel


def wheel(folder: Path) -> None:
    """Write frequencies, damping ratios and errors of shapes of the wheel's peaks.

    The repository states no licence, so that its responses are not kept, only what was found from
    them.
    """
    data = loadmat(folder / "Assignment 1" / "Data.mat")
    frequency = data["freq"].ravel()
    response = data["frf"]
    strongest = np.abs(response).sum(axis=1).max()
    rows = []
    for peak, (low, high) in BANDS.items():
        band = (frequency > low) & (frequency < high)
        strength = np.abs(response[band]).sum(axis=1).max() / strongest
        most = 2 if peak.isdigit() else 1
        for modes in range(1, most + 1):
            found = resonances(frequency[band], response[band], modes)
            if modes == 1:
                nearest = np.abs(frequency - found.frequency[0]).argmin()
                read = response[nearest]
                rows.append((peak, "read", *found.of(0), *errors(read, peak), found.rest, strength))
            total = residues(found, frequency[band], response[band]).sum(axis=0)
            for i in range(modes):
                row = (peak, f"{modes} fitted", *found.of(i), *errors(total, peak))
                rows.append((*row, found.rest, strength))
    head = ["peak", "amplitudes", "frequency_Hz", "damping_ratio", "diameters"]
    head += ["error_real", "error_complex", "error_other", "rest", "strength"]
    comment = (
        "Peaks of the axial response of a light rail wheel, measured at twelve places on the rim by\n"
        "Politecnico di Milano. amplitudes: read at the peak, or sums of residues of one or two fitted\n"
        "modes. error_real, error_complex: root mean square difference from cos(diameters * angle), of the\n"
        "real parts, and of the complex amplitudes; error_other: least error_real of any other number of\n"
        "diameters up to 7. rest: part of the response that the fit leaves (rms). strength: height of the\n"
        "peak in the sum of the twelve responses, over that of the highest.\n"
        "Found by docs/measurements/extract.py from Data.mat of\n"
        "github.com/Alessandra200107/Advanced_Dynamic_Project, whose responses are not kept here."
    )
    digits = {
        "frequency_Hz": 2,
        "damping_ratio": 6,
        "error_real": 4,
        "error_complex": 4,
        "error_other": 4,
        "rest": 5,
        "strength": 4,
    }
    write("wheel.csv", comment, pd.DataFrame(rows, columns=head).round(digits))


def errors(amplitudes: np.ndarray, peak: str) -> tuple[int, float, float, float]:
    """Return the number of nodal diameters, errors of the shape (of real and complex amplitudes), and
    the least error (real) of any other number.

    The number is the planned one, or for a peak that was not planned that with the least error.
    """
    angles = np.radians(15 * np.arange(amplitudes.size))
    relative = amplitudes / amplitudes[0]
    real = [shape_error(relative.real, harmonic(number, angles)) for number in range(8)]
    diameters = int(peak) if peak.isdigit() else int(np.argmin(real))
    others = real[:diameters] + real[diameters + 1 :]
    whole = shape_error(relative, harmonic(diameters, angles))
    return diameters, real[diameters], whole, min(others)


# ---- Friction over load


def load(folder: Path) -> None:
    """Write the friction of PLA on two silicones, a row for each load."""
    data = pd.read_csv(folder / LOADS, index_col=0)
    groups = data.groupby(["DataName", "NominalLoad"])
    friction = groups["CoF.mean"].agg(["median", "std", "count"])
    friction["sequence"] = groups["SequenceID"].first()
    table = friction.reset_index()
    table.columns = pd.Index(["series", "load_mN", "friction", "deviation", "cycles", "sequence"])
    comment = (
        "Coefficient of friction of PLA on silicone over the load; deviation: of cycles; sequence: place\n"
        "in the order of the test, 1 throughout where the source does not tell it.\n"
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
