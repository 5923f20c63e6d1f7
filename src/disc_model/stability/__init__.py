"""Where motions are stable: cycles and their multipliers, steady sliding, bifurcations, Lyapunov exponents.

From the bottom up: `return_map` takes a state from one release of stick to the next, with its derivative; `floquet`
finds a cycle and its multipliers; `continuation` follows it in one parameter, through folds, and `neutral` the borders
of stability in two; `curves` finds all of those in a range, and `resonances` says what they are.  `settling` decides
when a simulated motion may be left.
"""
