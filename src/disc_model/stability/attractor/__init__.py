"""What a motion comes to: one answer for maps, basins, diagrams, ramps, claims and benchmarks.

The words are those of `disc_model.data.variables.Outcome`. Each is decided by one test:

- `quiet`, `other_cycle`, `separating`: the motion is near a stable cycle of the return map, and approaches it over
  seconds at the rates of the cycle's multipliers (`neighbourhood.cycle_near`). It is separating if the cycle loses
  contact; quiet if the cycle is that of the static start, or within a tenth of the static deflection of that start.
- `steady_sliding`: it slides near a stable equilibrium, and approaches it at the rates of the eigenvalues there
  (`neighbourhood.nears_sliding`).
- `at_rest`: it has stuck for a whole segment, and no force can release the slider (`outcome.at_rest`).
- `quasi_periodic`, `irregular`: it has settled (`classification.Basins`), is near no stable cycle, and its largest
  nontrivial Lyapunov exponent is zero, or positive (`classification.regularity`).
- `growing`: it is in contact at the horizon and departs from an unstable cycle, or changes from one period to the next
  have risen (`outcome.growing`). `separation`: contact is lost before the horizon.
- `undecided`: none of these.

`course` follows one motion to a horizon, `many` compares many of one case with the attractors that are known.
"""
