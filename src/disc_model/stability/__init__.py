"""Stability of motions: limit cycles and their multipliers, steady sliding, Lyapunov exponents,
outcomes."""
