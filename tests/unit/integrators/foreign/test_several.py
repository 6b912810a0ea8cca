"""Many states in one round trip: the same answers as one by one."""

import time
from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.programs.compilers import library
from tests.unit.integrators.foreign.programs import HERE, IN_STEP, THERE, library_step, program
from verify.integrators.foreign.foreign_function import ForeignFunction
from verify.integrators.user_code.user_map import LONG_DOUBLE

STEP = """
void step(int n, double t, double h, double *p, double *q)
{ for (int i = 0; i < n; i++) { p[i] -= h * q[i] + t; q[i] += h * p[i]; } }
"""
STATES = [(k / 7, 1 - k / 3, k / 2, 0.125) for k in range(2000)]


def one_by_one(function: ForeignFunction) -> list[object]:
    return [function(*state) for state in STATES]


def test_a_librarys_answers_are_those_of_single_calls(tmp_path: Path) -> None:
    with library_step(f"{library(tmp_path, 'step.c', STEP)}:step", 1) as function:
        several = function.several(STATES)
        assert several == one_by_one(function)
        p, q, t, h = STATES[7]
        assert several[7] == (p - (h * q + t), q + h * (p - (h * q + t)))


def test_a_programs_answers_are_those_of_single_calls_however_long_the_lines() -> None:
    """More than a pipe holds, in both directions, each longer than it was asked."""
    long = IN_STEP.replace("p - h * q,", "f'{p - h * q:+.300f}'[:180],")
    with program(long) as function:
        assert function.several(STATES) == one_by_one(function)


@pytest.mark.parametrize(
    "source",
    [
        # It takes what has come for one line, as read(2) with a large buffer does.
        "import os\nwhile line := os.read(0, 4096).decode().split('\\n')[0]:\n"
        "    t, h, p, q = map(float, line.split())\n"
        "    os.write(1, f'{p - h * q!r} {q + h * p!r}\\n'.encode())\n",
        IN_STEP.replace("for line in sys.stdin", "while line := sys.stdin.readline()"),
    ],
)
def test_a_program_that_takes_one_line_at_a_time_is_asked_so(source: str) -> None:
    with program(source) as function:
        assert function.several(STATES[:50]) == [function(*state) for state in STATES[:50]]
        assert function.several([HERE]) == [THERE]


def test_a_program_that_keeps_a_state_is_asked_one_by_one() -> None:
    """Its answers stay those to the lines in their order."""
    source = "n = 0\n" + IN_STEP.replace("    print(p - h * q", "    n += 1\n    print(n")
    with program(source) as function:
        counts = [x[0] for x in function.several([HERE] * 9) if isinstance(x, tuple)]
        assert len(counts) == 9
        assert counts == sorted(counts)


def test_lists_and_fractions_come_back_as_they_went(tmp_path: Path) -> None:
    path = library(tmp_path, "step.c", STEP)
    with library_step(f"{path}:step", 2) as function:
        assert function.several([([1.0, 0.0], [0.0, 1.0], 0.0, 0.5)]) == [
            ([1.0, -0.5], [0.5, 0.75])
        ]
    half = Fraction(1, 2)
    with library_step(f"{path}:step", 1) as function:
        p, q = function(Fraction(1), half, Fraction(0), half)
        assert (p, q) == (Fraction(3, 4), Fraction(7, 8))
        assert isinstance(p, Fraction)
    longer = STEP.replace("double", "long double")
    with library_step(f"{library(tmp_path, 'long.c', longer)}:step", 1, LONG_DOUBLE) as function:
        tiny = 1 + Fraction(1, 2**60)
        assert function(tiny, Fraction(0), Fraction(0), half) == (tiny, tiny / 2)


def test_a_library_is_called_some_thousand_times_a_second(tmp_path: Path) -> None:
    """40,000 to 80,000 are meant, and 15,000 of a program in C; tests share the processor."""
    state = ([0.5] * 6, [0.25] * 6, 0.0, 0.125)
    with library_step(f"{library(tmp_path, 'step.c', STEP)}:step", 6) as function:
        begun = time.monotonic()
        assert len(function.several([state] * 10_000)) == 10_000
        assert time.monotonic() - begun < 3
