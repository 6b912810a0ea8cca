"""The arguments and results of kernels, their layout in memory, and the translation of a source."""

import json
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import accumulate, count
from typing import Any

from verify import code_cache
from verify.arithmetic.compiled import native
from verify.arithmetic.wide.size import WORD, sizes_of, words_of
from verify.arithmetic.wide.translator import Target, Translator


class Fixed:
    """The number raw / 2^fraction, an argument or a result of a kernel."""

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


_DOUBLE = struct.Struct("<d")

Word = Fixed | float | int  # the kind of the argument, or of the result, decides which


@dataclass(frozen=True)
class Layout:
    """The layout of a function's arguments and results in memory: 64-bit words, one after another.

    One more word follows the results: it is 0 if a function had no value.
    """

    fraction: int
    arguments: tuple[str, ...]  # their kinds (see `verify.arithmetic.wide.translator`)
    results: tuple[str, ...]
    returns_tuple: bool

    @cached_property
    def _sizes(self) -> dict[str, int]:
        return sizes_of(self.fraction)

    def _bits_of(self, kind: str) -> int:
        return self._sizes.get(kind, WORD)

    @cached_property
    def result_sizes(self) -> tuple[int, ...]:
        return tuple(8 * words_of(self._bits_of(kind)) for kind in self.results)

    @cached_property
    def result_at(self) -> tuple[int, ...]:
        """The byte offsets at which results begin, and at which the last one ends."""
        return (0, *accumulate(self.result_sizes))

    @cached_property
    def pieces(self) -> struct.Struct:
        """The struct that splits the results into doubles and into the bytes of all other
        numbers."""
        kinds = zip(self.results, self.result_sizes, strict=True)
        return struct.Struct("<" + "".join("d" if k == "float" else f"{n}s" for k, n in kinds))

    def pack(self, arguments: Sequence[Word]) -> bytes:
        """Pack the first arguments, or all. Raises OverflowError if one is outside the format."""
        return b"".join(map(self._pack_word, arguments, self.arguments))

    def pack_state(self, state: Sequence[Word]) -> bytes:
        """Pack what a kernel carries, its last arguments."""
        return b"".join(map(self._pack_word, state, self.arguments[-len(state) :]))

    def _pack_word(self, value: Any, kind: str) -> bytes:
        if kind == "float":
            return _DOUBLE.pack(value)
        raw, bits = int(value if kind == "int" else value.raw), self._bits_of(kind)
        # Two's complement: the range is not symmetric.
        if not -1 << bits - 1 <= raw < 1 << bits - 1:
            raise OverflowError(f"{raw} has more than {bits} bits")
        return raw.to_bytes(8 * words_of(bits), "little", signed=True)

    def unpack(self, raw: bytes) -> object:
        """Return the results. Raises ValueError if a function had no value outside a loop."""
        if not raw[self.result_at[-1]]:
            raise ValueError("a function has no value there")
        values = tuple(map(self.result, self.pieces.unpack_from(raw), count()))
        return values if self.returns_tuple else values[0]

    def result(self, piece: float | bytes, index: int) -> Word:
        """Return one of the results, from its piece."""
        if isinstance(piece, float):
            return piece
        number = int.from_bytes(piece, "little", signed=True)
        return number if self.results[index] == "int" else Fixed(number, self.fraction)


@dataclass(frozen=True)
class Translation:
    """A function's layout and its machine code.

    `code` compiles. It is called only for a function that is run, since LLVM takes most of the
    time.
    """

    layout: Layout
    code: Callable[[], bytes]

    def to_bytes(self) -> bytes:
        """Return the form that is cached on disk: a line of JSON, then the object file."""
        layout = self.layout
        kinds = [layout.fraction, layout.arguments, layout.results, layout.returns_tuple]
        return json.dumps(kinds).encode() + b"\n" + self.code()

    @classmethod
    def from_bytes(cls, raw: bytes) -> "Translation":
        """Read what `to_bytes` wrote."""
        head, _, code = raw.partition(b"\n")
        fraction, arguments, results, returns_tuple = json.loads(head)
        layout = Layout(fraction, tuple(arguments), tuple(results), returns_tuple)
        return cls(layout, lambda: code)


@dataclass(frozen=True)
class Source:
    """A function to be compiled: its text, its format, the values of the names in it, and the
    target."""

    text: str
    fraction: int
    names: tuple[tuple[str, Any], ...]
    target: str = "one orbit"
    make: Callable[[int], Target] | None = None  # fraction bits → target; None for one orbit

    @property
    def key(self) -> str:
        """The key under which its machine code is cached."""
        form = f"{self.fraction} {self.target}"
        return code_cache.key_of(native.versions(), self.text, form, repr(self.names))

    @property
    def is_cached(self) -> bool:
        """True if its machine code is cached."""
        return code_cache.load(self.key) is not None

    def translation(self) -> Translation:
        """Translate the source, whether or not its code is cached."""
        if self.make is None:
            from verify.arithmetic.wide.one_orbit import OneOrbit

            target: Target = OneOrbit(self.fraction)
        else:
            target = self.make(self.fraction)
        translator = Translator(self.text, dict(self.names), target)
        module = translator.translate()
        kinds = tuple(kind for _, kind in translator.arguments)
        results = tuple(translator.results)
        layout = Layout(self.fraction, kinds, results, translator.returns_tuple)
        return Translation(layout, cache(lambda: native.machine_code(module)))

    def compile(self, *, anew: bool = False) -> tuple[Layout, Callable[[], native.Native]]:
        """Return the layout, and a function that links the code.

        At the first call of that function the code is loaded from the cache, or compiled and
        cached. `anew`: it is compiled, and not cached.
        """
        cached = None if anew else code_cache.load(self.key)
        translation = self.translation() if cached is None else Translation.from_bytes(cached)

        # Most kernels are built to be examined and never run. So linking waits for the first call,
        # and the code is written to the cache only then.
        @cache
        def function() -> native.Native:
            linked = native.link(translation.code())
            if cached is None and not anew:
                code_cache.keep(self.key, translation.to_bytes())
            return linked

        return translation.layout, function
