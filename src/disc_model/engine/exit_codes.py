"""Exit codes of events, of runs of the event loop, and of integrations of the return map: one numbering for all."""

# The motion continues: after an event; after a pause because a buffer is full; after a requested stop, at the first
# loss of contact.
CONSISTENT, PAUSED, STOPPED = 0, 1, 2
# The end time is reached; the section is reached.
TIME_OVER, RETURNED = 3, 4
# It cannot continue: Painleve's paradox, events without the clock advancing, overflow.
NO_SOLUTION, STALLED, NON_FINITE = 5, 6, 7
# It was stopped: too many steps; a point that is not on the section.
STEP_LIMIT, OFF_SECTION = 8, 9
