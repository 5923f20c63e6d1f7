"""What a grid study can compute at each of its points: a quantity is a module here, see `Quantity` of `grids.run`."""
