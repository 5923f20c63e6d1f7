"""The outcome of a motion, by the same criteria for maps, basins, diagrams and ramps.

`outcome` follows one motion to a horizon, `arrival` says what a motion has come to, and `basins` compares many motions.
Claims and benchmarks, which know the times of events alone, use `disc_model.analysis.classify`.
"""
