"""Kernels in fixed point as native functions, those that were compiled before from disk."""

import ctypes
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from operator import itemgetter
from typing import Any

from verify import code_cache
from verify.arithmetic.wide import native

Names = tuple[tuple[str, Any], ...]


class Fixed:
    """raw / 2^fraction, a number that kernels take and give."""

    __slots__ = ("fraction", "raw")

    def __init__(self, raw: int, fraction: int) -> None:
        self.raw, self.fraction = raw, fraction

    def __repr__(self) -> str:
        return f"Fixed({self.raw}, {self.fraction})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fixed) and (self.raw, self.fraction) == (other.raw, other.fraction)

    def __hash__(self) -> int:
        return hash((self.raw, self.fraction))

    def __neg__(self) -> "Fixed":
        return Fixed(-self.raw, self.fraction)

    def __lt__(self, other: "Fixed") -> bool:
        return self.raw < other.raw

    def __gt__(self, other: "Fixed") -> bool:
        return self.raw > other.raw


Word = Fixed | float | int  # by the kind of an argument, or of a result


def compiled(
    source: str, width: int, fraction: int, names: Mapping[str, Any]
) -> Callable[..., object]:
    """The function that the source defines (see `verify.arithmetic.wide.translate`).

    It is compiled once, and linked when it is first called, since not every kernel that is made is
    run. It takes and gives `Fixed`, int and float. Raises OverflowError where an argument is
    outside the format, and ValueError where a function had no value outside a loop.
    """
    return _compiled(source, width, fraction, tuple(sorted(names.items(), key=itemgetter(0))))


@lru_cache(maxsize=256)
def _compiled(source: str, width: int, fraction: int, names: Names) -> Callable[..., object]:
    key = code_cache.key_of(native.versions(), source, f"{width} {fraction}", repr(names))
    kept = code_cache.load(key)
    if kept is not None:
        return callable_of(Translation.read(kept), width, fraction)

    def keep(translation: Translation) -> None:
        code_cache.keep(key, translation.written())

    return callable_of(translated(source, width, fraction, names), width, fraction, keep)


@dataclass(frozen=True)
class Translation:
    """What a source became: the kinds of what it takes and gives, and its machine code.

    `code` is called once, and only for a kernel that is run: most of the time is LLVM's.
    """

    arguments: tuple[str, ...]
    results: tuple[str, ...]
    returns_tuple: bool
    code: Callable[[], bytes]

    def written(self) -> bytes:
        """As it is kept: a line of JSON, then the object file."""
        kinds = [self.arguments, self.results, self.returns_tuple]
        return json.dumps(kinds).encode() + b"\n" + self.code()

    @classmethod
    def read(cls, raw: bytes) -> "Translation":
        """What `written` wrote."""
        head, _, code = raw.partition(b"\n")
        arguments, results, returns_tuple = json.loads(head)
        return cls(tuple(arguments), tuple(results), returns_tuple, lambda: code)


def translated(source: str, width: int, fraction: int, names: Names) -> Translation:
    """The source's translation, made now and from nothing that is kept."""
    from verify.arithmetic.wide.translate import Translator

    translator = Translator(source, width, fraction, dict(names))
    module = translator.translate()
    kinds = tuple(kind for _, kind in translator.arguments)
    code = cache(lambda: native.machine_code(module))
    return Translation(kinds, tuple(translator.results), translator.returns_tuple, code)


def callable_of(
    translation: Translation,
    width: int,
    fraction: int,
    keep: Callable[[Translation], None] = lambda _: None,
) -> Callable[..., object]:
    """The function that was translated; `keep` gets it once it is compiled, at the first call."""
    sizes = {"wide": width // 64, "sum": width // 64 + 1, "float": 1, "int": 1}
    kinds = translation.arguments
    room = 8 * (sum(sizes[kind] for kind in translation.results) + 1)

    @cache
    def function() -> native.Native:
        made = native.linked(translation.code())
        keep(translation)
        return made

    def call(*arguments: Word) -> object:
        given = b"".join(map(_packed, arguments, kinds, (sizes[k] for k in kinds)))
        result = ctypes.create_string_buffer(room)
        function()(given, result)
        values, at = [], 0
        for kind in translation.results:
            words = result.raw[at : at + 8 * sizes[kind]]
            values.append(_unpacked(words, kind, fraction))
            at += 8 * sizes[kind]
        if not result.raw[at]:
            raise ValueError("a function has no value there")
        return tuple(values) if translation.returns_tuple else values[0]

    return call


def _packed(value: Any, kind: str, size: int) -> bytes:
    if kind == "float":
        return bytes(ctypes.c_double(value))
    raw = value if kind == "int" else value.raw
    return int(raw).to_bytes(8 * size, "little", signed=True)  # OverflowError beyond the format


def _unpacked(words: bytes, kind: str, fraction: int) -> Word:
    if kind == "float":
        return ctypes.c_double.from_buffer_copy(words).value
    number = int.from_bytes(words, "little", signed=True)
    return number if kind == "int" else Fixed(number, fraction)
