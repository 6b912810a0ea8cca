"""A host that calls a shared library's step for lines of numbers: a program of its own, without us.

    python host.py LIBRARY SYMBOL TYPE N

It reads t, h, p1 … pn, q1 … qn as they lie in memory, in hexadecimal digits, a line a call, and
prints what the step leaves in p and q, in the same way. Nothing of this package is imported, so
that it starts at once. The step is

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

_LARGEST = 16  # bytes of a number, but for a double's 8; C wants it at a multiple of that


def _own_names_first() -> int:
    """Return the mode of loading in which a call in the library reaches its own `step`, not glibc's
    old one.

    macOS and musl have no such mode. A sanitizer, loaded before us, ends a program that requests
    it.
    """
    loaded = ctypes.CDLL(None)
    sanitized = hasattr(loaded, "__sanitizer_print_stack_trace")
    return ctypes.DEFAULT_MODE if sanitized else getattr(os, "RTLD_DEEPBIND", ctypes.DEFAULT_MODE)


def stepper(library: str, symbol: str, name: str, n: int) -> Callable[[bytes], bytes]:
    """Load the library; return its step of t, h, p and q as they lie in memory, to p and q."""
    function = ctypes.CDLL(library, _own_names_first())[symbol]
    function.restype = None
    number_size = 8 if name == "double" else _LARGEST
    size = (2 + 2 * n) * number_size
    memory = ctypes.create_string_buffer(size + _LARGEST)
    # The address is rounded up to a multiple of 16, which C requires of a long double and of a
    # __float128.
    begin = ctypes.addressof(memory) + -ctypes.addressof(memory) % _LARGEST
    addresses = begin, begin + number_size, begin + 2 * number_size, begin + (2 + n) * number_size
    by_value = {"double": ctypes.c_double, "long-double": ctypes.c_longdouble}.get(name)
    first = (by_value or ctypes.c_char).from_address
    t, h = (first(x) if by_value else ctypes.c_void_p(x) for x in addresses[:2])
    skipped = addresses[2] - ctypes.addressof(memory)
    results = memoryview(memory)[
        skipped : skipped + 2 * n * number_size
    ]  # it keeps the memory, too
    count, p, q = ctypes.c_int(n), ctypes.c_void_p(addresses[2]), ctypes.c_void_p(addresses[3])

    def call(numbers: bytes) -> bytes:
        ctypes.memmove(begin, numbers, size)
        function(count, t, h, p, q)
        return results.tobytes()

    return call


def main() -> None:
    """Answer lines until the input ends."""
    library, symbol, name, n = sys.argv[1:5]
    try:
        call = stepper(library, symbol, name, int(n))
    except (OSError, AttributeError) as error:
        sys.exit(str(error))
    # What the library itself prints goes to standard error.
    answers = os.dup(1)
    os.dup2(2, 1)
    os.write(answers, b"ready\n")
    for line in sys.stdin:
        os.write(answers, call(bytes.fromhex(line)).hex().encode() + b"\n")


if __name__ == "__main__":
    main()
