"""The disc: its modes, by plate theory or from a table, its flexibility, and how many modes a case
needs."""
