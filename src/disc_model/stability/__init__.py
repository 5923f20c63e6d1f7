"""Stability of motions: limit cycles and their multipliers, steady sliding, Lyapunov exponents.

`return_map` maps a state from one release of stick to the next, with the derivative, and finds fixed points and their
multipliers. `cycle` finds the stick-slip cycle of a case. `continuation` follows the cycle in one parameter, through
folds, and its stability borders in two parameters. `curves` finds all such borders in a range, and `resonances`
assigns resonances to them. `attractor` identifies the attractor to which a motion converges.
"""
