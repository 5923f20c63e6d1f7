"""What the numbers of pages are made of: results below a folder, pages from results, the package."""

import re
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
from docs.sentences import NUMBER, ROOT, Value, numbers_of

import disc_model as dm
from disc_model.data.dataset import Missing, MissingFile, load_tree
from disc_model.data.variables import flag_names
from disc_model.figures.shown import shown
from disc_model.figures.studies import lost_contact, thirds_of
from docs import brake_stress, plate_stiffening
from workflow.paper import ledger, measures, survival

FATES = {
    "separation": "separates",
    "growing": "grows",
    "other_cycle": "grows",
    "stick_slip": "quiet",
    "steady_sliding": "quiet",
    "at_rest": "quiet",
}
"""What becomes of a motion beside steady sliding, by its outcome."""
ROUNDING = 1e-9
"""Growth rate of undamped modes by rounding, 1/s."""
THICKNESS = 0.012
"""Thickness of the ring of the brake-like disc, m."""


class RangeLawCounts(NamedTuple):
    """Numbers of motions with 95 % of height and contact force at one frequency, and of these the
    ones whose range is within 5 % of the law, without and with the excess of flights."""

    single: int
    within: int
    explained: int


class Sources:
    """What expressions of statements are made of.

    Attributes
    ----------
    results : folder of the results
    """

    def __init__(self, results: Path) -> None:
        self.results = results

    def value(self, expression: str) -> Value:
        """Return the value of an expression; raises `MissingFile` if its results are not there."""
        known: dict[str, Any] = {"np": np, "dm": dm}
        for name in dir(self):
            if not name.startswith("_"):
                known[name] = getattr(self, name)
        value = eval(expression, known)
        return value if isinstance(value, str) else float(f"{float(value):.9g}")

    # ---- cases and verdicts

    def case(self, name: str) -> xr.DataTree:
        """Return a case of the paper."""
        return _load(self.results / "paper" / "cases" / f"{name}.nc")

    def first_separation(self, name: str) -> float:
        """Return the time of the first separation of a case, s."""
        return float(self.case(name)["first_separation"])

    def verdicts(self, verdict: str) -> int:
        """Return the number of the paper's statements with a verdict, without errors in print."""
        table = _table(self.results / "paper" / "claims.csv")
        counts = table["counts"] != "error in print"
        return int((counts & (table["verdict"] == verdict)).sum())

    def after_the_fact(self, verdict: str = "") -> int:
        """Return the number of statements whose rule was chosen when the results were known.

        They are those with a verdict, or all of them without one.
        """
        table = _table(self.results / "paper" / "claims.csv")
        chosen = table[table["counts"] == "after the fact"]
        if verdict:
            chosen = chosen[chosen["verdict"] == verdict]
        return len(chosen)

    def claims(self, print_error: bool) -> int:
        """Return the number of the paper's statements in the ledger, or of errors in print."""
        return sum(row.print_error == print_error for row in ledger.ROWS)

    def evidence(self, claim: str, unit: str = "") -> list[float]:
        """Return the numbers in the evidence on a statement, in the order of the text.

        Parameters
        ----------
        claim : row of the ledger
        unit : that follows the numbers; with one, those of the notes are included
        """
        row = _table(self.results / "paper" / "claims.csv").set_index("id").loc[claim]
        if not unit:
            return numbers_of(str(row["here"]))
        found = re.findall(rf"{NUMBER}(?= {unit})", f"{row['here']} {row['notes']}")
        return [numbers_of(number)[0] for number in found]

    def energy(self) -> np.ndarray:
        """Return energies in mJ per period, shape (cases, 4).

        They are supplied with separation and without it, and taken by damping and by impacts.
        """
        columns = ("supplied_mJ", "supplied_bilateral_mJ", "damped_mJ", "impacts_mJ")
        return _table(self.results / "paper" / "tables" / "energies.csv")[[*columns]].to_numpy()

    def less_in_compliant_contact(self) -> np.ndarray:
        """Return how much less energy a compliant contact supplies than a rigid one, %, shape (cases,
        3): on average, and in the stretches with most and with least."""
        columns = ("compliant_mJ", "compliant_most_mJ", "compliant_least_mJ")
        energies = _table(self.results / "paper" / "tables" / "energies.csv")
        ratios = energies[[*columns]].div(energies["supplied_mJ"], axis="index")
        return 100 * (1 - ratios.to_numpy())

    def table(self, name: str, column: str, row: int) -> float:
        """Return a value in a table of the paper's study."""
        table = _table(self.results / "paper" / "tables" / f"{name}.csv")
        return float(table[column].iloc[row])

    def pinned(self) -> np.ndarray:
        """Return late ranges of the slider's height over 2 N/|k - m omega^2|.

        They are of the runs that go on after a separation and in which the slider separates once
        per vibration of the lowest mode, whose circular frequency is omega.
        """
        ratios = []
        cases = _load(self.results / "paper" / "cases.nc")
        for case in measures.views({"cases": cases}).values():
            try:
                rate = case.rate_of("separation")
                late = case.late_range("u").width
            except Missing:
                continue
            omega = _lowest_frequency(case.parameters)
            if abs(2 * np.pi * rate / omega - 1) < 0.01:
                ratios.append(late / _contact_loss(case.parameters))
        return np.array(ratios)

    def pinned_range(self, N: float) -> float:
        """Return 2 N/|k - m omega^2| of the paper's disc, m."""
        return _contact_loss(_parameters(N=N))

    def range_law(self, heaviest: float = np.inf, lightest: float = 0.0) -> RangeLawCounts:
        """Return numbers of motions of the study `range_law` that lose contact again and again.

        Parameters
        ----------
        heaviest, lightest : bounds of the slider's mass, kg
        """
        study = self.grid("range_law")
        lost = study["range"].notnull() & (study["m"] <= heaviest) & (study["m"] >= lightest)
        single = lost & (study["vibration_share"] >= 0.95) & (study["force_share"] >= 0.95)
        deviation = study["deviation"]
        rest = abs(deviation - study["flight_excess"])
        return RangeLawCounts(
            single=int(single.sum()),
            within=int((single & (abs(deviation) <= 0.05)).sum()),
            explained=int((single & (rest <= 0.05)).sum()),
        )

    def locked(self, name: str, Omega: float, study: str = "locking") -> float:
        """Return a variable of a study of `locking` at a speed."""
        values = self.grid(study)[name]
        return float(values[int(np.abs(values["Omega"].values - Omega).argmin())])

    def lock_ends(self, releases: int) -> tuple[float, float]:
        """Return the ends of the step with so many releases in the study `locking`, rad/s."""
        speeds = self.grid("locking")["Omega"].values
        there = speeds[self.grid("locking")["period_releases"].values == releases]
        return float(there.min()), float(there.max())

    def releases_between(self, low: int, high: int) -> list[int]:
        """Return releases in the periods at the speeds between two steps of the study `locking`.

        Parameters
        ----------
        low, high : releases of the slower and of the faster step
        """
        study = self.grid("locking")
        _, begin = self.lock_ends(low)
        end, _ = self.lock_ends(high)
        there = (study["Omega"].values > begin) & (study["Omega"].values < end)
        found: list[int] = study["period_releases"].values[there].tolist()
        return found

    def count_of_motions(self, motion: str, study: str = "locking") -> int:
        """Return the number of points of a study of `locking` with a kind of motion."""
        return int((flag_names(self.grid(study)["motion"]) == motion).sum())

    def slope_of(self, separations: int) -> float:
        """Return the mean slope of a piece of the map of phases, among the phases that recur."""
        point = self.grid("locking_map")
        recurring = point["release_phase"]
        phase = point["map_phase"]
        near = (phase > recurring.min()) & (phase < recurring.max())
        piece = near & (point["map_separations"] == separations)
        return float(point["map_slope"].where(piece).mean())

    # ---- grid studies of the paper's disc

    def grid(self, study: str) -> xr.Dataset:
        """Return the dataset of a study, without axes of one value but that of discs."""
        dataset = _load(self.results / study / f"{study}.nc").to_dataset()
        single = [name for name, count in dataset.sizes.items() if count == 1 and name != "disc"]
        return dataset.squeeze(single)

    def separating_cells(self, normalization: str) -> int:
        """Return the number of points of the map over speed and preload that separate."""
        outcome = self.grid("map_N")["outcome"].sel(normalization=normalization)
        return int((flag_names(outcome) == "separation").sum())

    def inferred(self, normalization: str) -> float:
        """Return the percentage of the points of this map that are inferred from neighbours."""
        method = self.grid("map_N")["method"].sel(normalization=normalization)
        return float(100 * np.mean(flag_names(method) == "inferred"))

    def map_against_scan(self) -> tuple[int, int, int]:
        """Return numbers of points that this map shares with the scan of critical speeds.

        They are all, those where only one of the two separates, and of these the inferred ones.
        """
        cells = self.grid("map_N").sel(normalization="as_published")
        scan = self.grid("critical_speed")["scan_outcome"].rename(scan_Omega="Omega")
        cells, scan = xr.align(cells, scan, join="inner")
        mapped = flag_names(cells["outcome"].transpose("N", "Omega")) == "separation"
        inferred = flag_names(cells["method"].transpose("N", "Omega")) == "inferred"
        differ = mapped != (flag_names(scan.transpose("N", "Omega")) == "separation")
        return differ.size, int(differ.sum()), int((differ & inferred).sum())

    def lowest_speeds(self) -> np.ndarray:
        """Return the lowest speeds of this map with separation, with either scale of the modes.

        They are those of the preloads at which there are some, rad/s.
        """
        outcome = self.grid("map_N")["outcome"]
        separates = outcome.copy(data=flag_names(outcome) == "separation")
        lowest = outcome["Omega"].where(separates).min("Omega").values
        return lowest[np.isfinite(lowest)]

    def quiet_cycle(self) -> tuple[float, float, float]:
        """Return the least speed of the stable quiet cycle at 385 N, its fold, and a frequency.

        Speeds are in rad/s; the frequency is twice that of the cycle at the fold, Hz. The quiet
        cycle is that of the least range at 14 rad/s.
        """
        grid = self.grid("branches")
        speed = grid["value"].values
        stable = grid["growth_rate"].values < 0
        there = stable & (abs(speed - 14) < 0.2)
        ranges = np.where(there, grid["range"].values, np.inf)
        branch, point = np.unravel_index(ranges.argmin(), ranges.shape)
        unstable = np.flatnonzero(~stable[branch])
        first = unstable[unstable < point].max() + 1
        last = unstable[unstable > point].min() - 1
        # the fold itself is a point of the branch, and stable or unstable by rounding
        around = np.arange(first - 1, last + 2)
        fold = around[np.nanargmax(speed[branch, around])]
        least = min(speed[branch, first], speed[branch, last])
        return least, speed[branch, fold], 2 / grid["period"].values[branch, fold]

    def least_separating_speed(self) -> float:
        """Return the least speed with a stable cycle that separates at 385 N, rad/s."""
        grid = self.grid("branches")
        wanted = (grid["growth_rate"] < 0) & (grid["separations"] > 0)
        return float(grid["value"].where(wanted).min())

    def compared(self, normalization: str, word: str = "") -> int:
        """Return the number of points where steady sliding and the motion are compared.

        Parameters
        ----------
        normalization : of the modes
        word : how they agree, such as "unstable_separates"; all points if empty
        """
        moved = self.grid("map_c_p").sel(normalization=normalization)
        slid = self.grid("sliding").rename(value="c_p").sel(normalization=normalization)
        fate = xr.apply_ufunc(np.vectorize(FATES.get), shown(moved)["outcome"])
        rate = slid["largest_growth_rate"].reindex_like(fate, method="nearest", tolerance=1e-9)
        unstable = xr.where(rate > ROUNDING, "unstable_", "stable_").astype(object)
        common = rate.notnull()
        if not word:
            return int(common.sum())
        return int((common & (unstable + fate == word)).sum())

    def critical_speed(self, N: float, horizon: float = 1000) -> float:
        """Return the lowest speed with separation at a preload, within a horizon in s, rad/s."""
        return float(self.grid("critical_speed")["critical_speed"].sel(N=N, horizon=horizon))

    def couple_speed(self, N: float) -> float:
        """Return the critical speed with friction on the surface, rad/s.

        It is within 500 s, with orthonormal modes.
        """
        return float(self.grid("critical_speed_couple")["critical_speed"].sel(N=N))

    def orthonormal_speed(self, N: float) -> float:
        """Return the critical speed with friction in the middle plane, rad/s.

        It is within 500 s, with orthonormal modes.
        """
        study = self.grid("critical_speed_orthonormal")
        return float(study["critical_speed"].sel(N=N, horizon=500))

    def critical_energy(self, Omega: float) -> float:
        """Return the critical energy of separation at 385 N, J."""
        return float(self.grid("basins")["critical_energy"].sel(Omega=Omega))

    def attractor(self, Omega: float, name: str) -> float:
        """Return a value of the separating attractor of most starts at 385 N."""
        point = self.grid("basins").sel(Omega=Omega)
        kinds = flag_names(point["attractor_kind"]).tolist()
        return float(point[name][kinds.index("separating")])

    def speeds_with(self, *wanted: str) -> np.ndarray:
        """Return the speeds at which starts at 385 N lead to all of some kinds of motion, rad/s."""
        study = self.grid("basins")
        speeds = []
        for Omega in study["Omega"].values:
            kinds = flag_names(study["attractor_kind"].sel(Omega=Omega))
            if set(wanted) <= set(kinds.tolist()):
                speeds.append(float(Omega))
        return np.array(speeds)

    # ---- uncertain parameters

    def uncertain(self, study: str, N: float) -> xr.Dataset:
        """Return the point at a preload of a study of sensitivity."""
        grid = self.grid(study)
        return grid.isel(N_Omega=list(grid["N"].values).index(N))

    def chance(self, study: str, N: float, event: str) -> str:
        """Return a probability with its interval, as text."""
        point = self.uncertain(study, N)
        value = float(point[f"probability_{event}"])
        low = float(point[f"probability_{event}_low"])
        high = float(point[f"probability_{event}_high"])
        return f"{value:.2f} ({low:.2f} to {high:.2f})"

    def thirds(self, study: str, N: float, parameter: str) -> np.ndarray:
        """Return the probability of instability in the lowest and in the highest third of a
        parameter's range."""
        samples = shown(self.uncertain(study, N)).expand_dims("case")
        shares = thirds_of(samples)["share"].sel(parameter=parameter)
        return shares.isel(case=0).values

    def most_changing(self, study: str, N: float) -> str:
        """Return the largest changes of the probability of instability, as text.

        They are from the lowest third to the highest, three at most, and only if resolved.
        """
        changes = {}
        for name in self.uncertain(study, N)["parameter"].values:
            lowest, *_, highest = self.thirds(study, N, str(name))
            changes[str(name)] = float(highest - lowest)
        largest = sorted(changes, key=lambda name: -abs(changes[name]))[:3]
        words = [f"{name} {changes[name]:+.2f}" for name in largest if abs(changes[name]) >= 0.15]
        return ", ".join(words) or "none"

    # ---- the brake-like disc

    def brake(self, N: float, Omega: float, contact: str = "unilateral") -> float:
        """Return the range of the slider late in the motion, in thicknesses of the ring."""
        point = self.grid("brake_outcome").sel(disc="surface", N=N, Omega=Omega, contact=contact)
        return float(point["u_max"] - point["u_min"]) / THICKNESS

    def brake_ranges(self, contact: str = "unilateral", least: float = 50) -> xr.DataArray:
        """Return these ranges from a speed in rad/s on."""
        study = self.grid("brake_outcome").sel(disc="surface", contact=contact)
        study = study.where(study["Omega"] >= least, drop=True)
        return (study["u_max"] - study["u_min"]) / THICKNESS

    def brake_ratios(self) -> xr.DataArray:
        """Return these ranges in bilateral contact over those with separation."""
        return self.brake_ranges("bilateral") / self.brake_ranges()

    def brake_multiples(self) -> xr.DataArray:
        """Return the ranges with separation over those at which vibration at the frequency of the
        mode with the largest tangential motion loses contact."""
        study = shown(self.grid("brake_outcome").sel(disc="surface", contact="unilateral"))
        multiples = (study["u_max"] - study["u_min"]) / lost_contact(study)
        return multiples.where(study["first_separation"].notnull())

    def brake_separation(self, N: float, Omega: float) -> float:
        """Return the time of the first separation, s."""
        study = self.grid("brake_outcome").sel(disc="surface", contact="unilateral")
        point = study.sel(N=N, Omega=Omega)
        return float(point["first_separation"])

    def brake_separating(self) -> float:
        """Return the least speed at which the slider separates with both preloads, rad/s."""
        study = self.grid("brake_outcome").sel(disc="surface", contact="unilateral")
        separate = study["first_separation"].notnull().all("N")
        return float(study["Omega"].where(separate).min())

    def two_pads(self, disc: str) -> xr.DataArray:
        """Return the largest growth rate of steady sliding between two pads at 8 kN each, 1/s."""
        study = self.grid("brake_two_pads").sel(disc=disc, value=16000)
        return study["largest_growth_rate"]

    def two_pads_frequency(self, disc: str) -> float:
        """Return the frequency of the mode that grows fastest between these pads at 120 rad/s,
        kHz."""
        study = self.grid("brake_two_pads").sel(disc=disc, value=16000, Omega=120)
        fastest = study["mode_growth_rate"].argmax("mode")
        return 1e-3 * float(study["frequency"].isel(mode=fastest))

    def two_pads_missing(self, Omega: float) -> float:
        """Return by how much the growth rate with 48 modes differs from that with 138, percent."""
        rates = [self.two_pads(disc).sel(Omega=Omega) for disc in ("48 modes", "138 modes")]
        return 100 * abs(float(rates[0] / rates[1]) - 1)

    def stress(self, share: float) -> float:
        """Return what 1 m/s of the surface of this disc means in this share of it or more, MPa."""
        table = _table(brake_stress.TABLE).set_index("share")
        return float(1e-6 * table["stress_per_speed"][share])

    def brake_endured(self, strength: float) -> float:
        """Return the highest speed up to which all motions in unilateral contact stay below this
        stress, MPa, in 99 % of the disc."""
        study = self.grid("brake_outcome").sel(disc="surface", contact="unilateral")
        speed = study["surface_speed"] * study["Omega"] * brake_stress.SLIDER[0]
        endured = (self.stress(0.01) * speed < strength).all("N")
        return float(study["Omega"].where(endured.cumprod("Omega") > 0).max())

    def brake_mode(self, Omega: float) -> float:
        """Return the frequency of the mode of steady sliding that grows fastest at 8 kN, Hz."""
        rows = self.grid("brake_convergence").sel(disc="11 modes", contact_compliance=0)
        row = rows.isel(value=int(np.abs(rows["value"].values - Omega).argmin()))
        fastest = np.nanargmax(row["mode_growth_rate"].values)
        return float(row["frequency"].values[fastest])

    def brake_growth(self, disc: str, compliance: float) -> xr.DataArray:
        """Return the largest growth rate of steady sliding at 8 kN over the speed, 1/s."""
        study = self.grid("brake_convergence").sel(disc=disc, contact_compliance=compliance)
        return study["largest_growth_rate"]

    def brake_onset(self, disc: str, compliance: float) -> float:
        """Return the least speed of the study at which sliding grows, rad/s."""
        rates = self.brake_growth(disc, compliance)
        return float(rates["value"].where(rates > 0.01).min())

    def brake_cycles_without(self, damping: str, arc: float) -> float:
        """Return the largest growth rate of the cycle without tangential motion, 1/s."""
        study = self.grid("brake_growth").sel(disc=f"middle plane, damping ratio {damping}")
        return float(study["growth_rate"].sel(contact_arc=arc).max())

    def brake_sliding_without(self, damping: str) -> float:
        """Return the largest growth rate of steady sliding without tangential motion, 1/s."""
        study = self.grid("brake_growth").sel(disc=f"middle plane, damping ratio {damping}")
        return float(study["sliding_growth_rate"].max())

    def brake_pad(self, modes: int, arc: float, Omega: float) -> float:
        """Return the largest growth rate of steady sliding at 8 kN with a number of modes, 1/s."""
        study = self.grid("brake_pad").sel(disc=f"{modes} modes", contact_arc=arc)
        return float(study["largest_growth_rate"].sel(Omega=Omega, value=8000))

    def brake_pad_slowing(self, Omega: float) -> np.ndarray:
        """Return the fractions by which a pad lowers this growth rate, for each number of modes."""
        study = self.grid("brake_pad").sel(Omega=Omega, value=8000).drop_sel(disc="middle plane")
        rates = study["largest_growth_rate"]
        return 1 - (rates.sel(contact_arc=0.4) / rates.sel(contact_arc=0)).values

    def brake_pad_mode(self, modes: int, arc: float, Omega: float) -> float:
        """Return the frequency of the mode of steady sliding that grows fastest, kHz."""
        study = self.grid("brake_pad").sel(disc=f"{modes} modes", contact_arc=arc)
        row = study.sel(Omega=Omega, value=8000)
        fastest = np.nanargmax(row["mode_growth_rate"].values)
        return float(row["frequency"].values[fastest]) / 1e3

    def brake_mass(self, compliance: float) -> xr.DataArray:
        """Return the largest growth rate of steady sliding at 8 kN and 80 rad/s under a pad of
        40 mm over the mass of the slider, 1/s."""
        study = self.grid("brake_mass").sel(disc="surface", contact_arc=0.4, Omega=80)
        return study["largest_growth_rate"].sel(contact_compliance=compliance)

    def brake_mass_at(self, compliance: float, m: float) -> float:
        """Return this growth rate at a mass in kg, 1/s."""
        return float(self.brake_mass(compliance).sel(value=m, method="nearest"))

    def brake_mass_of_most_growth(self, compliance: float) -> float:
        """Return the mass at which this growth rate is largest, kg."""
        rates = self.brake_mass(compliance)
        return float(rates["value"].values[rates.values.argmax()])

    def brake_growing_without(self) -> int:
        """Return the number of points of the studies `brake_mass` and `brake_pad` at which sliding
        grows by more than 1e-6/s without tangential motion."""
        count = 0
        for name in ("brake_mass", "brake_pad"):
            rates = self.grid(name)["largest_growth_rate"].sel(disc="middle plane")
            count += int((rates > 1e-6).sum())
        return count

    # ---- results of `make survival` and of `make orthonormal`

    def _found(self, conclusion: str, model: str, column: str = "here") -> str:
        """Return a text on a conclusion under a model."""
        table = _table(self.results / "paper" / "survival.csv").set_index(["id", "model"])
        return str(table[column][conclusion, model])

    def survival(self, conclusion: str, model: str) -> list[float]:
        """Return the numbers that were found on a conclusion under a model."""
        return numbers_of(self._found(conclusion, model))

    def all_survival(self, conclusion: str, i: int) -> list[float]:
        """Return the i-th number that was found under each model."""
        return [self.survival(conclusion, model)[i] for model in survival.MODELS]

    def others(self) -> list[float]:
        """Return numbers of points without a stable cycle that do not separate, by model."""
        counts = []
        for model in survival.MODELS:
            separate, points, *_, stable = self.survival("Onset", model)[:6]
            counts.append(points - separate - stable)
        return counts

    def models(self, conclusion: str, verdict: str) -> int:
        """Return the number of models under which a conclusion has a verdict."""
        table = _table(self.results / "paper" / "survival.csv")
        return int(((table["id"] == conclusion) & (table["verdict"] == verdict)).sum())

    def ranges(self, model: str, paradox: bool = True) -> np.ndarray:
        """Return ranges of the disc with separation and in bilateral contact, mm, (cases, 2).

        Parameters
        ----------
        model : its name
        paradox : whether to count cases in which bilateral contact ends in Painlevé's paradox
        """
        pairs = self._found("Smaller vibration", model)
        notes = self._found("Smaller vibration", model, "notes")
        found = []
        row = r"([\d.]+) against ([\d.]+) mm at (\d+ N, [\d.]+ rad/s)"
        for separating, bilateral, place in re.findall(row, pairs):
            if paradox or f"{place} after" not in notes:
                found.append((float(separating), float(bilateral)))
        return np.array(found).reshape(-1, 2)

    def ratios(self) -> np.ndarray:
        """Return how many times smaller the ranges are with separation, under all models.

        Cases are left out in which bilateral contact ends in a paradox.
        """
        ranges = np.concatenate([self.ranges(model, False) for model in survival.MODELS])
        return ranges[:, 1] / ranges[:, 0]

    # ---- pages

    def accuracy(self) -> np.ndarray:
        """Return errors of event times divided by the default tolerance, by case."""
        page = (ROOT / "docs" / "verification.md").read_text(encoding="utf-8")
        section = page.partition("\n## Event times\n")[2].partition("\n## ")[0]
        rows = [line.split("|") for line in section.splitlines() if line.startswith("|")]
        return np.array([float(row[4]) for row in rows[2:]])

    # ---- the package

    def coupled_frequency(self, **changed: float) -> float:
        """Return the lowest natural frequency of the disc with the slider attached, Hz."""
        return _lowest_frequency(_parameters(**changed)) / np.pi / 2

    def frequencies(self, **changed: float) -> np.ndarray:
        """Return natural frequencies of the disc alone by nodal diameters, rad/s."""
        return dm.plate_modes(_parameters(**changed))["omega"].to_numpy()

    def moving_load(self) -> float:
        """Return the critical speed of a load that moves round the disc, rad/s."""
        return float(min(self.frequencies()[1:] / np.arange(1, 5)))

    def amplitude(self, normalization: str) -> float:
        """Return the modal amplitude under the slider with one nodal diameter, 1/sqrt(kg)."""
        return float(dm.plate_modes(_parameters(normalization=normalization))["psi"][1])

    def growth(self, **changed: float) -> float:
        """Return the growth rate of the stick-slip cycle, 1/s."""
        return dm.floquet(_parameters(**changed)).growth_rate

    def stick_slip_frequency(self) -> float:
        """Return the frequency of the cycle at 385 N, 15 rad/s, Hz."""
        return 1 / dm.floquet(_parameters(N=385, Omega=15)).period

    def sliding(self, **changed: Any) -> float:
        """Return the growth rate of steady sliding at 385 N with orthonormal modes, 1/s."""
        case = {"N": 385, "normalization": "orthonormal", **changed}
        return dm.steady_sliding(_parameters(**case)).growth_rate

    def stiffening(self, thicknesses: float) -> float:
        """Return the static stiffness of the disc at a deflection over that of linear theory."""
        p = _parameters(N=385, normalization="orthonormal")
        return plate_stiffening.stiffness_ratio(p, thicknesses)


def _parameters(**changed: Any) -> dm.Parameters:
    """Return the paper's case at 200 N, 20 rad/s with published modes, changed."""
    values: dict[str, Any] = {"N": 200, "Omega": 20, "normalization": "as_published"}
    values.update(changed)
    return dm.Parameters(**values)


def _lowest_frequency(p: dm.Parameters) -> float:
    """Return the lowest natural frequency of the disc with the slider attached, rad/s."""
    return float(dm.coupled_natural_frequencies(p)[0])


def _contact_loss(p: dm.Parameters) -> float:
    """Return the range of the slider's height at which its lowest mode loses contact, m."""
    omega = _lowest_frequency(p)
    return 2 * p.N / abs(p.k - p.m * omega**2)


@cache
def _load(path: Path) -> xr.DataTree:
    """Return a dataset."""
    return load_tree(path)


@cache
def _table(path: Path) -> pd.DataFrame:
    """Return a table; raises `MissingFile` if it is not there."""
    if not path.exists():
        raise MissingFile(f"{path}: there is no such file")
    return pd.read_csv(path, keep_default_na=False)
