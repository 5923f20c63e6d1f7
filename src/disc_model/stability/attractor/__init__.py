"""The outcome of a motion, by the same criteria for maps, basins, diagrams and ramps."""
