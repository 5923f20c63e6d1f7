"""What each answer costs: error against wall time of numbers that a study asks for.

`questions` says what is asked and when an answer is right, `simulated` how a method that integrates finds it,
`modelled` how this package finds it with other modes, `measure` measures, and `words` puts the outcome into words.
"""
