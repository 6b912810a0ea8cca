"""A limit on work that may never end, above all of sympy: an error after a number of calls.

Contract: `with Effort(most, error):` raises `error` if its block makes more than `most` calls of
functions in this thread, where the return from a call counts as one more; an Effort that is entered
again continues its count. Calls are counted, not seconds, so that the same work is given up on slow
and on fast machines, and memory has a limit too. Efforts may be nested; the outer one counts the
calls of the inner one. A count of four million takes about a second.

Not promised: a single call that takes long, such as arithmetic on enormous numbers, is not ended;
and nothing is counted while a profiler runs.
"""

import sys
from collections.abc import Callable
from inspect import CO_GENERATOR
from typing import Any, TypeVar

from verify.errors import LimitError

T = TypeVar("T")
# Calls beyond the limit after which the error is raised in generators too. Python swallows an error
# in a generator that is being closed, so any other frame is preferred until then.
_GENERATOR_CALLS = 100_000
MAX_CALLS = 4_000_000  # the limit of calls if a person waits for the result


class _SpentError(BaseException):
    """The error that no calls are left; no Exception, so that no `except Exception` catches it."""


class Effort:
    """A limit on calls, of functions in C too; `error` is raised when no calls are left."""

    def __init__(self, most: int, error: Exception) -> None:
        self.calls_left, self.error = most, error
        self.outer: Any = None  # the profile function that Python called before this one

    def __enter__(self) -> None:
        self.outer = sys.getprofile()
        if self.outer is None or isinstance(self.outer, Effort):
            # A profile function also sees the calls of functions in C, which a trace function does
            # not. If somebody else's profiler runs, it stays, and nothing is counted.
            sys.setprofile(self)

    def __call__(self, frame: Any, event: str, _: Any) -> None:
        """Count one; Python calls this at every call and at every return.

        The error is not raised at a return, where it would be lost, nor in this file, where it
        would keep `__exit__` from ending the count. In a generator, where it may be lost, it is
        raised only after `_GENERATOR_CALLS` more.
        """
        self.calls_left -= 1
        if self.calls_left < 0 and event.endswith("call"):
            code = frame.f_code
            may_raise = self.calls_left < -_GENERATOR_CALLS or not code.co_flags & CO_GENERATOR
            if may_raise and code.co_filename != __file__:
                raise _SpentError(self)
        if self.outer is not None:
            self.outer(frame, event, _)

    def __exit__(self, *error_info: Any) -> None:
        if self.outer is None or isinstance(self.outer, Effort):
            sys.setprofile(self.outer)
        # The _SpentError of an outer Effort passes through; that of this one becomes `error`. If no
        # calls are left but the block ended without an error, somebody's code has caught it, or no
        # call came at which to raise it.
        if self.calls_left < 0 and (error_info[1] is None or error_info[1].args == (self,)):
            raise self.error from None


def answer_unless_long(question: Callable[[], T], otherwise: T, most: int = 600_000) -> T:
    """Return the answer to `question`; `otherwise` if that takes more than `most` calls."""
    effort = Effort(most, LimitError("question", most, "is given up"))
    try:
        with effort:
            return question()
    except LimitError as error:
        if error is not effort.error:  # another limit, within the question
            raise
        return otherwise


def limit_effort(source: str, value: object, doing: str, most: int = MAX_CALLS) -> Effort:
    """Return an Effort whose LimitError names a user's input, and what takes too long: `doing`."""
    return Effort(most, LimitError(source, value, f"{doing} takes too long"))
