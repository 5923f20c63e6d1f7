"""What is drawn and found at samples of distributed parameters, in words.

The quantity `sensitivity` writes them and its summary reads them, which is done without what simulates.
"""

from __future__ import annotations

from disc_model.data.variables import COURSES

STABLE = ("stable", "slides", "sticks")
UNSTABLE = ("unstable", "no_cycle", "separates", "slips")
CYCLES = ("failed", *STABLE, *UNSTABLE)
"""What there is near the published start: a stable cycle, stable steady sliding, or rest on the disc; or an unstable
cycle, none though the slider sticks and slips, loss of contact at once, or unstable sliding."""
OUTCOMES = ("not_followed", *COURSES)
DRAWS = ("A", "B")
