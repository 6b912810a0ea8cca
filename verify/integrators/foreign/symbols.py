"""The functions that a shared library has, and why one that is asked for may be missing."""

import contextlib
import re
import struct
from collections.abc import Iterator
from pathlib import Path

from verify.errors import is_meant, nearest

_DYNAMIC, _CODE = 11, (0, 2, 10)  # a section of dynamic symbols; kinds of symbols that are called
_LISTED = 8


def functions_of(library: str) -> list[str]:
    """Those that an ELF file of 64 bits, the usual one, defines for others; of others none."""
    content = Path(library).read_bytes()
    if content[:6] != b"\x7fELF\x02\x01":
        return []
    with contextlib.suppress(struct.error, ValueError, IndexError):
        return sorted(set(_defined(content)))
    return []


def _defined(content: bytes) -> Iterator[str]:
    begin, size, count = struct.unpack_from("<Q10xHH", content, 40)
    sections = [struct.unpack_from("<IIQQQQI", content, begin + k * size) for k in range(count)]
    for _, kind, _, _, offset, length, link in sections:
        for k in range(offset, offset + length, 24) if kind == _DYNAMIC else ():
            name, info, where = struct.unpack_from("<IBxH", content, k)
            if where and info & 15 in _CODE:
                start = sections[link][4] + name
                yield content[start : content.index(b"\0", start)].decode("ascii", "replace")


def why_missing(symbol: str, names: list[str]) -> str:
    """What to do where a library has these functions and not the one that is asked."""
    part, lower = f"{len(symbol)}{re.escape(symbol)}", re.escape(symbol.lower())
    bound = "declare it bind(c), with n, t and h by value"
    for pattern, language, advice in (
        (rf"_Z{part}.*|_ZN[^E]*(?<!\d){part}(E|17h).*", "C++", 'declare it extern "C"'),
        (rf"{lower}_|__\w+_MOD_{lower}|\w+_mp_{lower}_", "Fortran", bound),
    ):
        if written := next((name for name in names if re.fullmatch(pattern, name)), None):
            return f"it has {written}, which is how {language} writes {symbol}: {advice}"
    near = nearest(symbol, names)
    first = sorted(names, key=lambda name: name != near)[:_LISTED]
    more = f", and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return f"there is no {symbol} in it; {is_meant(near)}it has: {', '.join(first)}{more}"
