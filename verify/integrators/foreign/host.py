"""A host that calls the step of a shared library: a script that imports nothing of this package.

    python host.py LIBRARY SYMBOL TYPE N

For each call it reads a line, the bytes of t, h, p1 … pn, q1 … qn in memory as hexadecimal digits,
and prints the bytes of p and q after the step in the same way. Without imports of this package it
starts at once. The step is

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

_MAX_NUMBER_BYTES = 16  # of a long double and a __float128, whose address C wants at a multiple


def _loading_mode() -> int:
    """Return the mode in which the library's own functions have precedence over those of glibc.

    glibc has an old function `step`, which a call in the library would reach otherwise. macOS and
    musl have no such mode, and a loaded sanitizer ends a program that requests it.
    """
    loaded = ctypes.CDLL(None)
    sanitized = hasattr(loaded, "__sanitizer_print_stack_trace")
    return ctypes.DEFAULT_MODE if sanitized else getattr(os, "RTLD_DEEPBIND", ctypes.DEFAULT_MODE)


def load_step(library: str, symbol: str, name: str, n: int) -> Callable[[bytes], bytes]:
    """Load the library, and return its step, from the bytes of t, h, p and q to those of p, q."""
    function = ctypes.CDLL(library, _loading_mode())[symbol]
    function.restype = None
    number_size = 8 if name == "double" else _MAX_NUMBER_BYTES
    size = (2 + 2 * n) * number_size
    memory = ctypes.create_string_buffer(size + _MAX_NUMBER_BYTES)
    # The address is rounded up to a multiple of 16.
    begin = ctypes.addressof(memory) + -ctypes.addressof(memory) % _MAX_NUMBER_BYTES
    addresses = begin, begin + number_size, begin + 2 * number_size, begin + (2 + n) * number_size
    by_value = {"double": ctypes.c_double, "long-double": ctypes.c_longdouble}.get(name)
    value_at = (by_value or ctypes.c_char).from_address
    t, h = (value_at(x) if by_value else ctypes.c_void_p(x) for x in addresses[:2])
    skipped = addresses[2] - ctypes.addressof(memory)
    # The view keeps the memory alive.
    results = memoryview(memory)[skipped : skipped + 2 * n * number_size]
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
        call = load_step(library, symbol, name, int(n))
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
