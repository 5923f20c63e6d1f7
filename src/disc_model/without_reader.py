"""What a command does when nobody reads on, such as `head`, which ends after some lines."""

import signal


def end_without_reader() -> None:
    """Have this process end quietly at what nobody reads, as other commands do."""
    if hasattr(signal, "SIGPIPE"):  # not on Windows
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)


def go_on_without_reader() -> None:
    """Have this process go on: the end of its work does not depend on who reads of it."""
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)
