"""The event-driven engine: kernels on floats and arrays only."""

from . import event_loop  # and with it all that is compiled

__all__ = ["event_loop"]
