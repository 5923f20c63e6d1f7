"""Quantities that a grid study can compute at each point, one module each; see
`disc_model.studies.quantity`."""
