"""A limit on work that may never end, sympy's above all: an error after so many calls.

Contract: `with Effort(most, error):` raises `error` where its block makes more than `most` calls of
functions in this thread; an Effort that is entered again goes on counting. Calls are counted and
not seconds: work that is given up on a slow machine is given up on a fast one, and memory has its
limit too. Efforts may be nested; the outer one goes on counting. Four million calls take about a
second.

Not promised: a single call that takes long, as arithmetic on enormous numbers does, is not ended;
and where a profiler runs nothing is counted.
"""

import sys
from collections.abc import Callable
from inspect import CO_GENERATOR
from typing import Any, TypeVar

from verify.errors import LimitError

T = TypeVar("T")
# Calls beyond the limit after which generators are ended too: an error in a generator that is
# being closed is swallowed by Python, so any other frame is preferred until then.
_MORE = 100_000
MOST = 4_000_000  # calls for what somebody waits for


class _SpentError(BaseException):
    """The sign that the calls are spent; no Exception, so that no `except Exception` catches it."""


class Effort:
    """A number of calls, of functions in C among them; `error` is raised where they are spent."""

    def __init__(self, most: int, error: Exception) -> None:
        self.calls_left, self.error = most, error
        self.outer: Any = None  # what is called at every call already

    def __enter__(self) -> None:
        self.outer = sys.getprofile()
        if self.outer is None or isinstance(self.outer, Effort):
            # A profile function also sees the calls of functions in C, which a trace function does
            # not. Where somebody else's profiler runs it stays, and nothing is counted.
            sys.setprofile(self)

    def __call__(self, frame: Any, event: str, _: Any) -> None:
        """Count a call; Python calls this at every call and return.

        An error at a return, or in a generator that is being closed, would be lost, so generators
        are the last that are ended; and one in `__exit__` would leave this counting.
        """
        self.calls_left -= 1
        if self.calls_left < 0 and event.endswith("call"):
            code = frame.f_code
            last = self.calls_left < -_MORE or not code.co_flags & CO_GENERATOR
            if last and code.co_filename != __file__:
                raise _SpentError(self)
        if self.outer is not None:
            self.outer(frame, event, _)

    def __exit__(self, *error_info: Any) -> None:
        if self.outer is None or isinstance(self.outer, Effort):
            sys.setprofile(self.outer)
        # The error of an outer Effort passes through. That of this one becomes `error`, and so
        # does its loss on the way, as where somebody's code caught it.
        if self.calls_left < 0 and (error_info[1] is None or error_info[1].args == (self,)):
            raise self.error from None


def answer_unless_long(question: Callable[[], T], otherwise: T, most: int = 600_000) -> T:
    """Return the answer to `question`; `otherwise` where that takes more than `most` calls."""
    effort = Effort(most, LimitError("question", most, "is given up"))
    try:
        with effort:
            return question()
    except LimitError as error:
        if error is not effort.error:  # the question gave up something of its own
            raise
        return otherwise


def limit_effort(source: str, value: object, doing: str, most: int = MOST) -> Effort:
    """Return the Effort of a user's input; its LimitError names the input and what is too long."""
    return Effort(most, LimitError(source, value, f"{doing} takes too long"))
