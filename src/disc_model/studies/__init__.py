"""Studies: which results are computed, in which batches, and how the files of the batches are
merged."""
