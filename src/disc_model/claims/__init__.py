"""The paper's claims, as data and checks, against what was computed.

Each claim states in our own words what the paper says, where, and what would count as agreement and why; its
check computes everything it reports from the merged cases or from the disc's modes. `ledger.check_claims`
makes the table.
"""
