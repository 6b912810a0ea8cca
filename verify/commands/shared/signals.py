"""Interruption and termination as the command hears them: always, and as exceptions.

Python raises what a signal's handler raises wherever the program happens to be. Where that is a
callback of the garbage collector (hypothesis has one), a finaliser or a callback from C, Python
prints it and goes on: the signal would be lost, and is sent again. Where it is the import of a
library in C, that may become an ImportError, or nothing at all (gmpy2 runs some Python as it is
imported, and clears what that raises): while something is imported the signal waits, though not
for long, and whatever ends the command after a signal is that signal.
"""

import contextlib
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from types import FrameType

TERMINATED = 143
_AGAIN_AFTER = 0.01  # seconds: by then the callback is left
_MOST_WAITS = 200  # of them: a user's module may do as it is imported what does not end
_IMPORTING = "<frozen importlib._bootstrap>"  # the file of frames under which an import runs


@contextlib.contextmanager
def heard_signals() -> Iterator[None]:
    """SIGINT is KeyboardInterrupt and SIGTERM SystemExit with status 143, and neither is lost."""
    heard: list[int] = []

    def hear(number: int, frame: FrameType | None) -> None:
        heard.append(number)
        if len(heard) <= _MOST_WAITS and _imports(frame):
            _send_again(number)
        elif number == signal.SIGINT:
            signal.default_int_handler(number, frame)
        else:
            sys.exit(TERMINATED)

    with _handlers(dict.fromkeys((signal.SIGINT, signal.SIGTERM), hear)), _sent_again():
        try:
            yield
        except Exception as error:
            if not heard:
                raise
            ended = KeyboardInterrupt() if heard[-1] == signal.SIGINT else SystemExit(TERMINATED)
            raise ended from error


@contextlib.contextmanager
def _handlers(chosen: Mapping[signal.Signals, Callable[..., None]]) -> Iterator[None]:
    """Those handlers, for a while; no others where this is not the thread that is signalled."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, handler) for number, handler in chosen.items()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def _sent_again() -> Iterator[None]:
    """A signal whose exception Python prints and forgets comes a second time."""
    before = sys.unraisablehook

    def hear(ignored: "sys.UnraisableHookArgs") -> None:
        number = _signal(ignored.exc_value)
        if number is None:
            before(ignored)
        else:
            _send_again(number)

    sys.unraisablehook = hear
    try:
        yield
    finally:
        sys.unraisablehook = before


def _send_again(number: int) -> None:
    main = threading.main_thread().ident
    again = threading.Timer(_AGAIN_AFTER, signal.pthread_kill, (main, number))
    again.daemon = True
    again.start()


def _imports(frame: FrameType | None) -> bool:
    """Whether this is done while something is imported."""
    while frame is not None and frame.f_code.co_filename != _IMPORTING:
        frame = frame.f_back
    return frame is not None


def _signal(error: BaseException | None) -> signal.Signals | None:
    if isinstance(error, KeyboardInterrupt):
        return signal.SIGINT
    if isinstance(error, SystemExit) and error.code == TERMINATED:
        return signal.SIGTERM
    return None
