"""A program of others that answers each line with a line, in a process of its own.

It is started with its input and output as pipes, below a guard that ends whatever it leaves behind,
with limits on processor time and memory; what it says on standard error is kept for its last line.
A call that does not come back is ended, and the program with it; the next call starts it again, a
few times.
"""

import contextlib
import fcntl
import os
import select
import signal
import socket
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from io import FileIO
from pathlib import Path
from typing import cast

from verify.errors import InputError
from verify.integrators.foreign import guard
from verify.integrators.foreign.lines import quote, short_line
from verify.integrators.user_code.step import StepError
from verify.prose import count

MOST_MEMORY = 2 * 2**30  # bytes
CALL_SECONDS = 5.0  # for one line
FIRST_SECONDS = 20.0  # for the first one, while it computes: it may compile itself
_MOST_FAILURES, _MOST_WAITS = 6, 2  # after which it is not started again
_CALLS_A_FAILURE = 100  # that it has answered: one more is let pass for so many
_LONGEST = 1 << 16  # bytes of an answer
_WATCHED = 0.05  # seconds between two looks at it
_GRACE = 0.1  # seconds, for a line too many after the first answer
_LAST_SECONDS = 1.0  # for what it says when its input ends
_MOST_PROCESSES = 100  # that are looked at
_PAGE = os.sysconf("SC_PAGE_SIZE")
_ANSWER = "an answer is one line of numbers, and nothing else is printed"
_FLUSH = "fflush(stdout) in C, std::endl in C++, flush(6) in Fortran, flush=True in Python"


