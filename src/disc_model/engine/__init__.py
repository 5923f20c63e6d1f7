"""The event-driven engine: kernels on floats and arrays only."""

from . import event_loop, variational  # and with them all that is compiled
from .cache import source_hash

__all__ = ["event_loop", "source_hash", "variational"]
