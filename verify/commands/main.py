"""The command `verify`: its streams, its signals, its exit statuses.

Heavy libraries are imported inside the command that needs them. Standard output and error carry
only text that any terminal may get. Interruption and termination are never lost, and are raised as
exceptions.

Python raises what a signal's handler raises wherever the program happens to be. Where that is a
callback of the garbage collector (hypothesis has one), a finaliser or a callback from C, Python
prints it and goes on: the signal would be lost, and is sent again. Where it is the import of a
library in C, that may become an ImportError, or nothing at all (gmpy2 runs some Python as it is
imported, and clears what that raises): while something is imported the signal waits, though not
for long, and whatever ends the command after a signal is that signal.
"""

import contextlib
import errno
import io
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import FrameType
from typing import TextIO

import click

from verify.arithmetic.compiled import paths
from verify.commands import Commands
from verify.commands.shared.command_group import CommandGroup
from verify.errors import CONTROL, InputError, PlaceError

TERMINATED = 143
_AGAIN_AFTER = 0.01  # seconds: by then the callback is left
_MOST_WAITS = 200  # of them: a user's module may do as it is imported what does not end
_IMPORTING = "<frozen importlib._bootstrap>"  # the file of frames under which an import runs


@contextlib.contextmanager
def hear_signals() -> Iterator[None]:
    """Raise SIGINT as KeyboardInterrupt and SIGTERM as SystemExit(143); neither is lost."""
    heard: list[int] = []

    def hear(number: int, frame: FrameType | None) -> None:
        heard.append(number)
        # Raised within an import the exception might be lost, as described above: the signal is
        # sent again a little later. After some seconds it is raised all the same.
        if len(heard) <= _MOST_WAITS and _is_importing(frame):
            _send_again(number)
        elif number == signal.SIGINT:
            signal.default_int_handler(number, frame)
        else:
            sys.exit(TERMINATED)

    with (
        _install_handlers(dict.fromkeys((signal.SIGINT, signal.SIGTERM), hear)),
        _resend_lost_signals(),
    ):
        try:
            yield
        except Exception as error:
            if not heard:
                raise
            ending = KeyboardInterrupt() if heard[-1] == signal.SIGINT else SystemExit(TERMINATED)
            raise ending from error


@contextlib.contextmanager
def _install_handlers(handlers: Mapping[signal.Signals, Callable[..., None]]) -> Iterator[None]:
    """Install the handlers for a while; none outside the main thread, where Python refuses it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, handler) for number, handler in handlers.items()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def _resend_lost_signals() -> Iterator[None]:
    """Send a signal again whose exception Python prints and forgets."""
    before = sys.unraisablehook

    def hear(ignored: "sys.UnraisableHookArgs") -> None:
        number = _signal_of(ignored.exc_value)
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
    # Python runs signal handlers in the main thread only, so the signal goes there.
    timer = threading.Timer(_AGAIN_AFTER, signal.pthread_kill, (main, number))
    timer.daemon = True
    timer.start()


def _is_importing(frame: FrameType | None) -> bool:
    """Return True if the frame runs within an import."""
    while frame is not None and frame.f_code.co_filename != _IMPORTING:
        frame = frame.f_back
    return frame is not None


def _signal_of(error: BaseException | None) -> signal.Signals | None:
    if isinstance(error, KeyboardInterrupt):
        return signal.SIGINT
    if isinstance(error, SystemExit) and error.code == TERMINATED:
        return signal.SIGTERM
    return None


class Printable(io.TextIOBase):
    """A text stream without control characters, and without what its encoding does not have.

    Each is written as its escape (`\\u001b`), which in JSON's strings means the same.
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self._encoding = getattr(stream, "encoding", None) or "utf-8"

    def write(self, content: str | bytes) -> int:
        # click writes b"" to find out whether this is a stream of bytes, and takes a TypeError for
        # no. Yet it writes the completions of a shell as bytes.
        if isinstance(content, bytes) and not content:
            raise TypeError("a stream of texts")
        text = content if isinstance(content, str) else bytes(content).decode()
        escaped = CONTROL.sub(lambda match: f"\\u{ord(match[0]):04x}", text)
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
    """Make both streams printable while the command runs; a closed output stays None.

    If standard input or error is closed, nothing is read, and what is written is dropped.
    """
    # Descriptors first, then the objects: either may be closed without the other.
    before = sys.stdin, sys.stdout, sys.stderr
    _take_closed_numbers()
    with open(os.devnull, "r+") as nowhere:  # noqa: PTH123
        sys.stdin, sys.stderr = sys.stdin or nowhere, Printable(sys.stderr or nowhere)
        sys.stdout = sys.stdout and Printable(sys.stdout)
        try:
            yield
        finally:
            sys.stdin, sys.stdout, sys.stderr = before


def _take_closed_numbers() -> None:
    """Open the null device at those of the descriptors 0, 1 and 2 that are closed, for good.

    Else a file opened later would get that number, and with it the output of libraries in C and of
    started processes.
    """
    while (handle := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(handle, True)
    os.close(handle)


INTERRUPTED, UNREAD = 130, 141
BAD_INPUT = 2


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
        paths.forced_path()  # a way that is none is refused by every command


cli.commands = Commands()  # type: ignore[assignment]  # a Mapping: no command is ever added


# -- entry ----------------------------------------------------------------------------------------


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit.

    0 done, 1 a check failed, 2 bad input, workers lost, or output that cannot be written,
    130 interrupted, 141 nobody reads, 143 terminated.
    """
    with printable_streams():
        try:
            if sys.stdout is None:
                raise OSError(errno.EBADF, "is closed")
            with hear_signals():
                # click's standalone mode would print its errors in several lines and exit by
                # itself.
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
            _exit_unread()
        except SystemExit:
            if not isinstance(sys.stdout, Printable):  # click has seen it, and put its own there
                _exit_unread()
            raise
        except MemoryError:
            _fail("there is not enough memory for this")
        except OSError as error:
            # An error without the name of a file is one of standard output, and flushing it at the
            # end of the process would print a second one.
            if error.filename is None:
                _write_nowhere()
            _fail(f"{error.filename or 'standard output'}: {error.strerror or error}")


def _exit_unread() -> None:
    """Exit after the reader of the output, such as head, has closed it."""
    _write_nowhere()
    sys.exit(UNREAD)


def _write_nowhere() -> None:
    """Drop all further output: flushing it at the end of the process would fail again."""
    with contextlib.suppress(OSError, AttributeError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _fail(message: str) -> None:
    # One line, whatever line feeds the message quotes.
    click.echo(f"verify: {' '.join(message.split())}", err=True)
    sys.exit(BAD_INPUT)
