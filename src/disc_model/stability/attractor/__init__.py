"""The outcome of a motion, by the same criteria for maps, basins, diagrams and ramps.

Each `disc_model.data.variables.Outcome` is decided by one test: nearness to a stable cycle, or to steady sliding, by
multipliers (`linear_motion`); stick for good (`outcome.find_calm`); growth (`outcome.growing`); the largest exponent of
a settled motion (`arrival.regularity`). Claims and benchmarks, which know the times of events alone, use
`disc_model.analysis.classify`.

`outcome` follows one motion to a horizon, `arrival` says what a motion has come to, and `basins` compares many motions.
"""
