"""Calls a step of a shared library for lines of numbers: run as a program of its own, without us.

    python host.py LIBRARY SYMBOL TYPE N

It reads `t h p1 … pn q1 … qn` in hexadecimal floats, or whatever `Fraction` reads, and prints what
the step leaves in p and q, in the same way. Nothing of this package is imported, so that it starts
at once. The step is

    double         void step(int n, double t, double h, double *p, double *q)
    long-double    void step(int n, long double t, long double h, long double *p, long double *q)
    float128       void step(int n, const __float128 *t, const __float128 *h,
                             __float128 *p, __float128 *q)
    double-double  void step(int n, const double *t, const double *h, double *p, double *q)

where a double-double is two doubles, the high one first, so that p and q hold 2 n of them.
"""

import ctypes
import os
import sys
from collections.abc import Callable
from fractions import Fraction

_PADDED = 16  # bytes of a long double, and of a __float128


def _of_parts(sign: int, exponent: int, significand: int, bits: int, kept: int) -> bytes:
    """A number of 16 bytes: `bits` of significand, of which `kept` are written, 15 of exponent."""
    whole = significand & ((1 << kept) - 1)
    return (whole | (exponent | sign << 15) << kept).to_bytes(_PADDED, "little")


def packed(x: Fraction, bits: int, kept: int) -> bytes:
    """x, which is a number of that many bits, as bytes; 0 where it is too small."""
    if x == 0:
        return bytes(_PADDED)
    size, sign = abs(x), int(x < 0)
    power = size.numerator.bit_length() - size.denominator.bit_length()
    if size < Fraction(2) ** power:
        power -= 1
    significand = size / Fraction(2) ** (power - bits + 1)
    whole = round(significand)
    if whole >> bits:
        whole, power = whole >> 1, power + 1
    return _of_parts(sign, power + 16383, whole, bits, kept)


def unpacked(raw: bytes, bits: int, kept: int) -> str:
    """The number as a hexadecimal float, or what it is that is no number."""
    whole = int.from_bytes(raw, "little")
    significand, top = whole & ((1 << kept) - 1), whole >> kept & 0xFFFF
    sign, exponent = "-" if top >> 15 else "", top & 0x7FFF
    if exponent == 0x7FFF:
        return "nan" if significand & ((1 << (bits - 1)) - 1) else f"{sign}inf"
    if exponent and kept < bits:
        significand |= 1 << kept
    power = (exponent or 1) - 16383 - bits + 1
    return f"{sign}0x{significand:x}p{power}"


class Numbers:
    """So many numbers of one type in memory, as aligned as C wants them."""

    def __init__(self, count: int, each: int) -> None:
        self.size = count * each
        self._whole = ctypes.create_string_buffer(self.size + _PADDED)
        begin = ctypes.addressof(self._whole)
        self.address = begin + -begin % _PADDED

    @property
    def raw(self) -> bytes:
        """What they are now."""
        return ctypes.string_at(self.address, self.size)

    @raw.setter
    def raw(self, content: bytes) -> None:
        ctypes.memmove(self.address, content, self.size)

    @property
    def pointer(self) -> ctypes.c_void_p:
        """To the first one."""
        return ctypes.c_void_p(self.address)


class Buffers:
    """What a step is given: p and q in memory, t and h beside them."""

    def __init__(self, name: str, n: int) -> None:
        self.name, self.n = name, n
        self.bits, self.kept = (64, 64) if name == "long-double" else (113, 112)
        each = {"double": 8, "double-double": 16}.get(name, _PADDED)
        self.each = each
        self.p, self.q = Numbers(n, each), Numbers(n, each)
        self.t, self.h = Numbers(1, each), Numbers(1, each)

    def bytes_of(self, word: str) -> bytes:
        """One number, of a double-double both parts, joined by a comma."""
        if self.name in ("double", "double-double"):
            return b"".join(bytes(ctypes.c_double(float.fromhex(x))) for x in word.split(","))
        x = _exact(word)
        return packed(x, self.bits, self.kept)

    def text_of(self, raw: bytes) -> str:
        """The same backwards."""
        if self.name in ("double", "double-double"):
            doubles = (
                ctypes.c_double.from_buffer_copy(raw, k).value for k in range(0, len(raw), 8)
            )
            return " ".join(x.hex() if x - x == 0 else repr(x) for x in doubles)
        return unpacked(raw, self.bits, self.kept)

    def fill(self, words: list[str]) -> None:
        """From t, h, p and q."""
        self.t.raw, self.h.raw = self.bytes_of(words[0]), self.bytes_of(words[1])
        self.p.raw = b"".join(map(self.bytes_of, words[2 : 2 + self.n]))
        self.q.raw = b"".join(map(self.bytes_of, words[2 + self.n :]))

    def line(self) -> str:
        """What p and q are now."""
        raw, each = self.p.raw + self.q.raw, self.each
        return " ".join(self.text_of(raw[k : k + each]) for k in range(0, len(raw), each))


def _exact(word: str) -> Fraction:
    """A hexadecimal float of any length."""
    sign, _, rest = word.rpartition("0x")
    digits, _, power = rest.partition("p")
    size = int(digits, 16) * Fraction(2) ** int(power)
    return -size if sign == "-" else size


def _own_names_first() -> int:
    """How to load: so that a call in the library reaches its own `step`, not glibc's old one.

    macOS and musl have no such mode. A sanitizer, loaded before us, ends what asks for it.
    """
    loaded = ctypes.CDLL(None)
    sanitized = hasattr(loaded, "__sanitizer_print_stack_trace")
    return ctypes.DEFAULT_MODE if sanitized else getattr(os, "RTLD_DEEPBIND", ctypes.DEFAULT_MODE)


def stepper(library: str, symbol: str, name: str) -> Callable[[Buffers], None]:
    """Loads the library, and calls its step with buffers."""
    function = ctypes.CDLL(library, _own_names_first())[symbol]
    function.restype = None

    by_value = {"double": ctypes.c_double, "long-double": ctypes.c_longdouble}.get(name)

    def call(own: Buffers) -> None:
        n, p, q = ctypes.c_int(own.n), own.p.pointer, own.q.pointer
        if by_value is None:
            function(n, own.t.pointer, own.h.pointer, p, q)
        else:
            t, h = (by_value.from_address(x.address) for x in (own.t, own.h))
            function(n, t, h, p, q)

    return call


def main() -> None:
    """Until its input ends."""
    library, symbol, name, n = sys.argv[1:5]
    own, call = Buffers(name, int(n)), stepper(library, symbol, name)
    # What the library itself prints goes to standard error.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    answers.write("ready\n")
    answers.flush()
    for line in sys.stdin:
        own.fill(line.split())
        call(own)
        answers.write(own.line() + "\n")
        answers.flush()


if __name__ == "__main__":
    main()
