"""IEEE double precision, compiled by LLVM where it repays: the arithmetic that is under test.

No fast-math: operations are rounded one by one, as the source writes them. Division by zero and
overflow give infinities and NaN, which the run finds.
"""

import math
import re
from collections.abc import Callable, Mapping
from contextlib import nullcontext, suppress
from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from typing import Any

from verify.arithmetic.number_system import Arithmetic, NumberSystem, interpret
from verify.functions import by_name, in_rings

NAME = "float64"
_REPAID = 50_000  # steps: Python takes some 2 µs each, and llvmlite's import and compilation 0.1 s
_REPAID_SOLVING = 10_000  # steps with a loop in them, which solves equations: 4 … 25 µs


def make(digits: int) -> Arithmetic:
    """Return float64 with its 53 bits, whatever `digits` asks for."""
    return Arithmetic(
        name=NAME,
        bits=53,
        number=nearest_double,
        exact=Fraction,
        finite=math.isfinite,
        context=nullcontext,
        functions={
            **{f: getattr(math, f) for f in in_rings()},
            "sqrt": math.sqrt,
            "root": _root,
            "pi": math.pi,
        },
        compile=_compile,
        guard=None,
        pipelined=True,
        chunk=1 << 22,
    )


def compiled_at_once(*, anew: bool = False) -> Arithmetic:
    """Return the same number system, each kernel compiled at its first call: for timing it.

    `anew`: not from what is kept on disk, if LLVM compiles it.
    """
    return replace(make(17), compile=partial(_compile_now, anew=anew))


NUMBER_SYSTEM = NumberSystem(
    NAME,
    make,
    "the processor’s double precision, 53 bits, which is what is under test",
    cost=1,
    digits=17,
)


def nearest_double(value: Fraction) -> float:
    """Return the nearest float64; infinite beyond their range, where a run then ends."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def _compile(source: str, name: str, namespace: Mapping[str, Any]) -> Callable[..., Any]:
    """Return the kernel, compiled once it has so many steps to do that it repays.

    Until then Python does them, with the same bits, as its operators and functions are those of
    IEEE and of the same C library. What Python refuses, as 1/0, is done again with functions that
    give infinities and NaN; what is refused even so is left to the compiled one.
    """
    in_python = _in_python(source, name, namespace)
    compiled: Callable[..., Any] | None = None
    repaid = _REPAID if source.count("for ") < 2 else _REPAID_SOLVING
    done = 0

    def kernel(first: Any, *arguments: Any) -> Any:
        nonlocal compiled, done
        steps = first if isinstance(first, int) else 1  # a function that is no kernel has none
        if compiled is None and done + steps <= repaid:
            with suppress(ArithmeticError, ValueError):
                result = in_python(first, *arguments)
                done += steps
                return result
        if compiled is None:
            compiled = _compile_now(source, name, namespace)
        return compiled(first, *arguments)

    return kernel


def _in_python(source: str, name: str, namespace: Mapping[str, Any]) -> Callable[..., Any]:
    """Return the kernel in Python; what that refuses, as 1/0, is done again with functions that
    give infinities and NaN, as IEEE and a compiled one do.

    A compiled kernel stays in memory for good, and orbits that escape are no rarity.
    """
    plain = interpret(source, name, namespace)

    @cache
    def permissive() -> Callable[..., Any]:
        functions = {f: _ieee(f) for f in by_name() if f in namespace}
        divided = _DIVISION.sub(r"over(\1, \2)", source)
        return interpret(divided, name, {**namespace, **functions, **_OVER})

    def kernel(*arguments: Any) -> Any:
        try:
            return plain(*arguments)
        except (ArithmeticError, ValueError):
            return permissive()(*arguments)

    return kernel


def _compile_now(
    source: str, name: str, namespace: Mapping[str, Any], *, anew: bool = False
) -> Callable[..., Any]:
    """Compile by LLVM if there is a loop over steps; otherwise a call takes longer than in
    Python."""
    if "for k in range(steps)" in source:
        from verify.arithmetic.compiled.doubles import one_point

        with suppress(NotImplementedError):  # a function that is not in its language
            return one_point(source, namespace, anew=anew)
    return _in_python(source, name, namespace)


def _ieee(name: str) -> Callable[[float], float]:
    """Return the function; where Python's own refuses, with the infinity or NaN that IEEE has
    there."""
    function: Callable[[float], float] = getattr(math, name)
    pair = by_name()[name].pair
    odd = pair is not None and name == pair.odd

    def call(x: float) -> float:
        try:
            return function(x)
        except OverflowError:
            return math.copysign(math.inf, x) if odd else math.inf
        except ValueError:
            return math.nan if x else -math.inf  # at 0 only log is refused

    return call


def _over(x: float, y: float) -> float:
    if y:
        return x / y
    return math.copysign(math.inf, x) * math.copysign(1.0, y) if x and x == x else math.nan


_DIVISION = re.compile(r"([\w.]+|\([^()]*\)) / ([\w.]+|\([^()]*\))")
_OVER = {"over": _over}


def _root(x: float, n: int) -> float:
    # 1/n is rounded, which x ** (1/n) magnifies by log x; one Newton step takes that away.
    if x < 0.0:
        return math.nan  # Python's power would be complex
    root: float = x ** (1.0 / n)
    return root - (root**n - x) / (n * root ** (n - 1)) if root > 0 else root
