"""Benchmark of other methods: speed against accuracy and failures, on common scenes with stored
references."""
