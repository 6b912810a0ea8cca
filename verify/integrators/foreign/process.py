"""A program of others that answers each line with a line, in a process of its own.

It is started with its input and output as pipes, in a session of its own, with limits on processor
time and memory; what it says on standard error is kept for its last line. A call that does not
come back is ended, and the program with it; the next call starts it again, a few times.
"""

import contextlib
import os
import resource
import select
import signal
import subprocess
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from verify.errors import InputError
from verify.integrators.user_code.step import StepError

MOST_MEMORY = 2 * 2**30  # bytes
CALL_SECONDS = 5.0  # for one line
_MOST_STARTS, _MOST_WAITS = 6, 2  # times that it is started, and that it is waited for in vain
_LONGEST = 1 << 16  # bytes of an answer
_WATCHED = 0.05  # seconds between two looks at its memory
_PAGE = os.sysconf("SC_PAGE_SIZE")


@dataclass
class Program:
    """`words`: the program and its arguments; `called`: what the user calls it. `seconds`: of
    processor time, at most; `first_seconds`: for its first answer, as of a program that compiles
    itself. `greeting`: a line that it begins with, once it is ready."""

    words: Sequence[str]
    called: str
    seconds: float
    first_seconds: float = CALL_SECONDS
    greeting: str = ""
    starts: int = 0
    waits: int = 0
    last: str = ""  # what it has done instead of an answer
    answered: bool = False  # since it was started
    ever: bool = False
    last_words: list[str] = field(default_factory=list)
    _running: "subprocess.Popen[bytes] | None" = None
    _waiting: bytes = b""
    _looked: float = 0.0  # when its memory was

    def ask(self, line: str, shown: str = "") -> str:
        """Its answer to a line, which is `shown` so. Raises StepError for what it does instead."""
        shown = shown or line
        try:
            if self._running is None:
                self._greeted()
            own = self._running
            assert own is not None  # noqa: S101 - it has been started
            self._must_be_silent(own)
            self._say(own, line, shown)
            seconds = CALL_SECONDS if self.answered else self.first_seconds
            answer = self._answer(own, shown, seconds)
        except StepError as error:
            self.last = self.last if self._given_up else str(error.said)
            raise
        self.answered = self.ever = True
        return answer

    def _say(self, own: "subprocess.Popen[bytes]", line: str, shown: str) -> None:
        try:
            assert own.stdin is not None  # noqa: S101 - it is a pipe
            own.stdin.write(line.encode() + b"\n")
            own.stdin.flush()
        except OSError:
            raise self._ended(own, shown) from None

    @property
    def _given_up(self) -> bool:
        return self.starts >= _MOST_STARTS or self.waits >= (_MOST_WAITS if self.ever else 1)

    def begin(self) -> None:
        """Starts it. InputError where it does not start, or does not begin with its greeting."""
        try:
            self._greeted()
        except StepError as error:
            said = self.last_words[-1] if self.last_words else str(error.said)
            raise InputError("integrator", self.called, f"does not load: {said}") from None

    def _greeted(self) -> None:
        own = self._start()
        if self.greeting:
            answer = self._answer(own, self.greeting, self.first_seconds)
            if answer != self.greeting:
                self.close()
                raise StepError(f"it begins with {_shown(answer.encode())}")

    def close(self) -> None:
        """Ends it, with all that it has started."""
        own, self._running, self._waiting = self._running, None, b""
        if own is None:
            return
        with contextlib.suppress(OSError):
            os.killpg(own.pid, signal.SIGKILL)
        own.wait()
        for pipe in (own.stdin, own.stdout):
            with contextlib.suppress(OSError):
                if pipe is not None:
                    pipe.close()

    # -- its life ---------------------------------------------------------------------------------

    def _start(self) -> "subprocess.Popen[bytes]":
        if self._given_up:
            raise StepError(f"{self.last} (it was started {self.starts} times, and is not again)")
        self.starts += 1
        try:
            own = subprocess.Popen(  # noqa: S603 - it is what the user asks for
                list(self.words),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
                preexec_fn=self._limited,
            )
        except (OSError, ValueError) as error:
            problem = getattr(error, "strerror", None) or str(error)
            raise InputError("integrator", self.called, f"does not start: {problem}") from None
        self._running, self._waiting, self.answered = own, b"", False
        threading.Thread(target=self._listen, args=(own,), daemon=True).start()
        return own

    def _limited(self) -> None:
        """In the new process, before the program: a limit of processor time, should we be ended,
        and no file of its memory where it crashes."""
        seconds = int(self.seconds) + 30
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    def _listen(self, own: "subprocess.Popen[bytes]") -> None:
        """Keeps the last lines of standard error."""
        assert own.stderr is not None  # noqa: S101 - it is a pipe
        with own.stderr as stream:
            while chunk := os.read(stream.fileno(), 4096):
                lines = chunk.decode("utf-8", "replace").strip().splitlines()
                self.last_words = [*self.last_words, *lines][-3:]

    # -- one answer -------------------------------------------------------------------------------

    def _must_be_silent(self, own: "subprocess.Popen[bytes]") -> None:
        if self._waiting or self._readable(own, 0):
            chunk = self._waiting or self._read(own)
            if chunk:
                self.close()
                raise StepError(f"it prints what it was not asked for: {_shown(chunk)}")

    def _answer(self, own: "subprocess.Popen[bytes]", shown: str, seconds: float) -> str:
        until, found = time.monotonic() + seconds, b""
        while b"\n" not in found:
            left = until - time.monotonic()
            if left <= 0:
                self.waits += 1
                self.close()
                raise StepError(f"a call of it does not end within {seconds:g} s")
            if self._takes_too_much(own):
                self.close()
                raise StepError(f"it takes more than {MOST_MEMORY / 2**30:g} GiB of memory")
            if not self._readable(own, min(left, _WATCHED)):
                continue
            chunk = self._read(own)
            if not chunk:
                raise self._ended(own, shown)
            found += chunk
            if len(found) > _LONGEST:
                self.close()
                raise StepError(f"it prints more than {_LONGEST} bytes for a line")
        answer, _, self._waiting = found.partition(b"\n")
        return answer.decode("utf-8", "replace")

    def _ended(self, own: "subprocess.Popen[bytes]", shown: str) -> StepError:
        """It has ended instead of answering."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            own.wait(1)
        status = own.poll()
        time.sleep(_WATCHED)  # for what it has said at last
        self.close()
        said = f": {self.last_words[-1][:80]}" if self.last_words else ""
        if status is None:
            return StepError(f"it closes its output, asked “{shown}”{said}")
        if status < 0:
            name = signal.Signals(-status).name
            return StepError(f"it crashes with {name}, asked “{shown}”{said}")
        return StepError(f"it ends with status {status} in place of an answer to “{shown}”{said}")

    def _readable(self, own: "subprocess.Popen[bytes]", seconds: float) -> bool:
        assert own.stdout is not None  # noqa: S101 - it is a pipe
        return bool(select.select([own.stdout], [], [], seconds)[0])

    def _read(self, own: "subprocess.Popen[bytes]") -> bytes:
        assert own.stdout is not None  # noqa: S101 - it is a pipe
        return os.read(own.stdout.fileno(), _LONGEST)

    def _takes_too_much(self, own: "subprocess.Popen[bytes]") -> bool:
        """Looked at now and then: it takes as long as several short calls."""
        now = time.monotonic()
        if now - self._looked < _WATCHED:
            return False
        self._looked = now
        return self._memory(own) > MOST_MEMORY

    def _memory(self, own: "subprocess.Popen[bytes]") -> int:
        """Bytes that it and what it has started hold now, 0 where that is not known."""
        return sum(map(_resident, _with_children(own.pid)))


def _with_children(pid: int) -> list[int]:
    """The process, and those that it has started."""
    found = [pid]
    for each in found:  # it grows while it is walked
        try:
            found += map(int, Path(f"/proc/{each}/task/{each}/children").read_text().split())
        except (OSError, ValueError):
            continue
    return found[:100]


def _resident(pid: int) -> int:
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * _PAGE
    except (OSError, ValueError, IndexError):
        return 0


def _shown(chunk: bytes) -> str:
    text = chunk.decode("utf-8", "replace").strip()
    return "“" + "".join(x if x.isprintable() else " " for x in text)[:40] + "”"
