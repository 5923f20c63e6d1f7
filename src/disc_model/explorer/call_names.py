"""Names of numbers that calls of a point state, which the page writes."""

from typing import Any

from disc_model.parameters import RATIOS, Parameters

MEASURES = ("a", "b", "h", "E", "nu", "rho")
"""Numbers of the plate by which it is another than the paper's."""
STATED_WITH_MEASURES = ("normalization", "D_star", "damping_ratio")
"""What a case of another plate has to state."""


def names_of_calls() -> dict[str, Any]:
    """Numbers of a case; those by which its plate is another than the paper's, ratios among them; and what a
    call states beside these."""
    ratios = [ratio for ratio, (replaced, _) in RATIOS.items() if replaced in MEASURES]
    return {
        "parameters": [*Parameters.model_fields, *RATIOS],
        "plate": {"measures": [*MEASURES, *ratios], "stated": STATED_WITH_MEASURES},
    }
