"""Make Table 1 or 2 of the paper beside ours, or a table of what results rest on: as CSV, as Markdown and as a page."""

from pathlib import Path

from disc_model.data.dataset import Missing, load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from disc_model.paper.measures import views
from disc_model.paper.paper_tables import COLUMNS, TABLE_2, impact_law, periods, table_1, table_2

TITLES = {
    "table1": "Table 1: base values",
    "table2": "Table 2: frequencies of the disc in the first 10 s",
    "periods": "Periods under other tolerances and numbers of modes",
    "impact_law": "Motion after impacts with more modes",
}
NOTES = {
    "table1": "Defaults of disc_model.Parameters; SI units.",
    "table2": (
        "Lines of the disc's displacement at r_0 and θ = 1; levels relative to the drive's line. f_s is the rate of "
        "stick and slip, the strongest line of ψ; f_Ω = Ω/2π. What a line is, is found among n f_s + m f_Ω."
    ),
    "periods": (
        "Number of releases after which the motion repeats to 1e-8 s, in the last 60 s of a run from the static "
        "start. The last column is the interval of speeds with the same period, reached by small changes of the "
        "speed."
    ),
    "impact_law": (
        "At 385 N, 15.1 rad/s, in the last 20 s of a run from the static start, 120 s long (480 s with nine "
        "modes). The plastic impact law depends on the number of modes. What the ledger says of the rate and "
        "duration of separations, of stick, of periods after separation and of the energy of impacts is that of "
        "nine modes. The first separation and the range of the disc hardly depend on it."
    ),
}
NAMES = {
    "paper_Hz": "Paper (Hz)",
    "ours_Hz": "Computed (Hz)",
    "level_dB": "Level (dB)",
    "ours_is": "What it is",
    "predicted_Hz": "That is (Hz)",
    "paper_says": "The paper's attribution",
    "symbol": "Symbol",
    "quantity": "Quantity",
    "unit": "Unit",
    "paper": "Paper",
    "ours": "Here",
    "case": "Case",
    "width": "Interval (rad/s)",
    "modes": "Modes",
    "first_s": "First separation (s)",
    "rate_Hz": "Separations (1/s)",
    "longest_ms": "Longest (ms)",
    "separated_%": "Separated (%)",
    "stick_%": "Stick (%)",
    "range_mm": "Range of the disc (mm)",
    "releases": "Releases",
}


@script
def main(name: str, csv: str, md: str, html: str, *paths: str) -> None:
    cases, note = views(load_cases([*map(Path, paths)])) if paths else {}, NOTES[name]
    if name == "table1":
        table = table_1(cases["F13"].parameters)
    elif name == "table2":
        try:
            table = table_2(cases["F13"]).round(3)
        except Missing as reason:
            table, note = TABLE_2.reindex(columns=COLUMNS), f"Not computed: {reason}."
    else:
        table = periods().round(4) if name == "periods" else impact_law(cases).round(2)
    table.to_csv(csv, index=False)
    for file in (md, html):
        write_page(file, TITLES[name], ("", note, table.rename(columns=NAMES)))
