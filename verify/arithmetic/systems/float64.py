"""IEEE double precision, compiled by LLVM if a run is long enough: the arithmetic under test.

There is no fast-math: each operation of the source is rounded by itself. Division by zero and
overflow give infinities and NaN, which the run detects.
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
# From so many steps on a kernel is compiled: Python takes some 2 µs for a step, or 4 … 25 µs if a
# loop in it solves equations; the import of llvmlite and the compilation take 0.1 s.
_BREAK_EVEN_STEPS = 50_000
_BREAK_EVEN_STEPS_SOLVING = 10_000


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
    """Return the same arithmetic with kernels that are compiled at once: for timing them.

    `anew`: compile them even if their code is cached on disk.
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
    """Return the nearest float64; an infinity beyond the range of float64, which ends a run."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def _compile(source: str, name: str, namespace: Mapping[str, Any]) -> Callable[..., Any]:
    """Return the kernel; it is compiled once it has made so many steps that compilation repays.

    Until then Python makes the steps, with the same bits: its operators are those of IEEE, and its
    functions those of the same C library. If Python raises, as for 1/0, the steps are made again
    with functions that return infinities and NaN; if these raise too, by the compiled kernel.
    """
    in_python = _in_python(source, name, namespace)
    compiled: Callable[..., Any] | None = None
    repaid = _BREAK_EVEN_STEPS if source.count("for ") < 2 else _BREAK_EVEN_STEPS_SOLVING
    done = 0

    def kernel(first: Any, *arguments: Any) -> Any:
        nonlocal compiled, done
        # The first argument of a kernel is the number of steps; other functions count as one step.
        steps = first if isinstance(first, int) else 1
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
    """Return the kernel in Python. If Python raises, as for 1/0, the call is made again with
    functions that return infinities and NaN, as IEEE and the compiled kernel do.

    It is not compiled for this: compiled code stays in memory until the process ends, and many
    orbits escape.
    """
    plain = interpret(source, name, namespace)

    @cache
    def permissive() -> Callable[..., Any]:
        functions = {f: _ieee(f) for f in by_name() if f in namespace}
        ieee_source = _DIVISION.sub(r"over(\1, \2)", source)
        return interpret(ieee_source, name, {**namespace, **functions, **_OVER})

    def kernel(*arguments: Any) -> Any:
        try:
            return plain(*arguments)
        except (ArithmeticError, ValueError):
            return permissive()(*arguments)

    return kernel


def _compile_now(
    source: str, name: str, namespace: Mapping[str, Any], *, anew: bool = False
) -> Callable[..., Any]:
    """Compile by LLVM if the source has a loop over steps; without one, a call of native code takes
    longer than Python."""
    if "for k in range(steps)" in source:
        from verify.arithmetic.compiled.doubles import one_point

        with suppress(NotImplementedError):  # the source is not in the compiler's language
            return one_point(source, namespace, anew=anew)
    return _in_python(source, name, namespace)


def _ieee(name: str) -> Callable[[float], float]:
    """Return the function with the infinity or NaN of IEEE where Python's function raises."""
    function: Callable[[float], float] = getattr(math, name)
    pair = by_name()[name].pair
    odd = pair is not None and name == pair.odd

    def call(x: float) -> float:
        try:
            return function(x)
        except OverflowError:
            return math.copysign(math.inf, x) if odd else math.inf
        except ValueError:
            return math.nan if x else -math.inf  # at 0 only log raises

    return call


def _over(x: float, y: float) -> float:
    if y:
        return x / y
    return math.copysign(math.inf, x) * math.copysign(1.0, y) if x and x == x else math.nan


_DIVISION = re.compile(r"([\w.]+|\([^()]*\)) / ([\w.]+|\([^()]*\))")
_OVER = {"over": _over}


def _root(x: float, n: int) -> float:
    # 1/n is rounded, which x ** (1/n) magnifies by log x; one Newton step removes that error.
    if x < 0.0:
        return math.nan  # Python's power would be complex
    root: float = x ** (1.0 / n)
    return root - (root**n - x) / (n * root ** (n - 1)) if root > 0 else root
