"""What a grid study can compute at each of its points.

A quantity is a module here with

- ``COLUMNS``: its variables by name, each a `Column` of `disc_model.studies.grids.run`, ``status`` among them;
- ``coordinates(options)``: values of its own dimensions, beyond those of the grid, if it has any;
- ``at(p, options)``: what there is to say of one point, by column, and a message.

To add one, write it and name it in `schema`, with its options; `run.compute` does the rest.
"""
