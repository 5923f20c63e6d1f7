"""Numbers in sentences of README, docs and captions that come from results: `make numbers`.

``docs/statements.yaml`` holds the sentences, each with an expression in the place of a number. The
values of the expressions are stored as ``docs/numbers.json``, so that tests can compare the pages
with them where there are no results. An expression is made of the methods of `Sources`. This script
evaluates all of them and corrects the pages.
"""

from __future__ import annotations

import json
import math
import re
from functools import cache
from pathlib import Path
from string import Formatter, Template
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr
import yaml
from docs.drawings.brake_energy import powers

import disc_model as dm
from disc_model.data.dataset import MissingFile, load
from disc_model.data.variables import flag_names
from disc_model.disc.plate import mode_arrays, mode_shapes
from disc_model.errors import script
from disc_model.paper.survival import MODELS

ROOT = Path(__file__).parents[1]
STATEMENTS = yaml.safe_load((ROOT / "docs" / "statements.yaml").read_text(encoding="utf-8"))
PAGES = ["README.md", "docs/**/*.md", "config/**/*.yaml"]
"""Texts in which statements are looked for."""
NUMBER = r"[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?"
COUNTS = [
    "none",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
]
NOISE = 1e-6
"""Relative difference to which results of two processors agree (docs/accuracy.md), but for what `tolerances` of
statements.yaml names: there a last bit decides."""
Value = float | str


# ----------------------------------------------------------------------------------------------------
# Sentences


def shown(value: Value, spec: str) -> str:
    """A value as a page shows it; ``w`` as `spec` stands for a count in words, ``s`` for text."""
    if isinstance(value, str):
        return value
    return (
        COUNTS[round(value)] if spec == "w" else format(value, spec or ".0f").replace("e-0", "e-")
    )


def agrees(text: str, value: Value, spec: str) -> bool:
    """Whether `text` shows the value; where noise decides how the last digit is rounded, both ways
    are right."""
    values = [value] if isinstance(value, str) else [value * (1 - NOISE), value * (1 + NOISE)]
    return text.lower() in {shown(one, spec).lower() for one in values}


def reproduced(expression: str, text: str, value: Value, spec: str) -> bool:
    """Whether a value that was computed anew is that of `text`, as far as another processor gives
    it."""
    if agrees(text, value, spec):
        return True
    for tolerance in STATEMENTS["tolerances"]:
        if re.match(tolerance["expression"], expression):
            relative, absolute = tolerance.get("relative", 0.0), tolerance.get("absolute", 0.0)
            words, numbers = zip(*(_parts(one) for one in (text, shown(value, spec))), strict=True)
            first, second = numbers
            return words[0] == words[1] and np.allclose(
                first, second, rtol=relative, atol=absolute * (1 + 1e-9)
            )
    return False


def _parts(text: str) -> tuple[list[str], list[float]]:
    """A text without its numbers, and these; counts in words are numbers as well."""
    text = str(COUNTS.index(text)) if text in COUNTS else text
    return re.split(NUMBER, text), _numbers(text)


class Statement(NamedTuple):
    """A sentence: expressions and formats of its numbers, and the pattern that finds it on a page,
    links or not."""

    text: str
    page: str
    fields: list[tuple[str, str]]
    pattern: re.Pattern[str]

    @classmethod
    def parse(cls, text: str, page: str = "") -> Statement:
        link, fields, pattern = r"(?:\]\([^)]*\))?", [], ""
        for literal, expression, spec, _ in Formatter().parse(text):
            for token in re.findall(r"\s+|\w+|[^\s\w]", literal):
                pattern += (
                    rf"{link}\s+\[?"
                    if token.isspace()
                    else link * (not token[0].isalnum()) + re.escape(token)
                )
            if expression is not None:
                fields.append((expression, spec or ""))
                pattern += r"([^|\n]*?)" if spec == "s" else rf"({NUMBER}|\w+)"
        return cls(text, page, fields, re.compile(pattern))


def statements() -> list[Statement]:
    """All statements; one with `each` stands for as many as its lists have values."""
    found = []
    for entry in STATEMENTS["statements"]:
        entry = {"text": entry} if isinstance(entry, str) else entry
        each = entry.get("each", {})
        for row in zip(*each.values(), strict=True) if each else [()]:
            names = entry.get("with", {}) | dict(zip(each, row, strict=True))
            found.append(
                Statement.parse(Template(entry["text"]).substitute(names), entry.get("page", ""))
            )
    return found


