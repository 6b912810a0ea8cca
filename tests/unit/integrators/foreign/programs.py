"""Programs that answer lines, or do not, as short sources that the tests run."""

import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from verify.integrators.foreign.foreign_function import (
    ForeignFunction,
    step_of_command,
    step_of_library,
)
from verify.integrators.user_code.step import StepError
from verify.integrators.user_code.user_map import DOUBLE, NumberType

ANSWER = "t, h, p, q = map(float, line.split())\n    print(p - h * q, q + h * p, flush=True)"
IN_STEP = f"import sys\nfor line in sys.stdin:\n    {ANSWER}\n"
HERE = (0.5, 0.25, 0.0, 0.125)  # p, q, t, h
THERE = (0.46875, 0.3125)


def python(source: str, *arguments: str) -> str:
    return shlex.join([sys.executable, "-c", source, *arguments])


@contextmanager
def program(source: str, *arguments: str) -> Iterator[ForeignFunction]:
    """The function of a program in Python, ended after its use."""
    with command(python(source, *arguments)) as function:
        yield function


@contextmanager
def command(text: str) -> Iterator[ForeignFunction]:
    yield from _ended(step_of_command(text, DOUBLE, 60).function)


@contextmanager
def library_step(target: str, degrees: int, kind: NumberType = DOUBLE) -> Iterator[ForeignFunction]:
    yield from _ended(step_of_library(target, degrees, kind, 60).function)


def _ended(function: Any) -> Iterator[ForeignFunction]:
    try:
        yield function
    finally:
        function.program.close()


def said(result: object) -> str:
    """What is said where no state came back."""
    assert isinstance(result, StepError), result
    return str(result.clause)
