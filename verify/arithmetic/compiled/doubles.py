"""float64 kernels compiled by LLVM: on many points at once, in several vectors, and on one point.

The source is that of a float64 kernel, in the language of `verify.arithmetic.wide.translator`. Each
operation is rounded by itself, and functions have the bits of the C library. So a point gets the
same bits in an array as alone.
"""

import ctypes
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from struct import Struct
from typing import Any

import numpy as np
import numpy.typing as npt

from verify.arithmetic.compiled.translation import Source
from verify.arithmetic.lanes.vectors import LANES
from verify.arithmetic.wide.translator import Target

POINTS_PER_CALL = 64
SETS = POINTS_PER_CALL // LANES
_CALL = re.compile(r"(\w+)\(")
_UNUSED_FRACTION = 112  # bits; a `Source` has a fixed-point format, which these kernels never use
Points = npt.NDArray[np.float64]


def on_points(source: str, names: Mapping[str, Any], carried: int) -> Callable[..., None]:
    """Return `run(steps, inputs, points)`, which makes the kernel's steps on an array, in place.

    `points` has the shape (carried, POINTS_PER_CALL): its rows are the last `carried` arguments of
    the kernel. `inputs` are the arguments between the number of steps and these. Raises
    NotImplementedError if the source is not in the language.
    """
    from verify.arithmetic.lanes import libm_circle
    from verify.arithmetic.lanes.doubles import DoublesInLanes

    functions = _CALL.findall(source)

    def target(_: int) -> Target:
        return DoublesInLanes(SETS, carried, functions)

    circle = "circle of its own" if libm_circle.is_available() else "libm"
    form = f"{SETS} sets, {carried} rows, {circle}"
    layout, linked = _source(source, names, form, target).compile()
    function = linked()
    rows = len(layout.arguments)

    def run(steps: int, inputs: Points, points: Points) -> None:
        arguments = np.empty((rows, POINTS_PER_CALL))
        arguments.view(np.int64)[0] = steps
        arguments[1 : rows - carried] = np.reshape(inputs, (-1, 1))
        arguments[rows - carried :] = points
        results = np.empty((carried + 2, POINTS_PER_CALL))
        # Both arrays stay referenced until the call returns: the compiled code has only their
        # addresses.
        function(arguments.ctypes.data, results.ctypes.data)
        points[:] = results[1:-1]

    return run


def one_point(source: str, names: Mapping[str, Any], *, anew: bool = False) -> Callable[..., Any]:
    """Return the kernel as a function of the same arguments and results as its source.

    `anew`: compile it even if its code is cached on disk. Raises NotImplementedError as `on_points`
    does.
    """
    layout, linked = _source(source, names, "doubles").compile(anew=anew)
    packing, unpacking = (_record(kinds) for kinds in (layout.arguments, layout.results))
    size = layout.result_at[-1] + 8

    def kernel(*arguments: Any) -> Any:
        result = ctypes.create_string_buffer(size)
        linked()(packing.pack(*arguments), result)
        values = unpacking.unpack_from(result)
        return values if layout.returns_tuple else values[0]

    def prepare(*arguments: Any) -> Callable[[], None]:
        return partial(linked(), packing.pack(*arguments), ctypes.create_string_buffer(size))

    kernel.prepare = prepare  # type: ignore[attr-defined]
    return kernel


def _source(
    source: str, names: Mapping[str, Any], target: str, make: Callable[[int], Target] | None = None
) -> Source:
    """Return the kernel's source with the float64 constants among `names`: a target needs no
    others."""
    constants = tuple(sorted((n, x) for n, x in names.items() if isinstance(x, float)))
    return Source(_annotate(source), _UNUSED_FRACTION, constants, target, make)


def _record(kinds: Sequence[str]) -> Struct:
    """Return the memory layout of values of these kinds, `int` or `float`, one after another."""
    return Struct("=" + "".join("q" if kind == "int" else "d" for kind in kinds))


def prepared_call(kernel: Callable[..., Any], *arguments: Any) -> Callable[[], object]:
    """Return a call of the kernel on these arguments for timing; they are packed beforehand."""
    prepare: Callable[..., Callable[[], object]] = getattr(
        kernel, "prepare", partial(partial, kernel)
    )
    return prepare(*arguments)


def _annotate(source: str) -> str:
    """Annotate the first argument, the number of steps, as `int`, and all others as `float`."""
    head, parenthesis, signature = source.partition("(")
    arguments, end, body = signature.partition("):")
    first, *names = (argument.partition(":")[0].strip() for argument in arguments.split(","))
    annotated = ", ".join([f"{first}: 'int'", *(f"{name}: 'float'" for name in names)])
    return f"{head}{parenthesis}{annotated}{end}{body}"
