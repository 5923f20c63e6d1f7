"""What a grid study can compute at each of its points.

A quantity is a module with

- ``OPTIONS``: the schema of its options, from a module beside it that imports nothing heavy;
- ``TABLE``: its variables by name, each a `disc_model.studies.grids.quantities.table.Column`, ``status`` among them;
- ``coordinates(options)``: values of its own dimensions, beyond those of the grid;
- ``compute(points, options)``: a `Table` of arrays (see `table.py` here), one row for each of the parameters.

To add one, write it and name it in `disc_model.studies.grids.quantities.registry`.
"""
