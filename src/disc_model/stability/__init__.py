"""Where motions are stable: cycles and their multipliers, steady sliding, bifurcations, Lyapunov exponents.

From the bottom up: `return_map` takes a state from one release of stick to the next, with its derivative;
`floquet` finds a cycle and its multipliers; `continuation` follows cycles, their folds and neutral points; `curves`
does so over a range of a parameter. `settling` decides when a simulated motion may be left.
"""
