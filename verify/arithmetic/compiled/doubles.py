"""float64 kernels compiled by LLVM: on many points at once, in several vectors, and on one point.

The source is a float64 kernel's own, in the language of `verify.arithmetic.wide.translator`; each
operation is rounded as there, and functions have the bits of the C library's. So a point has the
bits that it has by itself.
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

POINTS = 64  # a call's
SETS = POINTS // LANES
_CALL = re.compile(r"(\w+)\(")
_FRACTION = 112  # bits of wide numbers, of which there are none
Points = npt.NDArray[np.float64]


def on_points(source: str, names: Mapping[str, Any], carried: int) -> Callable[..., None]:
    """Return `run(steps, inputs, points)`: the kernel's steps on an array, in place.

    `carried`: its last arguments, so many, are the rows of `points`, (carried, POINTS); `inputs`
    are those between the steps and them. Raises NotImplementedError if the source has what is
    not in the language.
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
        arguments = np.empty((rows, POINTS))
        arguments.view(np.int64)[0] = steps
        arguments[1 : rows - carried] = np.reshape(inputs, (-1, 1))
        arguments[rows - carried :] = points
        results = np.empty((carried + 2, POINTS))
        # Both arrays stay referenced until the call returns: the compiled code has only their
        # addresses.
        function(arguments.ctypes.data, results.ctypes.data)
        points[:] = results[1:-1]

    return run


def one_point(source: str, names: Mapping[str, Any], *, anew: bool = False) -> Callable[..., Any]:
    """Return the kernel as a function of its own arguments, a tuple or one number as it returns.

    `anew`: not from what is kept on disk. Raises NotImplementedError as `on_points` does.
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
    """Return the kernel with the numbers among its names, which are all that a target needs."""
    constants = tuple(sorted((n, x) for n, x in names.items() if isinstance(x, float)))
    return Source(_annotate(source), _FRACTION, constants, target, make)


def _record(kinds: Sequence[str]) -> Struct:
    """Return the layout of integers and float64 side by side."""
    return Struct("=" + "".join("q" if kind == "int" else "d" for kind in kinds))


def prepared_call(kernel: Callable[..., Any], *arguments: Any) -> Callable[[], object]:
    """Return the kernel on these arguments, as a call to be timed, which packs none of them."""
    prepare: Callable[..., Callable[[], object]] = getattr(
        kernel, "prepare", partial(partial, kernel)
    )
    return prepare(*arguments)


def _annotate(source: str) -> str:
    """Annotate all numbers as float64, except the steps."""
    head, parenthesis, signature = source.partition("(")
    arguments, end, body = signature.partition("):")
    first, *names = (argument.partition(":")[0].strip() for argument in arguments.split(","))
    annotated = ", ".join([f"{first}: 'int'", *(f"{name}: 'float'" for name in names)])
    return f"{head}{parenthesis}{annotated}{end}{body}"