@dataclass
class ForeignProgram:
    """A program that answers lines. `words`: the program and its arguments; `called`: the user's
    name for it. `seconds`: of processor time, at most. `greeting`: a line that it begins with, once
    it is ready. `advice`: a hint that is added where it crashes. `show_line`: formats a line for
    people."""

    words: Sequence[str]
    called: str
    seconds: float
    greeting: str = ""
    advice: str = ""
    show_line: Callable[[str], str] = short_line
    failures: int = 0
    waits: int = 0
    calls: int = 0  # that it has answered
    last: str = ""  # what it has done instead of an answer
    answered: bool = False  # since it was started
    last_words: list[str] = field(default_factory=list)
    _running: "subprocess.Popen[bytes] | None" = None
    _control: socket.socket | None = None  # the guard's
    _waiting: bytes = b""  # output that answers no line
    _looked: float = 0.0  # when it was looked at

    def answers(self, lines: Sequence[str]) -> list[str | StepError]:
        """Return the answer to each line, or the error in place of it. Our own host is sent all
        lines at once; another program may read more than it answers, so that it is sent one by
        one."""
        replies: list[str | StepError] = []
        while remaining := lines[len(replies) :]:
            replies += self._answer_some(remaining if self.greeting else remaining[:1])
        return replies

    def _answer_some(self, lines: Sequence[str]) -> list[str | StepError]:
        """Return the answers to the first lines; an error is the last."""
        if self._running is None and self._given_up:
            times = count(self.failures, "time")
            return [StepError(f"{self.last}; it has failed {times}, and is not started again")]
        answers: list[str | StepError] = []
        try:
            if self._running is None:
                self._start_and_greet()
            self._must_be_silent(0)
            for answer in self._exchange(lines, "".join(f"{line}\n" for line in lines)):
                answers.append(answer)
                self.calls += 1
            if not self.answered:
                self._must_be_silent(_GRACE)
            self.answered = True
        except StepError as error:
            self.failures, self.last = self.failures + 1, str(error.said)
            answers = [*answers[: len(lines) - 1], error]
        except BaseException:  # an alarm: its answer would be taken for that to another line
            self.close()
            raise
        return answers

    @property
    def _given_up(self) -> bool:
        # A step may fail at some states: failures are forgiven in proportion to the answers.
        limit = _MOST_FAILURES + self.calls // _CALLS_A_FAILURE
        return self.failures >= limit or self.waits >= (_MOST_WAITS if self.calls else 1)

    # -- its life ---------------------------------------------------------------------------------

    def begin(self) -> None:
        """Start the program. Raises InputError where it does not start, or does not begin with its
        greeting."""
        try:
            self._start_and_greet()
        except StepError as error:
            reason = self.last_words[-1] if self.last_words else str(error.said)
            raise InputError("integrator", self.called, f"does not load: {reason}") from None

    def _start_and_greet(self) -> None:
        self._start()
        if self.greeting:
            answer = next(self._exchange([self.greeting], ""))
            if answer != self.greeting:
                self.close()
                raise StepError(f"it begins with {quote(answer)}")
            self.answered = True

    def _start(self) -> None:
        ours, guards = socket.socketpair()
        script, seconds = str(Path(guard.__file__).resolve()), str(int(self.seconds) + 30)
        with guards:
            process = subprocess.Popen(  # noqa: S603 - it is what the user asks for
                [sys.executable, "-I", "-S", script, str(guards.fileno()), seconds, *self.words],
                bufsize=0,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
                pass_fds=[guards.fileno()],
            )
        self._running, self._control, self._waiting, self.answered = process, ours, b"", False
        threading.Thread(target=self._listen, args=(process,), daemon=True).start()
        if problem := ours.recv(_LONGEST).decode("utf-8", "replace").strip():
            self.close()
            raise InputError("integrator", self.called, f"does not start: {problem}")

    def _listen(self, process: "subprocess.Popen[bytes]") -> None:
        """Keep the last lines of standard error."""
        assert process.stderr is not None  # noqa: S101 - it is a pipe
        with process.stderr as stream:
            while chunk := os.read(stream.fileno(), 4096):
                lines = chunk.decode("utf-8", "replace").strip().splitlines()
                self.last_words = [*self.last_words, *lines][-3:]

    def close(self) -> None:
        """End the program, with all that it has started."""
        process, self._running, self._waiting = self._running, None, b""
        if process is None or self._control is None:
            return
        self._control.close()  # at which the guard ends all
        try:
            process.wait(CALL_SECONDS)
        except subprocess.TimeoutExpired:
            with contextlib.suppress(OSError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        for pipe in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):
                if pipe is not None:
                    pipe.close()

    # -- its answers ------------------------------------------------------------------------------

    def _exchange(self, lines: Sequence[str], text: str) -> Iterator[str]:
        """Send the lines, joined in `text`, and yield the answers as they come. Raises StepError
        where the program does anything else."""
        unsaid, heard, number = memoryview(text.encode()), b"", 0
        since, slept, whole = time.monotonic(), 0.0, list[bytes]()
        while number < len(lines):
            stdin, stdout = self._pipes
            ready, takes, _ = select.select([stdout], [stdin] if unsaid else [], [], _WATCHED)
            if takes:
                try:
                    # Only what the pipe takes at once is written, and answers are read in between:
                    # else a program that answers before it has read all lines would wait for us,
                    # and we for it.
                    unsaid = unsaid[stdin.write(unsaid[: select.PIPE_BUF]) :]
                except OSError:  # it has ended, as its output will tell
                    unsaid = unsaid[:0]
            if ready:
                chunk = stdout.read(_LONGEST)
                if not chunk:
                    raise self._describe_end(lines[number])
                *whole, heard = (heard + chunk).split(b"\n")
                while whole and number < len(lines):
                    yield whole.pop(0).decode("utf-8", "replace")
                    number, since, slept = number + 1, time.monotonic(), 0.0
            elif not takes and self._sleeps:
                slept += _WATCHED
            if number < len(lines):
                self._must_go_on(lines[number], heard, time.monotonic() - since, slept)
        self._waiting = b"\n".join([*whole, heard])

    @property
    def _pipes(self) -> tuple[FileIO, FileIO]:
        """The running program's input and output."""
        assert self._running is not None  # noqa: S101 - it has been started
        return cast(FileIO, self._running.stdin), cast(FileIO, self._running.stdout)

    def _must_be_silent(self, seconds: float) -> None:
        """Raise StepError where the program prints something without being asked."""
        stdout = self._pipes[1]
        if not self._waiting and select.select([stdout], [], [], seconds)[0]:
            self._waiting = stdout.read(_LONGEST)
        if output := self._waiting:
            self.close()
            raise StepError(f"it prints {quote(output)}, which it was not asked for: {_ANSWER}")

    def _must_go_on(self, line: str, heard: bytes, spent: float, slept: float) -> None:
        """Raise StepError where a call takes too long or too much memory, or prints too much."""
        problem, now = "", time.monotonic()
        if len(heard) > _LONGEST:
            problem = f"it prints more than {_LONGEST} bytes for a line"
        elif now - self._looked >= _WATCHED:  # a look takes as long as several short calls
            self._looked = now
            if sum(map(_resident, self._processes)) > MOST_MEMORY:
                problem = f"it takes more than {MOST_MEMORY / 2**30:g} GiB of memory"
        time_limit = CALL_SECONDS if self.answered else FIRST_SECONDS
        asleep = not self.answered and slept >= CALL_SECONDS
        if not problem and (spent >= time_limit or asleep):
            self.waits += 1
            problem = self._silence(line, heard, min(int(spent), time_limit), asleep)
        if problem:
            self.close()
            raise StepError(problem)

    def _silence(self, line: str, heard: bytes, seconds: float, asleep: bool) -> str:
        """Describe what the program does instead of answering in time; for the first line, also
        when its input ends."""
        if self.answered:
            return f"a call of it does not end within {seconds:g} s, asked “{self.show_line(line)}”"
        stdin, stdout = self._pipes
        unread = any(fcntl.ioctl(stdin, termios.FIONREAD, bytes(4)))
        stdin.close()
        while (
            asleep and select.select([stdout], [], [], _LAST_SECONDS)[0] and len(heard) < _LONGEST
        ):
            if not (chunk := stdout.read(_LONGEST)):
                break
            heard += chunk
        hint = f": {_ANSWER}; flush after it, as by {_FLUSH}"
        if b"\n" in heard:
            hint = f", but {quote(heard)} when its input ends: it does not flush; write {_FLUSH}"
        elif heard:
            hint = f": it prints {quote(heard)} without an end of line"
        elif unread:
            hint = ": it does not read it"
        first_line = self.show_line(line)
        return f"it gives no answer to its first line, “{first_line}”, within {seconds:g} s{hint}"

    def _describe_end(self, line: str) -> StepError:
        """Return the error of a program that has ended instead of answering."""
        process = self._running
        assert process is not None  # noqa: S101 - it has been started
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(_LAST_SECONDS)
        status = process.poll()
        time.sleep(_WATCHED)  # for what it has said at last
        self.close()
        suffix = f": {self.last_words[-1][:80]}" if self.last_words else ""
        request = f"“{self.show_line(line)}”"
        if status is None:
            return StepError(f"it closes its output, asked {request}{suffix}")
        if status < 0:
            crash = f"it crashes with {signal.Signals(-status).name}, asked {request}{suffix}"
            return StepError(crash + self.advice)
        if status == 0 and not suffix:
            suffix = "; it is to read and answer lines until its input ends"
        return StepError(f"it ends with status {status} in place of an answer to {request}{suffix}")

    # -- its processes ----------------------------------------------------------------------------

    @property
    def _processes(self) -> list[int]:
        """The process ids of the program and of what it has started: all below the guard."""
        assert self._running is not None  # noqa: S101 - it has been started
        pids = [self._running.pid]
        for pid in pids:  # it grows while it is walked
            for children in Path(f"/proc/{pid}/task").glob("*/children"):
                pids += map(int, _text(children).split())
        return pids[1:_MOST_PROCESSES]

    @property
    def _sleeps(self) -> bool:
        """True if no thread of it computes, or waits for a disk, as far as the system tells."""
        threads = (x for pid in self._processes for x in Path(f"/proc/{pid}/task").glob("*/stat"))
        states = {_text(thread).rpartition(") ")[2][:1] for thread in threads}
        return bool(states) and not states & {"R", "D"}


def _resident(pid: int) -> int:
    """Return how many bytes of memory the process holds now, 0 where that is not known."""
    return int((_text(Path(f"/proc/{pid}/statm")).split() or "00")[1]) * _PAGE


def _text(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:  # it has ended
        return ""
