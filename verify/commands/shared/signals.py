"""Interruption and termination as the command hears them: always, and as exceptions.

Python raises what a signal's handler raises wherever the program happens to be. Where that is a
callback of the garbage collector (hypothesis has one), a finaliser or a callback from C, Python
prints it and goes on: the signal would be lost. Such a one is sent again.
"""

import contextlib
import signal
import sys
import threading
from collections.abc import Iterator

TERMINATED = 143
_AGAIN_AFTER = 0.01  # seconds: by then the callback is left


@contextlib.contextmanager
def heard_signals() -> Iterator[None]:
    """SIGTERM is SystemExit with status 143, and no such exit, nor KeyboardInterrupt, is lost."""
    with contextlib.suppress(ValueError):  # not in the main thread, which alone is signalled
        signal.signal(signal.SIGTERM, _terminated)
    before, here = sys.unraisablehook, threading.get_ident()

    def hear(ignored: "sys.UnraisableHookArgs") -> None:
        number = _signal(ignored.exc_value)
        if number is None:
            before(ignored)
        else:
            again = threading.Timer(_AGAIN_AFTER, signal.pthread_kill, (here, number))
            again.daemon = True
            again.start()

    sys.unraisablehook = hear
    try:
        yield
    finally:
        sys.unraisablehook = before


def _terminated(*_: object) -> None:
    """As an interruption: worker processes are ended, and what is finished is kept."""
    sys.exit(TERMINATED)


def _signal(error: BaseException | None) -> signal.Signals | None:
    if isinstance(error, KeyboardInterrupt):
        return signal.SIGINT
    if isinstance(error, SystemExit) and error.code == TERMINATED:
        return signal.SIGTERM
    return None
