"""Cost of each answer: error against wall time of quantities that a study computes.

`questions` defines the questions and their tolerances, and `simulated` derives answers from a method that integrates.
`modelled` derives answers of this package with other modes, and `measure` measures.
"""
