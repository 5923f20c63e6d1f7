"""Make Table 1 or 2 of the paper with our values beside its own: as CSV, as Markdown and as a page."""

import math
from pathlib import Path

from disc_model.data.dataset import load_inputs, markdown_table
from disc_model.errors import script
from disc_model.paper.measures import CaseView
from disc_model.paper.pages import table_page
from disc_model.paper.paper_tables import table_1, table_2_or_why

TITLES = {"table1": "Table 1: base values", "table2": "Table 2: frequencies of the disc in the first 10 s"}
NOTES = {
    "table1": "Defaults of disc_model.Parameters; SI units.",
    "table2": (
        "Lines of the disc's displacement at r_0 and θ = 1; levels relative to the drive's line. f_s is the rate of "
        "stick and slip, the strongest line of ψ; f_Ω = Ω/2π. What a line is, is found among n f_s + m f_Ω."
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
}


def cell(value: object) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:g}"
    return str(value)


@script
def main(name: str, csv: str, md: str, html: str, path: str) -> None:
    (tree,) = load_inputs([Path(path)])
    case, note = CaseView(Path(path).stem, tree), NOTES[name]
    if name == "table1":
        table = table_1(case.parameters)
    else:
        table, missing = table_2_or_why(case)
        table, note = table.round(3), missing or note
    table.to_csv(csv, index=False)
    table.columns = [NAMES[str(column)] for column in table.columns]
    rows = ([cell(x) for x in row] for row in table.itertuples(index=False))
    lines = [f"# {TITLES[name]}", "", note, "", *markdown_table(table.columns, rows)]
    Path(md).write_text("\n".join(lines) + "\n", encoding="utf-8")
    Path(html).write_text(table_page(TITLES[name], note, table), encoding="utf-8")
