"""A step of a library or a program, as it is called from here."""

import atexit
import shlex
import shutil
import sys
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

from verify.errors import InputError
from verify.hamiltonians.coordinates import coordinates_in
from verify.integrators.foreign import host
from verify.integrators.foreign.lines import line_of, numbers_of
from verify.integrators.foreign.process import Program
from verify.integrators.user_code.layout import Layout
from verify.integrators.user_code.number_type import DOUBLE, NumberType
from verify.integrators.user_code.step import Theirs
from verify.integrators.user_code.user_map import UserMap

_FIRST_SECONDS = 20.0  # for the first answer of a program that compiles itself
_ORDER = ("p", "q", "t", "h")
LIBRARIES = (".so", ".dylib", ".dll")


class ForeignFunction:
    """(p, q, t, h) → p', q', of numbers or sequences of n: floats for floats, else fractions."""

    def __init__(self, program: Program, kind: NumberType) -> None:
        self.program, self.kind = program, kind
        program.begin()
        atexit.register(program.close)

    def __call__(self, p: Theirs, q: Theirs, t: Theirs, h: Theirs) -> tuple[Theirs, Theirs]:
        several = hasattr(p, "__len__")
        z = [*p, *q] if several else [p, q]
        floats = isinstance(z[0], float)
        numbers = [Fraction(x) for x in (t, h, *z)]
        found: list[Theirs] = self.answer(numbers)
        if floats:
            found = [float(x) for x in found]
        n = len(z) // 2
        return (found[:n], found[n:]) if several else (found[0], found[1])

    def answer(self, numbers: Sequence[Fraction]) -> list[Fraction]:
        """Of t, h, p and q. Raises StepError for what is done instead."""
        line = self.program.ask(self.asked(numbers), " ".join(f"{float(x):g}" for x in numbers))
        return numbers_of(line, len(numbers) - 2, self.kind)

    def asked(self, numbers: Sequence[Fraction]) -> str:
        """The line for these numbers."""
        return line_of(numbers, self.kind)


class LibraryFunction(ForeignFunction):
    """The same by our own host, which takes hexadecimal floats of any type."""

    def asked(self, numbers: Sequence[Fraction]) -> str:
        """The line for these numbers."""
        return " ".join(_hexadecimal(x, self.kind) for x in numbers)


def _hexadecimal(x: Fraction, kind: NumberType) -> str:
    if kind.parts > 1:
        high = float(x)
        return f"{high.hex()},{float(x - Fraction(high)).hex()}"
    if kind is DOUBLE:
        return float(x).hex()
    power = x.denominator.bit_length() - 1  # it is a binary fraction
    return f"{'-' if x < 0 else ''}0x{abs(x.numerator):x}p{-power}"


def of_command(command: str, kind: NumberType, seconds: float, degrees: int = 1) -> UserMap:
    """The program's step. Raises InputError where it does not start."""
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise InputError("--command", command, f"is no command: {error}") from None
    if not words:
        raise InputError("--command", command, "is empty; write a program and its arguments")
    if shutil.which(words[0]) is None:
        problem = "there is no such program; write ./NAME for one in this folder"
        raise InputError("--command", words[0], problem)
    program = Program(words, command, seconds, _FIRST_SECONDS)
    return _step(ForeignFunction(program, kind), kind, seconds, degrees)


def is_library(target: str) -> bool:
    """Whether LIB.so:SYMBOL is written, and not MODULE:FUNCTION."""
    place, _, _ = target.rpartition(":")
    name = Path(place or target).name
    return Path(place or target).suffix in LIBRARIES or ".so." in name


def of_library(target: str, degrees: int, kind: NumberType, seconds: float) -> UserMap:
    """The step of LIB.so:SYMBOL. Raises InputError where it does not load."""
    place, _, symbol = target.rpartition(":")
    if not place or not symbol.isidentifier():
        raise InputError("integrator", target, "write it as LIB.so:SYMBOL")
    if not Path(place).is_file():
        raise InputError("integrator", target, f"there is no file {place}")
    own = str(Path(place).resolve())
    script = str(Path(host.__file__).resolve())
    words = [sys.executable, "-I", "-S", script, own, symbol, kind.name, str(degrees)]
    program = Program(words, target, seconds, greeting="ready")
    return _step(LibraryFunction(program, kind), kind, seconds, degrees)


def _step(function: ForeignFunction, kind: NumberType, seconds: float, degrees: int) -> UserMap:
    layout = Layout(
        _ORDER, shape=() if degrees == 1 else (degrees,), kind="list" if degrees > 1 else "array"
    )
    return UserMap(
        function, layout, coordinates_in(degrees), left=seconds, numbers=kind, foreign=True
    )
