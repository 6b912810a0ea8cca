"""A guard that lets nothing outlive the program that it runs; a script without imports of ours.

    python guard.py SOCKET SECONDS PROGRAM ARGUMENTS …

It ends when the program ends, with the same status, or when the other end of the socket is closed,
as it is when the process that has started the guard ends. Before that it ends all processes that
the program has started. On Linux a process whose parent has ended becomes the guard's child,
however it was started, so that none escapes.
"""

import contextlib
import ctypes
import os
import resource
import select
import signal
import socket
import sys
from pathlib import Path

_BECOME_PARENT_OF_ORPHANS = 36  # PR_SET_CHILD_SUBREAPER


def main() -> None:
    """Run until the program or the socket ends."""
    control, seconds = socket.socket(fileno=int(sys.argv[1])), int(sys.argv[2])
    control.set_inheritable(False)
    socket_end = control.fileno()
    wakeup, wakes = os.pipe()
    os.set_blocking(wakes, False)
    # A signal writes a byte into this pipe, which wakes `select`: otherwise a child that ends
    # between two calls of it would be missed.
    signal.set_wakeup_fd(wakes)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    # Limits that the program inherits: it ends even if the guard is killed, and a crash writes no
    # file of its memory.
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_BECOME_PARENT_OF_ORPHANS, 1, 0, 0, 0)
    program_pid, status = _start_program(sys.argv[3:], control), None
    while status is None and socket_end not in select.select([socket_end, wakeup], [], [])[0]:
        os.read(wakeup, 512)
        status = _reap(program_pid)
    _end_all(program_pid)
    code = os.waitstatus_to_exitcode(status or 0)
    if code < 0:  # the program was ended by a signal: the guard ends by the same one
        with contextlib.suppress(OSError):
            signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    os._exit(code)


def _start_program(words: list[str], control: socket.socket) -> int:
    """Start the program in a process group of its own; report a failure through the socket."""
    # Python ignores these signals, and the program would inherit that.
    ignored = [signal.SIGPIPE, signal.SIGXFSZ]
    try:
        program_pid = os.posix_spawnp(words[0], words, os.environ, setpgroup=0, setsigdef=ignored)
    except (OSError, ValueError) as error:
        control.send((getattr(error, "strerror", None) or str(error)).encode())
        sys.exit(1)
    null = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):  # the pipes belong to the program alone
        os.dup2(null, stream)
    control.send(b"\n")
    return program_pid


def _reap(program_pid: int) -> int | None:
    """Collect all children that have ended; return the program's status, None while it runs."""
    status = None
    with contextlib.suppress(ChildProcessError):
        while (child := os.waitpid(-1, os.WNOHANG))[0]:
            status = child[1] if child[0] == program_pid else status
    return status


def _end_all(program_pid: int) -> None:
    """End all children, until none is left: the children of an ended one become the guard's."""
    with contextlib.suppress(OSError):
        os.killpg(program_pid, signal.SIGKILL)
    children = Path(f"/proc/self/task/{os.getpid()}/children")
    while children.exists() and (remaining := children.read_text().split()):
        for child in remaining:
            os.kill(int(child), signal.SIGKILL)
        os.waitpid(-1, 0)


if __name__ == "__main__":
    main()
