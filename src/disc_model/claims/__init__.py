"""The paper's claims, as data and checks, against what was computed.

Each claim states in our own words what the paper says, where, and what would count as agreement and why; its
check computes everything it reports from the merged cases or from the disc's modes. `check_claims` makes the
table.
"""

from disc_model.claims.ledger import COLUMNS, check_claims
from disc_model.claims.pages import to_markdown

__all__ = ["COLUMNS", "check_claims", "to_markdown"]
