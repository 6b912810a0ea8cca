"""A limit on work that may never end, sympy's above all: so many calls, and then an error.

Contract: `with Effort(most, error):` raises `error` where what is done in it, in this thread, makes
more calls of functions than `most`; one that is entered again goes on counting. Calls are counted
and not seconds: what is given up on a slow machine is given up on a fast one, and memory has its
limit too. It may stand in another one, which counts on. Four million calls take about a second.

Not promised: a single call that takes long, as arithmetic on enormous numbers does, is not ended;
and where a profiler runs nothing is counted.
"""

import sys
from collections.abc import Callable
from inspect import CO_GENERATOR
from typing import Any, TypeVar

from verify.errors import LimitError

T = TypeVar("T")
_MORE = 100_000
MOST = 4_000_000  # calls for what somebody waits for


class _SpentError(BaseException):
    """No Exception, so that nobody on its way takes it for one that they expect."""


class Effort:
    """So many calls, of functions in C among them; `error` tells that they were too few."""

    def __init__(self, most: int, error: Exception) -> None:
        self.left, self.error = most, error
        self.outer: Any = None  # what is called at every call already

    def __enter__(self) -> None:
        self.outer = sys.getprofile()
        if self.outer is None or isinstance(self.outer, Effort):
            sys.setprofile(self)

    def __call__(self, frame: Any, event: str, _: Any) -> None:
        """What Python calls at every call and return.

        An error at a return, or in a generator that is being closed, would be lost, so generators
        are the last that are ended; and one in `__exit__` would leave this counting.
        """
        self.left -= 1
        if self.left < 0 and event.endswith("call"):
            code = frame.f_code
            last = self.left < -_MORE or not code.co_flags & CO_GENERATOR
            if last and code.co_filename != __file__:
                raise _SpentError(self)
        if self.outer is not None:
            self.outer(frame, event, _)

    def __exit__(self, *raised: Any) -> None:
        if self.outer is None or isinstance(self.outer, Effort):
            sys.setprofile(self.outer)
        if self.left < 0 and (raised[1] is None or raised[1].args == (self,)):
            raise self.error from None


def unless_long(question: Callable[[], T], otherwise: T, most: int = 600_000) -> T:
    """The answer to what need not be known; `otherwise` where that takes more than `most` calls."""
    effort = Effort(most, LimitError("question", most, "is given up"))
    try:
        with effort:
            return question()
    except LimitError as error:
        if error is not effort.error:
            raise
        return otherwise


def limited(source: str, value: object, doing: str, most: int = MOST) -> Effort:
    """Of what somebody waits for: a LimitError names the input, and what took too long."""
    return Effort(most, LimitError(source, value, f"{doing} takes too long"))
