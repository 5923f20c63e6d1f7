"""The event-driven engine: kernels on floats and arrays only."""