@cache
def pages() -> dict[str, str]:
    """Texts in which statements are looked for, by path."""
    paths = [
        path
        for pattern in PAGES
        for path in sorted(ROOT.glob(pattern))
        if "_build" not in path.parts
    ]
    return {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in paths}


class Fault(NamedTuple):
    """A number of a page that is not that of a statement: where it stands, and what has to stand
    there."""

    page: str
    match: re.Match[str]
    group: int
    number: str


def faults(
    statement: Statement, texts: dict[str, str], values: dict[str, Value]
) -> tuple[int, list[Fault]]:
    """How often texts say a statement, and what is wrong in them."""
    matches = [
        (page, match)
        for page, text in texts.items()
        if page.endswith(statement.page)
        for match in statement.pattern.finditer(text)
    ]
    wrong = [
        Fault(page, match, i, shown(values[expression], spec))
        for page, match in matches
        for i, (expression, spec) in enumerate(statement.fields, 1)
        if not agrees(match[i], values[expression], spec)
    ]
    return len(matches), wrong


def corrected(texts: dict[str, str], values: dict[str, Value]) -> dict[str, str]:
    """Texts with the numbers of all statements."""
    texts = dict(texts)
    for statement in statements():
        for page, match, i, number in reversed(faults(statement, texts, values)[1]):
            texts[page] = texts[page][: match.start(i)] + number + texts[page][match.end(i) :]
    return texts


def stored() -> dict[str, Value]:
    """Values of the expressions."""
    values: dict[str, Value] = json.loads(
        (ROOT / "docs" / "numbers.json").read_text(encoding="utf-8")
    )
    return values


# ----------------------------------------------------------------------------------------------------
# Numbers


