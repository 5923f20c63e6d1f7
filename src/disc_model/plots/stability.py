"""Pictures of stability: branches, multipliers, eigenvalues, exponents, curves, modes, and Campbell
diagrams."""
