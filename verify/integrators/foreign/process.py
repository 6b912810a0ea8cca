"""A user's program that answers each line with a line, in a process of its own.

The program has pipes as its input and output. It runs below a guard process, which ends all that it
leaves behind, and with limits on processor time and memory. The last lines of its standard error
are kept for messages. If a call does not return in time, the program is ended; the next call starts
it again, a few times.
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

MOST_MEMORY = 2 * 2**30  # bytes, of the program and of all that it has started
CALL_SECONDS = 5.0  # the limit for the answer to one line
# The limit for the first answer, as long as the program computes: it may compile itself.
FIRST_SECONDS = 20.0
# After this number of errors, or of answers that did not come in time, it is not started again.
_MAX_FAILURES, _MAX_TIMEOUTS = 6, 2
_CALLS_PER_FAILURE = 100  # one more failure is allowed for each such number of answers
_MAX_ANSWER_BYTES = 1 << 16
_WATCH_SECONDS = 0.05  # the interval between two looks at its memory and its threads
_EXTRA_LINE_SECONDS = 0.1  # the wait after the first answer, in which no further line may come
_LAST_OUTPUT_SECONDS = 1.0  # the wait for its output after the end of its input, and for its end
_MAX_PROCESSES = 100  # processes of the program that are looked at, its guard among them
_PAGE = os.sysconf("SC_PAGE_SIZE")
_ANSWER = "an answer is one line of numbers, and nothing else is printed"
_FLUSH = "fflush(stdout) in C, std::endl in C++, flush(6) in Fortran, flush=True in Python"


@dataclass
class ForeignProgram:
    """A program that answers lines.

    `words`: the program and its arguments; `display_name`: the user's name for it. `seconds`: the
    limit of its processor time. `greeting`: the line that it prints once it is ready, or "" for a
    program that prints none. `advice`: a hint that is added to the message of a crash. `show_line`:
    formats a line for people.
    """

    words: Sequence[str]
    display_name: str
    seconds: float
    greeting: str = ""
    advice: str = ""
    show_line: Callable[[str], str] = short_line
    failures: int = 0
    timeouts: int = 0
    answered_calls: int = 0
    last_problem: str = ""  # the message of the last failure
    has_answered: bool = False  # since its last start
    last_words: list[str] = field(default_factory=list)  # the last lines of standard error
    _process: "subprocess.Popen[bytes] | None" = None
    _guard_socket: socket.socket | None = None  # the guard ends the program when it is closed
    _unread_output: bytes = b""  # output beyond the answers
    _last_look: float = 0.0  # the time.monotonic of the last look at its memory

    def answers(self, lines: Sequence[str]) -> list[str | StepError]:
        """Return the answer to each line, or the error in its place.

        Our own host, which has a greeting, is sent all lines at once. Any other program is sent one
        line at a time, as it might read several before it answers the first.
        """
        replies: list[str | StepError] = []
        while remaining := lines[len(replies) :]:
            replies += self._answer_some(remaining if self.greeting else remaining[:1])
        return replies

    def _answer_some(self, lines: Sequence[str]) -> list[str | StepError]:
        """Return the answers to the first lines, up to the first error, which is the last item."""
        if self._process is None and self._given_up:
            end = f"it has failed {count(self.failures, 'time')}, and is not started again"
            return [StepError(f"{self.last_problem}; {end}")]
        answers: list[str | StepError] = []
        try:
            if self._process is None:
                self._start_and_greet()
            self._must_be_silent(0)
            for answer in self._exchange(lines, "".join(f"{line}\n" for line in lines)):
                answers.append(answer)
                self.answered_calls += 1
            if not self.has_answered:
                self._must_be_silent(_EXTRA_LINE_SECONDS)
            self.has_answered = True
        except StepError as error:
            self.failures, self.last_problem = self.failures + 1, str(error.clause)
            answers = [*answers[: len(lines) - 1], error]
        # After an alarm the answer would be taken for that to another line: the program is ended.
        except BaseException:
            self.close()
            raise
        return answers

    @property
    def _given_up(self) -> bool:
        # A step may fail at some states: failures are forgiven in proportion to the answers.
        max_failures = _MAX_FAILURES + self.answered_calls // _CALLS_PER_FAILURE
        max_timeouts = _MAX_TIMEOUTS if self.answered_calls else 1
        return self.failures >= max_failures or self.timeouts >= max_timeouts

    # -- its life ---------------------------------------------------------------------------------

    def begin(self) -> None:
        """Start the program. Raises InputError if it does not start, or does not print its
        greeting."""
        try:
            self._start_and_greet()
        except StepError as error:
            reason = self.last_words[-1] if self.last_words else str(error.clause)
            raise InputError("integrator", self.display_name, f"does not load: {reason}") from None

    def _start_and_greet(self) -> None:
        self._start()
        if self.greeting:
            answer = next(self._exchange([self.greeting], ""))
            if answer != self.greeting:
                self.close()
                raise StepError(f"it begins with {quote(answer)}")
            self.has_answered = True

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
        self._process, self._guard_socket, self._unread_output, self.has_answered = (
            process,
            ours,
            b"",
            False,
        )
        threading.Thread(target=self._listen, args=(process,), daemon=True).start()
        if problem := ours.recv(_MAX_ANSWER_BYTES).decode("utf-8", "replace").strip():
            self.close()
            raise InputError("integrator", self.display_name, f"does not start: {problem}")

    def _listen(self, process: "subprocess.Popen[bytes]") -> None:
        """Keep the last lines of standard error."""
        assert process.stderr is not None  # noqa: S101 - it is a pipe
        with process.stderr as stream:
            while chunk := os.read(stream.fileno(), 4096):
                lines = chunk.decode("utf-8", "replace").strip().splitlines()
                self.last_words = [*self.last_words, *lines][-3:]

    def close(self) -> None:
        """End the program, with all that it has started."""
        process, self._process, self._unread_output = self._process, None, b""
        if process is None or self._guard_socket is None:
            return
        self._guard_socket.close()  # at which the guard ends all
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
        """Send the lines, joined in `text`, and yield the answers as they come.

        Raises StepError if the program does anything else.
        """
        unsent, heard, number = memoryview(text.encode()), b"", 0
        since, slept, complete_lines = time.monotonic(), 0.0, list[bytes]()
        while number < len(lines):
            stdin, stdout = self._pipes
            ready, takes, _ = select.select([stdout], [stdin] if unsent else [], [], _WATCH_SECONDS)
            if takes:
                try:
                    # Only what the pipe takes at once is written, and answers are read in between:
                    # else a program that answers before it has read all lines would wait for us,
                    # and we for it.
                    unsent = unsent[stdin.write(unsent[: select.PIPE_BUF]) :]
                except OSError:  # it has ended; the end of its output tells so below
                    unsent = unsent[:0]
            if ready:
                chunk = stdout.read(_MAX_ANSWER_BYTES)
                if not chunk:
                    raise self._describe_end(lines[number])
                *complete_lines, heard = (heard + chunk).split(b"\n")
                while complete_lines and number < len(lines):
                    yield complete_lines.pop(0).decode("utf-8", "replace")
                    number, since, slept = number + 1, time.monotonic(), 0.0
            elif not takes and self._sleeps:
                slept += _WATCH_SECONDS
            if number < len(lines):
                self._must_go_on(lines[number], heard, time.monotonic() - since, slept)
        self._unread_output = b"\n".join([*complete_lines, heard])

    @property
    def _pipes(self) -> tuple[FileIO, FileIO]:
        """The running program's input and output."""
        assert self._process is not None  # noqa: S101 - it has been started
        return cast(FileIO, self._process.stdin), cast(FileIO, self._process.stdout)

    def _must_be_silent(self, seconds: float) -> None:
        """Raise StepError if the program prints something unrequested within that time."""
        stdout = self._pipes[1]
        if not self._unread_output and select.select([stdout], [], [], seconds)[0]:
            self._unread_output = stdout.read(_MAX_ANSWER_BYTES)
        if output := self._unread_output:
            self.close()
            raise StepError(f"it prints {quote(output)}, which it was not asked for: {_ANSWER}")

    def _must_go_on(self, line: str, heard: bytes, spent: float, slept: float) -> None:
        """Raise StepError if a call takes too long or too much memory, or prints too much.

        `heard`: the bytes of an incomplete line. `spent`: the seconds since the last answer, and
        `slept`: those of them in which no thread computed.
        """
        problem, now = "", time.monotonic()
        if len(heard) > _MAX_ANSWER_BYTES:
            problem = f"it prints more than {_MAX_ANSWER_BYTES} bytes for a line"
        elif now - self._last_look >= _WATCH_SECONDS:  # a look takes as long as several short calls
            self._last_look = now
            if sum(map(_resident, self._processes)) > MOST_MEMORY:
                problem = f"it takes more than {MOST_MEMORY / 2**30:g} GiB of memory"
        time_limit = CALL_SECONDS if self.has_answered else FIRST_SECONDS
        asleep = not self.has_answered and slept >= CALL_SECONDS
        if not problem and (spent >= time_limit or asleep):
            self.timeouts += 1
            problem = self._describe_silence(line, heard, min(int(spent), time_limit), asleep)
        if problem:
            self.close()
            raise StepError(problem)

    def _describe_silence(self, line: str, heard: bytes, seconds: float, asleep: bool) -> str:
        """Describe the program's behaviour instead of an answer in time.

        For its first line its input is closed, to see what it prints then.
        """
        if self.has_answered:
            return f"a call of it does not end within {seconds:g} s, asked “{self.show_line(line)}”"
        stdin, stdout = self._pipes
        unread = any(fcntl.ioctl(stdin, termios.FIONREAD, bytes(4)))
        stdin.close()
        while (
            asleep
            and select.select([stdout], [], [], _LAST_OUTPUT_SECONDS)[0]
            and len(heard) < _MAX_ANSWER_BYTES
        ):
            if not (chunk := stdout.read(_MAX_ANSWER_BYTES)):
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
        process = self._process
        assert process is not None  # noqa: S101 - it has been started
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(_LAST_OUTPUT_SECONDS)
        status = process.poll()
        time.sleep(_WATCH_SECONDS)  # so that the thread has read the last lines of standard error
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
        assert self._process is not None  # noqa: S101 - it has been started
        pids = [self._process.pid]
        for pid in pids:  # the list grows during the iteration
            for children in Path(f"/proc/{pid}/task").glob("*/children"):
                pids += map(int, _text(children).split())
        return pids[1:_MAX_PROCESSES]  # the first is the guard

    @property
    def _sleeps(self) -> bool:
        """True if the system shows its threads, and none computes or waits for a disk."""
        threads = (x for pid in self._processes for x in Path(f"/proc/{pid}/task").glob("*/stat"))
        states = {_text(thread).rpartition(") ")[2][:1] for thread in threads}
        return bool(states) and not states & {"R", "D"}


def _resident(pid: int) -> int:
    """Return the bytes of memory that the process holds now; 0 if they are not known."""
    return int((_text(Path(f"/proc/{pid}/statm")).split() or "00")[1]) * _PAGE


def _text(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:  # the process has ended
        return ""
