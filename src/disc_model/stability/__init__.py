"""Where motions are stable: cycles and their multipliers, steady sliding, bifurcations, Lyapunov exponents.

From the bottom up: `return_map` takes a state from one release of stick to the next, with its derivative, and finds
fixed points and their multipliers; `cycle` finds that of a case; `continuation` follows it in one parameter, through
folds, and the borders of its stability in two; `curves` finds all of those in a range, and `resonances` says what they
are.  `attractor` says what a motion comes to.
"""
