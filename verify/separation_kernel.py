"""One loop in which float64 and exact arithmetic stand side by side, step by step.

The float64 lines are those of the float64 kernel that `verify run` steps with: the same `Writer`
lowers them, so that the same operations are rounded in the same order, and states, determinants and
products agree with it bit for bit. At each float64 state z̃_k the `wide` lines, in an arithmetic of
high precision, evaluate what the chain of `verify.separation` asks for:

    w_trajectory   Λ ← Λ + ΔJ(z̃_k) + Λ ΔJ(z̃_k), the step map's own ΔJ, exactly, at rounded inputs
    w_determinant  the same with d̃_k − 1, d̃_k the determinant that float64 found
    w_closed       the same with the ΔJ that float64 found from the closed form
    f_plain        Π d̃_k in float64
    f_sum, f_rest  Σ log1p of float64's ΔJ, in float64, with Knuth's two-sum: the plain additions'
                   errors are summed apart, and Λ = expm1(f_sum + f_rest)

The source is made of assignments, + − * /, unary minus, functions called by name, `abs`, lines
`if a > b: a = b`, and one loop. Every name but `steps`, `k` and `wide` begins with `f_` where its
value is a float64, and with `w_` where it is wide; `wide(x)` is the exact value of a float64.
Python runs it with its own floats and libm, which round as numba's do (a test holds both against
each other).
"""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from verify import arithmetic as number_systems
from verify.arithmetic.float64 import root_of
from verify.hamiltonian import Hamiltonian
from verify.kernel import Writer
from verify.number_system import Arithmetic
from verify.program import Program
from verify.schemes import get

WORKING = frozenset({"lambda", "lambda_plain"})  # with these `verify run` steps in float64, too
_NAME = re.compile(r"[A-Za-z_]\w*")
_CLOSED_SUM = (
    "f_log = f_log1p(f_dj)",
    "f_total = f_sum + f_log",
    "f_part = f_total - f_sum",
    "f_rest = f_rest + ((f_sum - (f_total - f_part)) + (f_log - f_part))",
    "f_sum = f_total",
)


@dataclass(frozen=True)
class MixedKernel:
    """`function(steps, f_h, *f_parameters, w_h, *w_parameters, *carried)` → (steps done, *carried).

    `carried` names what goes from step to step, `start` has the initial values but for those that
    are p's or q's. `delta_j`: the wide lines' program and the index of ΔJ in it, whose rounding is
    counted; None where ΔJ is not followed. `closed`: whether ΔJ in closed form is not constantly 0.
    """

    function: Callable[..., tuple[Any, ...]]
    parameters: tuple[str, ...]
    carried: tuple[str, ...]
    start: dict[str, int]
    delta_j: tuple[Program, int] | None
    closed: bool
    source: str


@lru_cache(maxsize=16)
def mixed_kernel(
    hamiltonian: Hamiltonian, scheme: str, arithmetic: Arithmetic, follow: bool
) -> MixedKernel:
    """The kernel for a generic Hamiltonian; `follow`: with ΔJ exactly at the float64 states."""
    step_map = get(scheme).step_map(hamiltonian)
    float64 = number_systems.get("float64", 17)
    narrow = Writer(step_map, float64, WORKING, compensated=False)
    found = narrow.outputs()
    value = {name: f"f_v{index}" for name, index in found.items()}
    closed = not narrow.program.is_constant(found["dj"], 0)

    before, inside = _lines(narrow, list(found.values()), "f_")
    inside += [f"f_det = {value['det']}", f"f_dj = {value['dj']}"]
    carried: dict[str, int] = {}
    scope = _scope(float64, narrow, "f_") | {"f_log1p": _log1p, "f_root": root_of}
    scope |= {"wide": _wide(arithmetic), "w_one": arithmetic.number(Fraction(1))}
    delta_j = None
    if follow:
        broad = Writer(step_map, arithmetic, frozenset({"lambda"}), compensated=False)
        root = broad.outputs()["dj"]
        delta_j = broad.program, root
        static, dynamic = _lines(broad, [root], "w_")
        before += static
        inside += ["w_p = wide(f_p)", "w_q = wide(f_q)", *dynamic, f"w_dj = w_v{root}"]
        inside += _accumulate("trajectory", "w_dj", carried)
        scope |= _scope(arithmetic, broad, "w_")
    inside += ["w_own = wide(f_det) - w_one", *_accumulate("determinant", "w_own", carried)]
    carried["f_plain"] = 1
    inside.append("f_plain = f_plain * f_det")
    if closed:
        inside += ["w_own = wide(f_dj)", *_accumulate("closed", "w_own", carried), *_CLOSED_SUM]
        carried |= {"f_sum": 0, "f_rest": 0}
    sides: list[str] = []
    if follow:  # the region visited, over which the rounding of ΔJ is bounded
        inside += _box("f_p") + _box("f_q")
        sides = [f"{n}_{side}" for n in ("f_p", "f_q") for side in ("low", "high")]
    inside += [f"f_p = f_p + ({value['dp']})", f"f_q = f_q + ({value['dq']})"]

    names = ("f_p", "f_q", *sides, *carried)
    source = _assemble(len(narrow.parameters), names, before, inside)
    function = arithmetic.compile(source, "kernel", scope)
    return MixedKernel(function, narrow.parameters, names, carried, delta_j, closed, source)


def _lines(writer: Writer, roots: Sequence[int], prefix: str) -> tuple[list[str], list[str]]:
    """The writer's lines before the loop and in it, every name in them with the prefix."""
    before, inside = writer.values(roots)
    return tuple([_NAME.sub(prefix + r"\g<0>", line) for line in x] for x in (before, inside))  # type: ignore[return-value]


def _scope(arithmetic: Arithmetic, writer: Writer, prefix: str) -> dict[str, Any]:
    scope = {**arithmetic.functions, **writer.constants()}
    return {prefix + name: value for name, value in scope.items()}


def _log1p(x: float) -> float:
    """log1p; where 1 + x ≤ 0 it is not defined, and that is found afterwards."""
    return math.log1p(x) if x > -1.0 else math.nan


def _wide(arithmetic: Arithmetic) -> Callable[[float], Any]:
    """float64 → the arithmetic, exactly."""
    own = arithmetic.functions.get("wide")
    return own or (lambda x: arithmetic.number(Fraction(x)))


def _accumulate(name: str, own: str, carried: dict[str, int]) -> list[str]:
    """Λ ← Λ + e + Λ e, and the greatest |Λ| on the way, which its error bound needs."""
    lam, top = f"w_{name}", f"w_{name}_top"
    carried |= {lam: 0, top: 0}
    return [
        f"{lam} = {lam} + ({own} + {lam} * {own})",
        f"w_size = abs({lam})",
        f"if w_size > {top}: {top} = w_size",
    ]


def _box(name: str) -> list[str]:
    low, high = f"{name}_low", f"{name}_high"
    return [f"if {low} > {name}: {low} = {name}", f"if {name} > {high}: {high} = {name}"]


def _assemble(
    parameters: int, carried: Sequence[str], before: Sequence[str], inside: Sequence[str]
) -> str:
    given = [f"{prefix}{n}" for prefix in ("f_", "w_")
             for n in ("h", *(f"x{k}" for k in range(parameters)))]  # fmt: skip
    return "\n".join(
        [
            f"def kernel({', '.join(['steps', *given, *carried])}):",
            *(f"    {line}" for line in before),
            "    for k in range(steps):",
            *(f"        {line}" for line in inside),
            f"    return steps, {', '.join(carried)}",
            "",
        ]
    )
