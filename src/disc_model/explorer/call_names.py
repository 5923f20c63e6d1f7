"""Names of numbers that calls of a point state, which the page writes."""

from typing import Any

from disc_model.disc.plausibility import MEASURES, STATED_WITH_MEASURES
from disc_model.parameters import RATIOS, Parameters


def names_of_calls() -> dict[str, Any]:
    """Numbers of a case; those by which its plate is another than the paper's, ratios among them; and what a
    call states beside these."""
    ratios = [ratio for ratio, (replaced, _) in RATIOS.items() if replaced in MEASURES]
    return {
        "parameters": [*Parameters.model_fields, *RATIOS],
        "plate": {"measures": [*MEASURES, *ratios], "stated": STATED_WITH_MEASURES},
    }
