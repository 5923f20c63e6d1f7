"""How an event, a run of the machine or a flight of the return map ends: one numbering for all."""

from __future__ import annotations

# The motion goes on: after an event; after a pause because a buffer is full; after a stop that was asked for.
CONSISTENT, PAUSED, STOPPED = 0, 1, 2
# The time is up; the section is reached.
TIME_OVER, RETURNED = 3, 4
# It cannot go on: Painleve's paradox, events without the clock moving, numbers that overflow.
NO_SOLUTION, STALLED, NON_FINITE = 5, 6, 7
# It was not to go on: too many steps; contact lost in a flight that must keep it; a point that is not on the section.
STEP_LIMIT, LOST_CONTACT, OFF_SECTION = 8, 9, 10
