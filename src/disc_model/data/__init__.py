"""Results on disk: names and units of variables, datasets, atomic writing of files, and their
provenance."""
