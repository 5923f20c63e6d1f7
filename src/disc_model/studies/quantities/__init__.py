"""Quantities that a grid study can compute at each point, one module each: its options, variables, computation and
summary; see `disc_model.studies.quantity`.
"""
