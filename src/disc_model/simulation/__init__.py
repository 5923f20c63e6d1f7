"""Simulation of one case: the request, the input of the engine, and the recorded result."""
