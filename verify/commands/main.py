"""The command `verify`: its streams, its signals, its exit statuses.

Heavy libraries are imported inside the command that needs them. Standard output and standard error
receive no control characters, and no character that their encoding lacks.

SIGINT and SIGTERM become exceptions. Python raises them wherever the program happens to be, and at
some points they would be lost:

- In a callback of the garbage collector (hypothesis has one), in a finaliser and in a callback from
  C, Python prints the exception and continues. The signal is then sent again, as often as it comes
  while this is being done.
- During an import a library in C may turn the exception into an ImportError, or clear it (gmpy2
  runs some Python code during its import, and clears what that code raises). A signal that arrives
  during an import is therefore sent again a little later, for about two seconds at most; after that
  it is raised during the import.
- If another exception ends the command after a signal, the signal's exception replaces it. The
  signal is still lost if a library clears its exception after those two seconds.
"""

import _thread
import contextlib
import errno
import io
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import FrameType
from typing import TextIO, cast

import click

from verify.arithmetic.compiled import paths
from verify.commands import Commands
from verify.commands.shared.command_group import CommandGroup
from verify.errors import CONTROL_CHARACTERS, InputError, PlaceError

TERMINATED = 143
_RESEND_DELAY = 0.01  # seconds; by then a callback has usually returned
# Two seconds of delays in all: the import of a user's module may never end.
_MAX_RESENDS = 200
_RESENDING = {"handle_unraisable", "_send_later"}  # functions whose exceptions Python only prints
_IMPORT_FILENAME = "<frozen importlib._bootstrap>"  # each frame of an import has it above itself


@contextlib.contextmanager
def hear_signals() -> Iterator[None]:
    """Raise SIGINT as KeyboardInterrupt and SIGTERM as SystemExit(143) within the context."""
    received: list[int] = []  # the numbers of all signals, those sent again included

    def handle_signal(number: int, frame: FrameType | None) -> None:
        received.append(number)
        # An exception that is raised there might be lost (see above), so the signal is sent again.
        if len(received) <= _MAX_RESENDS and _loses_exceptions(frame):
            _send_later(number)
        elif number == signal.SIGINT:
            signal.default_int_handler(number, frame)
        else:
            sys.exit(TERMINATED)

    with (
        _install_handlers(dict.fromkeys((signal.SIGINT, signal.SIGTERM), handle_signal)),
        _resend_lost_signals(),
    ):
        try:
            yield
        except Exception as error:
            if not received:
                raise
            interrupted = received[-1] == signal.SIGINT
            raise (KeyboardInterrupt() if interrupted else SystemExit(TERMINATED)) from error


@contextlib.contextmanager
def _install_handlers(handlers: Mapping[signal.Signals, Callable[..., None]]) -> Iterator[None]:
    """Install the handlers within the context; outside the main thread Python allows none."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous_handlers = {n: signal.signal(n, handler) for n, handler in handlers.items()}
    try:
        yield
    finally:
        for number, handler in previous_handlers.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def _resend_lost_signals() -> Iterator[None]:
    """Send a signal again if Python would print its exception and continue."""
    previous_hook = sys.unraisablehook

    def handle_unraisable(unraisable: "sys.UnraisableHookArgs") -> None:
        number = _signal_of(unraisable.exc_value)
        if number is None:
            previous_hook(unraisable)
        else:
            _send_later(number)

    sys.unraisablehook = handle_unraisable
    try:
        yield
    finally:
        sys.unraisablehook = previous_hook


def _send_later(number: int) -> None:
    # Python runs signal handlers in the main thread only, so the signal goes there.
    main_thread_id = cast("int", threading.main_thread().ident)
    # No `threading.Timer`: its `start` waits for the thread, longer than the delay on a busy
    # machine, and holds a lock that a handler which comes meanwhile would wait for.
    _thread.start_new_thread(_wait_and_send, (main_thread_id, number))


def _wait_and_send(thread_id: int, number: int) -> None:
    time.sleep(_RESEND_DELAY)
    signal.pthread_kill(thread_id, number)


def _loses_exceptions(frame: FrameType | None) -> bool:
    """Return True if the frame runs within an import, or where a signal is being sent again."""
    while frame is not None:
        name = frame.f_code.co_name
        if frame.f_code.co_filename == _IMPORT_FILENAME or (
            frame.f_code.co_filename == __file__ and name in _RESENDING
        ):
            return True
        frame = frame.f_back
    return False


def _signal_of(error: BaseException | None) -> signal.Signals | None:
    """Return the signal whose handler raised the exception; None for any other exception."""
    if isinstance(error, KeyboardInterrupt):
        return signal.SIGINT
    if isinstance(error, SystemExit) and error.code == TERMINATED:
        return signal.SIGTERM
    return None


class Printable(io.TextIOBase):
    """A text stream that escapes control characters, and characters that its encoding lacks.

    A control character becomes `\\u001b`, which JSON reads as that character; one that the encoding
    lacks becomes `\\xe9`, `\\u0394` or `\\U0001d6ab`, of which JSON knows the second form alone.
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self._encoding = getattr(stream, "encoding", None) or "utf-8"

    def write(self, content: str | bytes) -> int:
        # click tests by b"" if the stream takes bytes, yet writes completions of a shell as bytes.
        if isinstance(content, bytes) and not content:
            raise TypeError("a stream of texts")
        text = content if isinstance(content, str) else bytes(content).decode()
        escaped = CONTROL_CHARACTERS.sub(lambda match: f"\\u{ord(match[0]):04x}", text)
        raw = escaped.encode(self._encoding, "backslashreplace")
        self.stream.write(raw.decode(self._encoding))
        return len(content)

    def flush(self) -> None:
        self.stream.flush()

    def isatty(self) -> bool:
        return self.stream.isatty()

    def fileno(self) -> int:
        return self.stream.fileno()

    @property
    def encoding(self) -> str:  # type: ignore[override]
        return self._encoding


