"""A step of a shared library or of a program, called from Python.

The module also lists the functions of a shared library, and explains why a requested one may be
missing.
"""

import atexit
import contextlib
import re
import shlex
import shutil
import struct
import sys
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

from verify.errors import InputError
from verify.hamiltonians.coordinates import coordinates_in
from verify.integrators.foreign import host
from verify.integrators.foreign.lines import (
    format_line,
    format_memory,
    parse_line,
    parse_memory,
    short_line,
)
from verify.integrators.foreign.process import ForeignProgram
from verify.integrators.user_code.layout import CallLayout
from verify.integrators.user_code.loading import list_functions
from verify.integrators.user_code.step import StepError, Theirs
from verify.integrators.user_code.user_map import DOUBLE_DOUBLE, FLOAT128, NumberType, UserMap

# ELF: the type of a section of dynamic symbols, and the types of symbols that can be functions
# (STT_NOTYPE, STT_FUNC, STT_GNU_IFUNC).
_DYNAMIC_SYMBOLS, _FUNCTION_TYPES = 11, (0, 2, 10)


def functions_of(library: str) -> list[str]:
    """List the functions that an ELF file of 64 bits exports; none for other files."""
    content = Path(library).read_bytes()
    # ELF of 64 bits, with the low byte first: the layout that the offsets below belong to.
    if content[:6] != b"\x7fELF\x02\x01":
        return []
    with contextlib.suppress(struct.error, ValueError, IndexError):
        return sorted(set(_read_symbols(content)))
    return []


def _read_symbols(content: bytes) -> Iterator[str]:
    # The header has the offset of the table of sections at byte 40, the size of an entry at byte 58
    # and their number at byte 60.
    begin, size, count = struct.unpack_from("<Q10xHH", content, 40)
    sections = [struct.unpack_from("<IIQQQQI", content, begin + k * size) for k in range(count)]
    for _, section_type, _, _, offset, length, link in sections:
        for k in range(offset, offset + length, 24) if section_type == _DYNAMIC_SYMBOLS else ():
            # A symbol has 24 bytes, which begin with st_name, st_info, st_other and st_shndx.
            # Section 0 means that another library defines it.
            name, info, section = struct.unpack_from("<IBxH", content, k)
            if section and info & 15 in _FUNCTION_TYPES:
                start = sections[link][4] + name
                yield content[start : content.index(b"\0", start)].decode("ascii", "replace")


def explain_missing(symbol: str, names: list[str]) -> str:
    """Explain what to do if a library has these functions, but not the requested one."""
    part, lower = f"{len(symbol)}{re.escape(symbol)}", re.escape(symbol.lower())
    bound = "declare it bind(c), with n, t and h by value"
    for pattern, language, advice in (
        (rf"_Z{part}.*|_ZN[^E]*(?<!\d){part}(E|17h).*", "C++", 'declare it extern "C"'),
        (rf"{lower}_|__\w+_MOD_{lower}|\w+_mp_{lower}_", "Fortran", bound),
    ):
        if exported := next((name for name in names if re.fullmatch(pattern, name)), None):
            return f"it has {exported}, which is how {language} writes {symbol}: {advice}"
    return f"there is no {symbol} in it; {list_functions(names, symbol)}"


_ORDER = ("p", "q", "t", "h")
Real: TypeAlias = float | Fraction
Arguments: TypeAlias = tuple[Theirs, Theirs, Real, Real]  # p, q, t, h
Write: TypeAlias = Callable[[Sequence[Real], NumberType], str]
Read: TypeAlias = Callable[[str, int, NumberType], Sequence[Real]]
LIBRARIES = (".so", ".dylib", ".dll")


