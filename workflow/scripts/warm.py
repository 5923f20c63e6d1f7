"""Runs the scripts of jobs as copies of a process that has imported what they need: a second less
for each.

``warm.py SOCKET`` is that process, which ends with its standard input: with Snakemake, however that
ends. ``warm.py SOCKET SCRIPT ARGUMENT...`` has a copy of it run a script, or runs the script itself
where there is none.
"""

import contextlib
import json
import os
import signal
import socket
import sys

ALONE = {"measure.py"}
"""Scripts that are timed, or whose environment must be set before their imports."""
LONGEST_START = 30
"""Time for which jobs wait for the process that runs them, s."""
STARTED = "started"
"""File beside the socket with the number of this process, from its start on."""


def serve(address):
    """Run scripts for those who connect; each in a copy of this process, with their files, folder
    and environment."""
    import select

    steps = prepare()
    next(steps)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the copies, and for Snakemake
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for them
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(address)
        listener.listen(64)
        wait = 0
        while 0 not in (
            ready := select.select([0, listener], [], [], wait)[0]
        ):  # its standard input has not ended
            if not ready:
                wait = next(steps, None)
                continue
            connection = listener.accept()[0]
            if os.fork() == 0:
                listener.close()
                run(connection)
            connection.close()


def prepare():
    """Import what all jobs need; then, a step at a time, what many load by themselves, and draw an
    empty picture."""
    from importlib import import_module
    from io import BytesIO

    # the first of those that import numba sets the cache's folder
    for name in ("simulation.api", "studies.run", "data.texts", "figures.schema"):
        import_module(f"disc_model.{name}")
    yield 0
    # numba reads its tables of types when it first compiles or loads something, for 0.4 s
    import_module("numba").njit(lambda x: x)(0)
    yield 0
    sources = import_module("disc_model.sources")
    sources.source_hash(*sources.BATCHES)  # which every batch states
    yield 0
    backends = [f"matplotlib.backends.backend_{form}" for form in ("agg", "pdf")]
    drawings = "disc_model.figures.kinds"
    for name in ("scipy.special", "scipy.signal", "pint", "cmcrameri.cm", *backends, drawings):
        import_module(name)
        yield 0
    from disc_model.figures.draw import panels, styled

    for form in ("png", "pdf"):
        with styled():
            panels([["a"]])[0].savefig(BytesIO(), format=form)
        yield 0


def run(connection):
    """Run the script that a connection asks for, answer with its exit code, and end this
    process."""
    import atexit
    import runpy
    import traceback

    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    files = socket.recv_fds(connection, 1, 3)[1]
    for number, file in enumerate(files):
        os.dup2(file, number)
        os.close(file)
    with connection.makefile() as request:
        sys.argv, folder, environment = json.load(request)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    code = 1
    try:
        runpy.run_path(sys.argv[0], run_name="__main__")
        code = 0
    except SystemExit as ending:
        code = ending.code if isinstance(ending.code, int) else int(ending.code is not None)
        if isinstance(ending.code, str):
            print(ending.code, file=sys.stderr)
    except BaseException:
        traceback.print_exc()
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    with contextlib.suppress(OSError):  # Ctrl-C has ended who asked
        connection.sendall(b"%d" % code)
    os._exit(code)  # taking all modules down would take a quarter of a second


def wait_for(address):
    """Wait until the process that runs scripts is ready, if it has been started: on few cores, jobs
    that import by themselves would hold it up, and each other."""
    import time

    try:
        with open(os.path.join(os.path.dirname(address), STARTED), encoding="ascii") as file:
            program = f"/proc/{int(file.read())}/exe"
    except (OSError, ValueError):
        return
    ends = time.monotonic() + LONGEST_START
    while os.path.exists(program) and not os.path.exists(address) and time.monotonic() < ends:
        time.sleep(0.02)


def ask(address, arguments):
    """Have a script run, and return its exit code."""
    with socket.socket(socket.AF_UNIX) as connection:
        try:
            if os.path.basename(arguments[0]) in ALONE:
                raise OSError
            wait_for(address)
            connection.connect(address)
        except OSError:  # not ready yet, or not on this machine
            os.execv(sys.executable, [sys.executable, *arguments])
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        socket.send_fds(connection, [b"0"], [0, 1, 2])
        connection.sendall(json.dumps([arguments, os.getcwd(), dict(os.environ)]).encode())
        connection.shutdown(socket.SHUT_WR)
        with connection.makefile() as answer:
            code = answer.read()
        return int(code) if code else "killed, perhaps for want of memory"  # which sys.exit writes


if __name__ == "__main__":
    SOCKET, *ARGUMENTS = sys.argv[1:]
    if ARGUMENTS:
        sys.exit(ask(SOCKET, ARGUMENTS))
    serve(SOCKET)
