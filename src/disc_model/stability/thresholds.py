"""All thresholds of the search for the outcome of a motion, with their reasons.

Distances and changes are on the section of the return map, relative to the norm of the static
deflection.
"""

# ---- Simulated legs

FIRST_LEG = 5.0  # s, before a motion is examined: dozens of cycles, and some turns of the disc at paper speeds
LONGEST_LEG = 160.0  # s, of later legs: the tests after each cost little beside so much simulation
SAMPLING_RATE = 4000.0  # Hz, of described segments: above twice the highest modal frequency

# ---- Linear motion near a cycle, or near steady sliding

NEAR = 0.1  # distance from a cycle within which a motion counts as near it: none is linear beyond
SAME_POINT = (
    1e-4  # nearer fixed points are the same: known cycles differ by 0.1, and residuals are 1e-10
)
ARRIVED = (
    1e-8  # a motion as near to a stable cycle is on it: the limit is 10,000 times the rounding
)
# errors of a long simulation, over its tolerance, in weakly damped modes: 12 were seen in the
# paper's, 7,000 in modes of 2 kHz that decay at 0.4/s
ERROR_OF_TOL = 10_000
# s, at which a motion is compared with the linear one; if the first test fails, the longer one
# resolves slower rates
TEST_TIMES = ((0.3, 1.2), (1.5, 6.0))
TEST_TOL = (
    1e-13  # of simulations in these tests, whose errors must be below `ARRIVED`: see `ERROR_OF_TOL`
)
WAITS = (
    0.0,
    1.5,
    6.0,
    15.0,
)  # s, at which tests begin: near a resonance the strongly damped modes must decay first
LARGEST_ERROR = (
    0.1  # of the linear motion, relative to it: second order in the distance, at most a tenth
)
LARGEST_RATE_ERROR = (
    0.5  # of the growth rate, relative to the linear motion's: it decides the sign of the rate
)
# largest share of a departure outside the leading eigenspace, and largest relative difference of
# its growth rate from the multiplier's
LARGEST_OUTSIDE = 0.25
# growth rate, 1/s, up to which a departure is extrapolated: faster ones take little time
SLOW_DEPARTURE = 0.2
# shares of `NEAR` up to which it is, as long as its growth rate differs from the multiplier's by no
# more than this, relative
DEPARTURES = (0.1, 0.25, 0.5, 1.0)
LARGEST_EXCESS = 0.05
# difference of a separation from a time with which it is compared, relative, up to which it is
# simulated from the start: 98 of 100 extrapolated separations come within it, and most of the
# others are of motions that nearly lose contact before, which another tolerance shifts as far
BORDER = 0.01
LINGERS = 1e-3  # largest change over a period of a motion that stays near an unstable cycle: on a torus it would move
LARGEST_PERIOD = (
    8  # releases in a period of cycles that are sought from the section alone, to limit the time
)
RISE = 1.5  # factor between changes of periods that shows growth: rounding and beats with decaying modes cause less

# ---- Attractors of many motions of a case

NEARING, SETTLING = (
    4,
    8,
)  # legs over which a motion approaches a known attractor, and is steady on another one
STEADY = 1e-3  # largest relative change of the range over these without a drift: a periodic one's is a tenth of it
# largest relative change of ranges, rates and shares over 40 s of a settled motion: aperiodic ones
# vary by half of it
VARIATION = 0.01
# s over which intervals of a motion that never sticks must repeat to `CLOSES`: at 100 Hz that shows
# rates of `SLOWEST`, as a record of 200 s does that is known to 1 %
REPETITION = 40.0
SAME = 0.05  # segments that differ by less are of one attractor; the extrapolated rest of a drift may reach half of it
SMALLEST = 1e-3  # range, over the static deflection, below which ranges count as equal: the slider's height is constant
OWN_STARTS = (
    0.0,
    0.25,
    0.5,
    1.0,
    2.0,
)  # downward, over the static deflection, from which attractors are sought
