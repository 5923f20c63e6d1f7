"""Probabilities of instability and separation among the samples, and the parameters that decide them.

Fractions of the cycles refer to all draws, A and B, and fractions of the outcomes to the simulated ones. The Wilson
intervals assume independent samples. Quasi-random samples are more even, so that their errors are mostly smaller. A
failed sample is neither stable nor unstable: the lower and upper ends of an interval count it as one and as the other.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.analysis.sobol import Indices, share, sobol_intervals
from disc_model.data.variables import EXCLUDED, Variable, flag_names
from disc_model.studies.document import SensitivityOptions
from disc_model.studies.grids.points import DRAWS, SAMPLE_CYCLES, SAMPLE_OUTCOMES, UNSTABLE, Coordinate, with_ends

Array = NDArray[np.float64]

FAILED = "failed"
FOLLOWED = tuple(word for word in SAMPLE_OUTCOMES if word not in ("not_simulated", FAILED))
KNOWN = tuple(word for word in SAMPLE_CYCLES if word != FAILED)
OUTPUTS = ("instability", "growth_rate")
"""Outputs with Sobol indices: absence of a stable motion (1, else 0), and the cycle's growth rate, capped."""
_INDEX = ("output", "parameter")


def _with_interval(name: str, words: str, dims: tuple[str, ...] = ()) -> dict[str, Variable]:
    ends = ("", ", lower end", ", upper end")
    return with_ends(name, (Variable("1", f"{words}{end}", dims=dims) for end in ends))


COLUMNS: Mapping[str, Variable] = {
    "n_known_cycles": Variable("1", "number of draws, A and B, whose cycle is known", whole=True),
    "n_known_outcomes": Variable("1", "number of draws whose outcome is known", whole=True),
    **_with_interval("probability_unstable", "probability that the static start is near no stable motion"),
    **_with_interval("probability_separation", "probability of separation within the horizon"),
    **_with_interval("cycle_fraction", "share of the draws near whose static start there is this", ("cycle_class",)),
    **_with_interval("outcome_fraction", "share of the followed draws that have this outcome", ("outcome_class",)),
    **_with_interval("sobol_first", "first-order Sobol index", _INDEX),
    **_with_interval("sobol_total", "total Sobol index", _INDEX),
    "excluded_fraction": Variable(
        "1", "share of samples that the indices leave out: an output is missing", dims=("output",)
    ),
}
COORDINATES = {
    "cycle_class": Coordinate("", "class of the cycle near the static start", lambda o: KNOWN),
    "outcome_class": Coordinate("", "what becomes of the static start", lambda o: FOLLOWED),
    "output": Coordinate("", "of what the indices are", lambda o: OUTPUTS),
    "parameter": Coordinate("", "distributed parameter", lambda o: sorted(o.distributions)),
}


def summarise(cell: xr.Dataset, options: SensitivityOptions) -> dict[str, Any]:
    """Summarise over the samples that no rule of the grid leaves out."""
    cell = cell.isel(sample=flag_names(cell["status"]) != EXCLUDED)
    if not cell.sizes["sample"]:
        return {}
    words = flag_names(cell["cycle"].transpose("sample", "variant"))
    drawn = words[:, : len(DRAWS)].ravel()
    outcomes = flag_names(cell["outcome"])
    outcomes = outcomes[outcomes != "not_simulated"]
    values: dict[str, Any] = {
        "n_known_cycles": np.count_nonzero(drawn != FAILED),
        "n_known_outcomes": np.count_nonzero(outcomes != FAILED),
    }
    values |= _shares("cycle_fraction", drawn, [(word,) for word in KNOWN])
    values |= _shares("outcome_fraction", outcomes, [(word,) for word in FOLLOWED])
    values |= _shares("probability_unstable", drawn, [UNSTABLE])
    values |= _shares("probability_separation", outcomes, [("separation",)])
    # of the indices: (samples, variants), nan where not known
    unstable = np.where(words == FAILED, np.nan, np.isin(words, UNSTABLE))
    growth_rate = cell["growth_rate"].transpose("sample", "variant").values
    outputs = unstable, np.minimum(growth_rate, options.growth_rate_cap)
    found = [sobol_intervals(output, options.seed) for output in outputs]
    for name in Indices._fields:
        values[f"sobol_{name}"] = np.array([getattr(one, name) for one in found])
    values["excluded_fraction"] = np.array([np.mean(~np.isfinite(output).all(axis=1)) for output in outputs])
    return values


def _shares(name: str, words: NDArray[np.str_], classes: list[tuple[str, ...]]) -> dict[str, Any]:
    """Fraction of each class of words among those that are known, with its interval."""
    known = words[words != FAILED]
    found = np.array([share(int(np.isin(known, one).sum()), len(known), len(words) - len(known)) for one in classes])
    return with_ends(name, found[0] if len(classes) == 1 else found.T)
