"""One step map iterated on many points at once, in any number system.

In float64 the kernel's loop gets an inner one over some points, which a compiler turns into vector
instructions, and threads share the points. Other number systems take point after point.
"""

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import LOOP, Kernel, kernel_for
from verify.kernels.reach import limits
from verify.kernels.stepping import KernelRun

_LANES = 64  # points whose states stay in the nearest cache
_SHARE = 256  # points that a thread takes at a time: some milliseconds and more
# Sequences of numbers, arrays or lists, by name: "p", "q" and what else is carried.
Values = Mapping[str, Any]


class LeftRangeError(Exception):
    """A point left the range of the number system or of H; the message says which point."""


class PointMap:
    """z ↦ z_N by N steps of one scheme in one arithmetic."""

    def __init__(
        self,
        hamiltonian: Hamiltonian,
        scheme: str,
        *,
        step_size: Fraction,
        steps: int,
        arithmetic: Arithmetic,
        observables: frozenset[str] = frozenset(),
        compensated: bool = False,
    ) -> None:
        """Raises UnsupportedError where the arithmetic lacks what the scheme needs."""
        self.arithmetic, self.steps = arithmetic, steps
        start = {"h": step_size, "p": Fraction(0), "q": Fraction(0)}
        self.kernel_run = KernelRun(hamiltonian, scheme, start, steps, observables, 0)
        self.kernel = kernel_for(
            self.kernel_run.hamiltonian, scheme, arithmetic, observables, compensated
        )
        if self.kernel.scales or self.kernel.tangent:
            raise UnsupportedError(f"{arithmetic.name} carries no observables for many points")

    def __call__(self, p: Any, q: Any) -> Values:
        """All that is carried, for points (p_i, q_i): two sequences of the arithmetic's numbers.

        Raises LeftRangeError.
        """
        found: Sequence[Any]
        if self.arithmetic.name == float64.NAME:
            found = self._in_lanes(np.asarray(p, dtype=np.float64), np.asarray(q, np.float64))
        else:
            found = self._one_by_one(p, q)
        return dict(zip(self.kernel.state_names, found, strict=True))

    def _inputs(self, extra: Sequence[Fraction] = ()) -> list[Number]:
        given = [*self.kernel_run.inputs(self.kernel, 0).values(), *extra]
        return [self.arithmetic.number(x) for x in given]

    def _in_lanes(self, p: np.ndarray, q: np.ndarray) -> list[np.ndarray]:
        run = _compiled(self.kernel)
        inputs = self._inputs()
        rest = [np.full(len(p), float(x)) for x in self.kernel.start]
        carried = [p.copy(), q.copy(), *rest]

        def advance(first: int) -> None:
            run(self.steps, *inputs, *(x[first : first + _SHARE] for x in carried))

        with ThreadPoolExecutor(os.cpu_count()) as threads:
            list(threads.map(advance, range(0, len(p), _SHARE)))
        lost = np.flatnonzero(~np.all(np.isfinite(carried), axis=0))
        if lost.size:
            raise _points_out_of_range(p[lost[0]], q[lost[0]], self.arithmetic.name)
        return carried

    def _one_by_one(self, p: Sequence[Number], q: Sequence[Number]) -> list[list[Number]]:
        inputs = self._inputs(self._limits(p, q))
        rest = [self.arithmetic.number(Fraction(x)) for x in self.kernel.start]

        def advance(z: tuple[Number, Number]) -> tuple[Number, ...]:
            try:
                done, *after = self.kernel.function(self.steps, *inputs, *z, *rest)
            except (ArithmeticError, ValueError):
                done = -1
            if done < self.steps or not all(map(self.arithmetic.finite, after)):
                at = [float(self.arithmetic.exact(x)) for x in z]
                raise _points_out_of_range(at[0], at[1], self.arithmetic.name)
            return tuple(after)

        with self.arithmetic.context():
            if not self.arithmetic.absolute:
                found = list(map(advance, zip(p, q, strict=True)))
            else:  # native code, which runs beside Python
                with ThreadPoolExecutor(os.cpu_count()) as threads:
                    found = list(threads.map(advance, zip(p, q, strict=True)))
        return [list(column) for column in zip(*found, strict=True)]

    def _limits(self, p: Sequence[Number], q: Sequence[Number]) -> tuple[Fraction, ...]:
        """Those of a fixed-point kernel, for all points together."""
        if not self.kernel.limits:
            return ()
        exact = self.arithmetic.exact
        far = {"p": max(abs(exact(x)) for x in p), "q": max(abs(exact(x)) for x in q)}
        found = limits(
            self.kernel, self.kernel_run.inputs(self.kernel, 0), self.kernel_run.start | far
        )
        if found is None:
            raise UnsupportedError(f"no box around the points is safe in {self.arithmetic.name}")
        return found


def _points_out_of_range(p: float, q: float, name: str) -> LeftRangeError:
    return LeftRangeError(
        f"the point (q, p) = ({q:.6g}, {p:.6g}) leaves the range of {name}, or of H"
    )


@lru_cache(maxsize=64)
def _compiled(kernel: Kernel) -> Callable[..., None]:
    """`many(steps, h, …, p, q, …)`: the kernel's loop on arrays, in place."""
    head, _, loop = kernel.source.partition(f"{LOOP}\n")
    signature, _, before = head.partition("\n")
    body = loop.rpartition("    return ")[0].splitlines()
    named = signature[signature.index("(") + 1 : signature.rindex(")")].split(",")
    names = [each.partition(":")[0].strip() for each in named]
    arrays = [f"{name}_all" if name in kernel.state_names else name for name in names]
    source = "\n".join(
        [
            f"def many({', '.join(arrays)}):",
            before.rstrip("\n"),
            f"    for first in range(0, len(p_all), {_LANES}):",
            "        for k in range(steps):",
            f"            for i in range(first, min(first + {_LANES}, len(p_all))):",
            *(f"                {name} = {name}_all[i]" for name in kernel.state_names),
            *(f"        {line}" for line in body),
            *(f"                {name}_all[i] = {name}" for name in kernel.state_names),
            "",
        ]
    )
    return float64.compiled_at_once().compile(source, "many", kernel.names)
