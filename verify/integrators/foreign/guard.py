"""A guard that lets nothing outlive the program that it runs: a program of its own, without us.

    python guard.py SOCKET SECONDS PROGRAM ARGUMENTS …

It ends as the program does, or when the other end of the socket is closed, as it is where we end
ourselves; before that it ends all that is left. On Linux a process whose parent has ended becomes
the guard's child, however it was started, so that none escapes.
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
    ending = control.fileno()
    wakeup, wakes = os.pipe()
    os.set_blocking(wakes, False)
    # A signal writes a byte into this pipe, which wakes `select`: else a child that ends between
    # two looks would be missed.
    signal.set_wakeup_fd(wakes)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    # Should we be ended, it is too, at last; and there is no file of its memory where it crashes.
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_BECOME_PARENT_OF_ORPHANS, 1, 0, 0, 0)
    first, status = _start(sys.argv[3:], control), None
    while status is None and ending not in select.select([ending, wakeup], [], [])[0]:
        os.read(wakeup, 512)
        status = _reap(first)
    _end_all(first)
    code = os.waitstatus_to_exitcode(status or 0)
    if code < 0:  # as the program: by the same signal
        with contextlib.suppress(OSError):
            signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    os._exit(code)


def _start(words: list[str], control: socket.socket) -> int:
    """Start the program in a process group of its own; report a failure through the socket."""
    ignored = [signal.SIGPIPE, signal.SIGXFSZ]  # by Python, and by what it starts
    try:
        first = os.posix_spawnp(words[0], words, os.environ, setpgroup=0, setsigdef=ignored)
    except (OSError, ValueError) as error:
        control.send((getattr(error, "strerror", None) or str(error)).encode())
        sys.exit(1)
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):  # the pipes are the program's alone
        os.dup2(nothing, stream)
    control.send(b"\n")
    return first


def _reap(first: int) -> int | None:
    """Return the first process's exit status, None while it runs; collect all others that have
    ended."""
    status = None
    with contextlib.suppress(ChildProcessError):
        while (child := os.waitpid(-1, os.WNOHANG))[0]:
            status = child[1] if child[0] == first else status
    return status


def _end_all(first: int) -> None:
    """End all children; children of what is ended become ours, so repeat until there is none."""
    with contextlib.suppress(OSError):
        os.killpg(first, signal.SIGKILL)
    children = Path(f"/proc/self/task/{os.getpid()}/children")
    while children.exists() and (remaining := children.read_text().split()):
        for child in remaining:
            os.kill(int(child), signal.SIGKILL)
        os.waitpid(-1, 0)


if __name__ == "__main__":
    main()