class ForeignFunction:
    """A function (p, q, t, h) → (p', q') that a program computes.

    p and q are numbers or sequences of n numbers. The results are floats if p has floats, and
    fractions otherwise. `write` and `read`: format and parse the lines of the program.
    """

    def __init__(
        self,
        program: ForeignProgram,
        number_type: NumberType,
        write: Write = format_line,
        read: Read = parse_line,
    ) -> None:
        self.program, self.number_type, self.write, self.read = program, number_type, write, read
        program.begin()
        atexit.register(program.close)

    def another(self) -> "ForeignFunction":
        """Return the same function in a new process, which has seen no earlier call."""
        same = self.program
        program = ForeignProgram(
            same.words, same.display_name, same.seconds, same.greeting, same.advice, same.show_line
        )
        return ForeignFunction(program, self.number_type, self.write, self.read)

    def close(self) -> None:
        """End its process."""
        self.program.close()

    def __call__(self, p: Theirs, q: Theirs, t: Theirs, h: Theirs) -> tuple[Theirs, Theirs]:
        result = self.several([(p, q, t, h)])[0]
        if isinstance(result, StepError):
            raise result
        return result

    def several(self, states: Sequence[Arguments]) -> list[tuple[Theirs, Theirs] | StepError]:
        """Return (p', q') of each (p, q, t, h), or an error in its place.

        One exchange takes a fraction of the time of as many calls.
        """
        lines = [
            self.write([t, h, *(x for z in (p, q) for x in _as_sequence(z))], self.number_type)
            for p, q, t, h in states
        ]
        answers = self.program.answers(lines)
        return [self._read(p, answer) for (p, *_), answer in zip(states, answers, strict=True)]

    def _read(self, p: Theirs, answer: str | StepError) -> tuple[Theirs, Theirs] | StepError:
        """Parse the program's answer to a call with this p."""
        if isinstance(answer, StepError):
            return answer
        several = hasattr(p, "__len__")
        first, *further = _as_sequence(p)
        n = 1 + len(further)
        try:
            numbers = self.read(answer, 2 * n, self.number_type)
        except StepError as error:
            return error
        floats = isinstance(first, float)
        z: list[Theirs] = [float(x) if floats else Fraction(x) for x in numbers]
        return (z[:n], z[n:]) if several else (z[0], z[1])


def _as_sequence(z: Theirs) -> Sequence[Theirs]:
    return z if hasattr(z, "__len__") else [z]


def step_of_command(
    command: str, number_type: NumberType, seconds: float, degrees: int = 1
) -> UserMap:
    """Return the step of the program. Raises InputError if it does not start."""
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise InputError("--command", command, f"is no command: {error}") from None
    if not words:
        raise InputError("--command", command, "is empty; write a program and its arguments")
    if shutil.which(words[0]) is None:
        problem = "there is no such program; write ./NAME for one in this folder"
        raise InputError("--command", words[0], problem)
    program = ForeignProgram(words, command, seconds)
    return _build_step(ForeignFunction(program, number_type), number_type, seconds, degrees)


def is_library(target: str) -> bool:
    """Return True if the target is written as LIB.so:SYMBOL, and not as MODULE:FUNCTION."""
    place, _, _ = target.rpartition(":")
    name = Path(place or target).name
    return Path(place or target).suffix in LIBRARIES or ".so." in name


def step_of_library(target: str, degrees: int, number_type: NumberType, seconds: float) -> UserMap:
    """Return the step of LIB.so:SYMBOL. Raises InputError if it does not load."""
    place, _, symbol = target.rpartition(":")
    if not place or not symbol.isidentifier():
        raise InputError("integrator", target, "write it as LIB.so:SYMBOL")
    if not Path(place).is_file():
        raise InputError("integrator", target, f"there is no file {place}")
    expected = f"; wanted: {prototype(symbol, number_type)}"
    names = functions_of(place)
    # Without this check the loader might take a symbol of that name from another library, as C's.
    if names and symbol not in names:
        raise InputError("integrator", target, explain_missing(symbol, names) + expected)
    library_path = str(Path(place).resolve())
    script = str(Path(host.__file__).resolve())
    words = [
        sys.executable,
        "-I",
        "-S",
        script,
        library_path,
        symbol,
        number_type.name,
        str(degrees),
    ]

    def show_line(line: str) -> str:
        with contextlib.suppress(ValueError):  # the greeting has no numbers
            return short_line(
                format_line(parse_memory(line, 2 + 2 * degrees, number_type), number_type)
            )
        return line

    program = ForeignProgram(words, target, seconds, "ready", expected, show_line)
    return _build_step(
        ForeignFunction(program, number_type, format_memory, parse_memory),
        number_type,
        seconds,
        degrees,
    )


def prototype(symbol: str, number_type: NumberType) -> str:
    """Return the C declaration of a step in numbers of this type."""
    real = number_type.declared
    argument = f"const {real} *" if number_type in (FLOAT128, DOUBLE_DOUBLE) else f"{real} "
    return f"void {symbol}(int n, {argument}t, {argument}h, {real} *p, {real} *q)"


def _build_step(
    function: ForeignFunction, number_type: NumberType, seconds: float, degrees: int
) -> UserMap:
    layout = CallLayout(
        _ORDER,
        shape=() if degrees == 1 else (degrees,),
        kind="list" if degrees > 1 else "array",
    )
    return UserMap(
        function, layout, coordinates_in(degrees), limit=seconds, numbers=number_type, foreign=True
    )
