"""The outcome of a motion, by the same criteria for maps, basins, diagrams and ramps.

The outcomes are those of `disc_model.data.variables.Outcome`. One test decides each of them:

- `quiet`, `other_cycle`, `separating`: the motion is near a stable cycle of the return map, and approaches it over
  seconds at the rates of the cycle's multipliers (`linear_motion.find_cycle_near`). It is separating if the cycle loses
  contact. It is quiet if the cycle is that of the static start, or within a tenth of the static deflection of it.
- `steady_sliding`: the slider slips near a stable equilibrium, and the motion approaches it at the rates of the
  eigenvalues (`linear_motion.approaches_sliding`).
- `at_rest`: the slider sticks for a whole segment, and no force can release it (`outcome.find_calm`).
- `quasi_periodic`, `irregular`: the motion has settled (`basins.Basins`), and no stable cycle is near. Its
  largest nontrivial Lyapunov exponent is zero, or positive (`arrival.regularity`).
- `growing`: the motion is in contact at the horizon and departs from an unstable cycle, or its changes from one period
  to the next have risen (`outcome.growing`). Its simulation ends once the record shows that it has settled in contact
  (`disc_model.analysis.classify`). `separation`: contact is lost before the horizon.
- `undecided`: none of these.

Claims and benchmarks know the times of events alone: `disc_model.analysis.classify` finds their period, and tells
quasi-periodic from irregular intervals by the 0-1 test.

`outcome` follows one motion to a horizon. `arrival` says what a motion has come to, and sweeps through a parameter.
`basins` compares many motions of a case with known attractors. The limits that decide are in `thresholds`; those of
records alone, `CLOSES`, `NEAR_RETURN` and `VARIATION`, are in `disc_model.analysis.classify`.
"""
