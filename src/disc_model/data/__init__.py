"""Results on disc: names and units, datasets, whole files, where they come from."""