class Sources:
    """What expressions are made of: results below a folder, pages that are written from results,
    and the package."""

    def __init__(self, results: Path) -> None:
        self.results = results

    def value(self, expression: str) -> Value:
        """Value of an expression; raises `MissingFile` if it needs results that are not there."""
        known = {name: getattr(self, name) for name in dir(self) if name[0] != "_"} | {
            "np": np,
            "dm": dm,
        }
        value = eval(expression, known)
        return value if isinstance(value, str) else float(f"{float(value):.9g}")

    # ---- cases and verdicts

    def case(self, name: str) -> xr.DataTree:
        """A case of the paper."""
        return _load(self.results / "paper" / "cases" / f"{name}.nc")

    def first_separation(self, name: str) -> float:
        return float(self.case(name)["first_separation"])

    def verdicts(self, verdict: str) -> int:
        """Number of the paper's statements with a verdict, without errors in print."""
        ledger = _table(self.results / "paper" / "claims.csv")
        return int(((ledger["counts"] != "error in print") & (ledger["verdict"] == verdict)).sum())

    def claims(self, print_error: bool) -> int:
        """Number of the paper's statements in the ledger, or of errors in print."""
        from disc_model.paper.ledger import ROWS

        return sum(row.print_error == print_error for row in ROWS)

    def evidence(self, claim: str, unit: str = "") -> list[float]:
        """Numbers in the evidence on a statement, in the order of the text; with a unit, those that
        it follows."""
        row = _table(self.results / "paper" / "claims.csv").set_index("id").loc[claim]
        found = re.findall(rf"{NUMBER}(?= {unit})", f"{row['here']} {row['notes']}")
        return [_numbers(number)[0] for number in found] if unit else _numbers(str(row["here"]))

    def table(self, name: str, column: str, row: int) -> float:
        """A value in a table of the paper's study."""
        path = self.results / "paper" / "tables" / f"{name}.csv"
        if not path.exists():
            raise MissingFile(f"{path}: there is no such file")
        return float(pd.read_csv(path)[column].iloc[row])

    # ---- grid studies

    def grid(self, study: str) -> xr.Dataset:
        """The dataset of a study, without axes of one value."""
        return _load(self.results / study / f"{study}.nc").to_dataset().squeeze()

    def separating_cells(self, normalization: str) -> int:
        """Points of the map over speed and preload at which the static start separates."""
        return int(
            (
                flag_names(self.grid("map_N")["outcome"].sel(normalization=normalization))
                == "separation"
            ).sum()
        )

    def quiet_cycle(self) -> tuple[float, float, float]:
        """Least speed of the stable quiet cycle at 385 N, its fold, and twice its frequency there,
        Hz; it has the least range at 14 rad/s."""
        grid = self.grid("branches")
        speed, stable = grid["value"].values, grid["growth_rate"].values < 0
        ranges = np.where(stable & (abs(speed - 14) < 0.2), grid["range"].values, np.inf)
        branch, point = np.unravel_index(ranges.argmin(), ranges.shape)
        unstable = np.flatnonzero(~stable[branch])
        ends = unstable[unstable < point].max() + 1, unstable[unstable > point].min() - 1
        fold = np.nanargmax(speed[branch])
        return (
            min(speed[branch, ends]),
            speed[branch, fold],
            2 / grid["period"].values[branch, fold],
        )

    def least_separating_speed(self) -> float:
        """Least speed with a stable cycle that separates at 385 N."""
        grid = self.grid("branches")
        return float(
            grid["value"].where((grid["growth_rate"] < 0) & (grid["separations"] > 0)).min()
        )

    def compared(self, normalization: str, word: str = "") -> int:
        """Number of points where steady sliding and the motion are compared; with a key of
        `AGREEMENTS`."""
        from disc_model.figures.selection import common_points
        from disc_model.figures.sliding_outcome import agreement

        studies = (self.grid("map_c_p"), self.grid("sliding").rename(value="c_p"))
        moved, slid = (
            each.sel(normalization=normalization).transpose("N", "c_p", ...) for each in studies
        )
        plane, linear = common_points(moved, slid, ("N", "c_p"))
        words = agreement(linear["largest_growth_rate"].values, flag_names(plane["outcome"]))
        return int((words == word).sum()) if word else words.size

    def critical_speed(self, N: float, horizon: float = 1000) -> float:
        return float(self.grid("critical_speed")["critical_speed"].sel(N=N, horizon=horizon))

    def lowest_speeds(self) -> np.ndarray:
        """Lowest speeds of the map with separation, at the preloads that have some, with either
        scale of the modes."""
        outcome = self.grid("map_N")["outcome"]
        lowest = (
            outcome["Omega"]
            .where(outcome.copy(data=flag_names(outcome) == "separation"))
            .min("Omega")
            .values
        )
        return lowest[np.isfinite(lowest)]

    def brake(self, disc: str, N: float, Omega: float, contact: str = "unilateral") -> float:
        """Range of the slider late in the motion on the brake-like disc, in thicknesses."""
        point = self.grid("brake_outcome").sel(disc=disc, N=N, Omega=Omega, contact=contact)
        return float(point["u_max"] - point["u_min"]) / 0.012

    def brake_separation(self, disc: str, N: float, Omega: float) -> float:
        """Time of the first separation on the brake-like disc, s."""
        point = self.grid("brake_outcome").sel(disc=disc, N=N, Omega=Omega, contact="unilateral")
        return float(point["first_separation"])

    def brake_energy(self, contact: str, part: str) -> float:
        """Mean power of a part at 8 kN and 80 rad/s late in the motion, kW."""
        return abs(powers(80, contact)[part]) / 1e3

    def brake_mode(self, Omega: float) -> float:
        """Frequency of the mode of steady sliding that grows fastest on the brake-like disc at 8
        kN, Hz."""
        rows = self.grid("brake_convergence").sel(disc="11 modes", contact_compliance=0)
        row = rows.isel(value=int(np.abs(rows["value"].values - Omega).argmin()))
        return float(row["frequency"].values[np.nanargmax(row["mode_growth_rate"].values)])

    def couple_speed(self, N: float) -> float:
        """Critical speed within 500 s with orthonormal modes and friction on the surface, rad/s."""
        return float(self.grid("critical_speed_couple")["critical_speed"].sel(N=N))

    def orthonormal_speed(self, N: float) -> float:
        """The same with friction in the middle plane."""
        return float(
            self.grid("critical_speed_orthonormal")["critical_speed"].sel(N=N, horizon=500)
        )

    def critical_energy(self, Omega: float) -> float:
        return float(self.grid("basins")["critical_energy"].sel(Omega=Omega))

    def attractor(self, Omega: float, name: str) -> float:
        """Value of the separating attractor of most starts at 385 N."""
        point = self.grid("basins").sel(Omega=Omega)
        kinds = flag_names(point["attractor_kind"])
        return float(point[name][list(kinds).index("separating")])

    def uncertain(self, study: str, N: float) -> xr.Dataset:
        """A point of a study of sensitivity."""
        grid = self.grid(study)
        return grid.isel(N_Omega=list(grid["N"].values).index(N))

    def chance(self, study: str, N: float, event: str) -> str:
        """A probability with its interval."""
        point = self.uncertain(study, N)
        value, low, high = (
            float(point[f"probability_{event}{end}"]) for end in ("", "_low", "_high")
        )
        return f"{value:.2f} ({low:.2f} to {high:.2f})"

    def thirds(self, study: str, N: float, parameter: str) -> np.ndarray:
        """Probability of instability in thirds of a parameter's range."""
        from disc_model.figures.sensitivity import probabilities

        return probabilities(self.uncertain(study, N), parameter)[:, 0]

    def most_changing(self, study: str, N: float) -> str:
        """The largest changes of the probability of instability, from the lowest third to the
        highest, if resolved."""
        names = map(str, self.uncertain(study, N)["parameter"].values)
        changes = {name: float(np.diff(self.thirds(study, N, name)[[0, -1]])[0]) for name in names}
        largest = sorted(changes, key=lambda name: -abs(changes[name]))[:3]
        return (
            ", ".join(
                f"{name} {changes[name]:+.2f}" for name in largest if abs(changes[name]) >= 0.15
            )
            or "none"
        )

    # ---- results of `make survival` and of `make orthonormal`, and pages

    def survival(self, conclusion: str, model: str) -> list[float]:
        """Numbers that were found for a model."""
        return _numbers(self._found(conclusion, model))

    def _found(self, conclusion: str, model: str, column: str = "here") -> str:
        table = _table(self.results / "paper" / "survival.csv").set_index(["id", "model"])
        return str(table[column][conclusion, model])

    def all_survival(self, conclusion: str, i: int) -> list[float]:
        """The i-th number that was found for each model."""
        return [self.survival(conclusion, model)[i] for model in MODELS]

    def others(self) -> list[float]:
        """Points without a stable cycle that do not separate, by model."""
        return [n[1] - n[0] - n[5] for n in (self.survival("Onset", model) for model in MODELS)]

    def models(self, conclusion: str, verdict: str) -> int:
        """Number of models under which a conclusion has a verdict."""
        table = _table(self.results / "paper" / "survival.csv")
        return int(((table["id"] == conclusion) & (table["verdict"] == verdict)).sum())

    def ranges(self, model: str, paradox: bool = True) -> np.ndarray:
        """Ranges of the disc's displacement with separation and in bilateral contact, mm, shape
        (cases, 2); with or without cases in which bilateral contact ends in Painlevé's paradox."""
        pairs, notes = (
            self._found("Smaller vibration", model, column) for column in ("here", "notes")
        )
        rows = re.findall(r"([\d.]+) against ([\d.]+) mm at (\d+ N, [\d.]+ rad/s)", pairs)
        return np.array(
            [row[:2] for row in rows if paradox or f"{row[2]} after" not in notes], dtype=float
        )

    def energy(self) -> np.ndarray:
        """Energies in mJ per period, shape (cases, 4): supplied with separation and without it,
        taken by damping and by impacts."""
        numbers = self.evidence("F10e", "mJ")
        return np.hstack([np.reshape(numbers[:6], (3, 2)), np.reshape(numbers[9:], (3, 2))])

    def ratios(self) -> np.ndarray:
        """How many times smaller they are with separation, under all models, where bilateral
        contact goes on."""
        ranges = np.concatenate([self.ranges(model, paradox=False) for model in MODELS])
        return ranges[:, 1] / ranges[:, 0]

    def line(self, page: str, heading: str, start: str) -> list[float]:
        """Numbers in the first row of a table of docs/ that begins as stated, below a heading."""
        return _numbers("|".join(_row(page, heading, start)[2:]))

    def accuracy(self) -> np.ndarray:
        """Errors of event times divided by the default tolerance, by case."""
        text = (
            (ROOT / "docs" / "accuracy.md")
            .read_text(encoding="utf-8")
            .partition("\n## Event times\n")[2]
        )
        rows = [
            line.split("|")
            for line in text.partition("\n## ")[0].splitlines()
            if line.startswith("|")
        ][2:]
        return np.array([float(row[4]) for row in rows])

    # ---- the package

    def coupled_frequency(self, **changed: float) -> float:
        """Lowest natural frequency of the disc with the slider attached, Hz."""
        return float(dm.coupled_natural_frequencies(_parameters(**changed))[0] / np.pi / 2)

    def frequencies(self, **changed: float) -> np.ndarray:
        """Natural frequencies of the disc alone, rad/s, by the number of nodal diameters."""
        return dm.plate_modes(_parameters(**changed))["omega"].to_numpy()

    def moving_load(self) -> float:
        """Critical speed of a load that moves round the disc, rad/s."""
        return float(min(self.frequencies()[1:] / np.arange(1, 5)))

    def amplitude(self, normalization: str) -> float:
        """Modal amplitude under the slider with one nodal diameter, 1/sqrt(kg)."""
        return float(dm.plate_modes(_parameters(normalization=normalization))["psi"][1])

    def growth(self, **changed: float) -> float:
        return dm.floquet(_parameters(**changed)).growth_rate

    def sliding(self, **changed: Any) -> float:
        """Largest growth rate of steady sliding at 385 N with orthonormal modes, 1/s."""
        case = {"N": 385, "normalization": "orthonormal"} | changed
        return dm.steady_sliding(_parameters(**case)).growth_rate

    def stiffening(self, thicknesses: float) -> float:
        """Static stiffness of the lowest mode without nodal diameters at a deflection, over that of
        linear theory.

        One mode by von Karman's equations, its radial displacement by polynomials, clamped inside
        and free outside.
        """
        p = _parameters(N=385, normalization="orthonormal")
        modes, (x, weights) = mode_arrays(p), np.polynomial.legendre.leggauss(60)
        width = p.b - p.a
        r = p.a + width * (x + 1) / 2
        fine = np.linspace(p.a, p.b, 2001)
        shape = mode_shapes(p, fine)[0] / modes.psi[0]
        slope = np.interp(r, fine, np.gradient(shape, fine, edge_order=2))
        powers, part = np.arange(1, 9), ((r - p.a) / width)[:, None]
        strains = np.stack([powers * part ** (powers - 1) / width, part**powers / r[:, None]])
        law = p.E * p.h / (1 - p.nu**2) * np.array([[1, p.nu], [p.nu, 1]])
        area = weights * width / 2 * math.tau * r
        bent = np.stack([slope**2 / 2, 0 * slope])
        matrix = np.einsum("k,ab,aki,bkj->ij", area, law, strains, strains)
        free = np.linalg.solve(matrix, -np.einsum("k,ab,ak,bki->i", area, law, bent, strains))
        strain = strains @ free + bent
        energy = np.einsum("k,ab,ak,bk->", area, law, strain, strain) / 2
        return float(
            1 + 4 * energy * (p.h * thicknesses) ** 2 * modes.psi[0] ** 2 / modes.omega[0] ** 2
        )

    def stick_slip_frequency(self) -> float:
        return 1 / dm.floquet(_parameters(N=385, Omega=15)).period