@contextmanager
def printable_streams() -> Iterator[None]:
    """Make standard output and standard error `Printable` within the context.

    The null device replaces a closed standard input or error; a closed output stays None.
    """
    # A descriptor may be closed while its stream object is open, and the reverse: both are mended.
    previous_streams = sys.stdin, sys.stdout, sys.stderr
    _fill_closed_descriptors()
    with open(os.devnull, "r+") as null_device:  # noqa: PTH123
        sys.stdin, sys.stderr = sys.stdin or null_device, Printable(sys.stderr or null_device)
        sys.stdout = sys.stdout and Printable(sys.stdout)
        try:
            yield
        finally:
            sys.stdin, sys.stdout, sys.stderr = previous_streams


def _fill_closed_descriptors() -> None:
    """Open the null device at each closed descriptor of 0, 1 and 2, for the life of the process.

    Otherwise a file opened later would get one of these, and the output of libraries in C with it.
    """
    # The system gives the lowest free descriptor: above 2 it is one that nobody needs.
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(descriptor, True)
    os.close(descriptor)


# Exit statuses, as `main` describes them; 130 and 141 are 128 plus SIGINT and SIGPIPE.
INTERRUPTED, OUTPUT_CLOSED = 130, 141
NOT_DONE = 2


@click.group(
    cls=CommandGroup,
    invoke_without_command=True,
    context_settings={
        "help_option_names": ["-h", "--help"],
        "max_content_width": 100,
        "show_default": True,
    },
)
@click.version_option(package_name="areaproof", prog_name="verify")
@click.pass_context
def cli(context: click.Context) -> None:
    """Verify how well a one-step scheme for p' = −H_q, q' = H_p preserves area.

    \b
    verify prove --system duffing --scheme lie2
    verify run --system duffing --param delta=1 --scheme lie2 \\
           --step-size 0.001 --steps 20000 --q 1.5 --p 0 --digits 50
    verify check claims.toml
    verify report paper -o paper-report

    Numbers are exact: 0.001 is 1/1000, 7/3 is a third of seven.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())
    else:
        paths.forced_path()  # for its InputError: every command refuses an unknown VERIFY_LANES


cli.commands = Commands()  # type: ignore[assignment]  # a Mapping: no command is ever added


def main(arguments: list[str] | None = None) -> None:
    """Run the command line. Exit statuses:

    0: done; the function returns. 1: a check failed, or an exception was raised that nothing here
    expects, which Python prints with its traceback. 2: bad input, lost workers, too little memory,
    or a file or stream that cannot be read or written. 130: interrupted. 141: the reader of the
    output closed it. 143: terminated.
    """
    with printable_streams():
        try:
            if sys.stdout is None:
                raise OSError(errno.EBADF, "is closed")
            with hear_signals():
                # In its standalone mode click would print an error in several lines and exit.
                cli.main(args=arguments, prog_name="verify", standalone_mode=False)
            sys.stdout.flush()
        except (InputError, PlaceError) as error:
            _fail(str(error))
        except click.ClickException as error:
            from verify.commands.shared.usage import explain_usage_mistake

            _fail(explain_usage_mistake(error, sys.argv[1:] if arguments is None else arguments))
        except (KeyboardInterrupt, click.Abort):
            sys.exit(INTERRUPTED)
        except BrokenPipeError:
            _exit_output_closed()
        except SystemExit:
            if not isinstance(sys.stdout, Printable):  # click met a broken pipe, and replaced it
                _exit_output_closed()
            raise
        except MemoryError:
            _fail("there is not enough memory for this")
        except OSError as error:
            # An error that names no file is taken for one of standard output. Flushing that stream
            # at the end of the process would report it a second time.
            if error.filename is None:
                _discard_output()
            _fail(f"{error.filename or 'standard output'}: {error.strerror or error}")


def _exit_output_closed() -> None:
    """Exit with the status for an output that its reader, such as head, has closed."""
    _discard_output()
    sys.exit(OUTPUT_CLOSED)


def _discard_output() -> None:
    """Lead standard output to the null device, so that the flush at the end cannot fail again."""
    with contextlib.suppress(OSError, AttributeError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _fail(message: str) -> None:
    # A message may quote a text with line feeds, and is printed as one line.
    click.echo(f"verify: {' '.join(message.split())}", err=True)
    sys.exit(NOT_DONE)
