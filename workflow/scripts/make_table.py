"""Make Table 1 or 2 of the paper with our values beside its own: as CSV, as Markdown and as a page."""

from pathlib import Path

from disc_model.data.dataset import load_cases
from disc_model.data.texts import write_page
from disc_model.errors import script
from disc_model.paper.measures import CaseView
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


@script
def main(name: str, csv: str, md: str, html: str, path: str) -> None:
    ((case_name, tree),) = load_cases([Path(path)]).items()
    case, note = CaseView(case_name, tree), NOTES[name]
    if name == "table1":
        table = table_1(case.parameters)
    else:
        table, missing = table_2_or_why(case)
        table, note = table.round(3), missing or note
    table.to_csv(csv, index=False)
    for file in (md, html):
        write_page(file, TITLES[name], ("", note, table.rename(columns=NAMES)))