def _parameters(**changed: Any) -> dm.Parameters:
    values: dict[str, Any] = {"N": 200, "Omega": 20, "normalization": "as_published"}
    return dm.Parameters(**(values | changed))


@cache
def _load(path: Path) -> xr.DataTree:
    return load(path)


@cache
def _table(path: Path) -> pd.DataFrame:
    if not path.exists():
        raise MissingFile(f"{path}: there is no such file")
    return pd.read_csv(path, keep_default_na=False)


def _row(page: str, heading: str, start: str) -> list[str]:
    """Cells of the first row that begins as stated; the first cell is the second entry."""
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8").partition(f"\n{heading}\n")[2]
    return next(line for line in text.splitlines() if line.startswith(f"| {start}")).split("|")


def _numbers(text: str) -> list[float]:
    return [
        float(number.replace(",", "")) for number in re.findall(rf"(?<![A-Za-z\d]){NUMBER}", text)
    ]


@script
def main(results: str = "results") -> None:
    """Evaluate all expressions, and correct the pages; what needs results that are not there stays
    as it was."""
    sources, old, values = Sources(ROOT / results), stored(), {}
    for expression in sorted(
        {expression for statement in statements() for expression, _ in statement.fields}
    ):
        try:
            values[expression] = sources.value(expression)
        except MissingFile:
            if expression not in old:
                raise
            values[expression] = old[expression]
    text = json.dumps(values, indent=0, ensure_ascii=False) + "\n"
    (ROOT / "docs" / "numbers.json").write_text(text, encoding="utf-8")
    for page, text in corrected(pages(), values).items():
        (ROOT / page).write_text(text, encoding="utf-8")
