"""One loop in which float64 and exact arithmetic stand side by side, step by step.

The float64 lines are those of the float64 kernel that `verify run` steps with: the same `Writer`
makes them, so that the same operations are rounded in the same order, and states, determinants and
products agree with it bit for bit. At each float64 state z̃_k the `wide` lines, in an arithmetic of
high precision, evaluate what the chain of `verify.studies.separation.separate` asks for:

    w_trajectory   Λ ← Λ + ΔJ(z̃_k) + Λ ΔJ(z̃_k), the step map's own ΔJ, exactly, at rounded inputs
    w_determinant  the same with d̃_k − 1, d̃_k the determinant that float64 found
    w_closed       the same with the ΔJ that float64 found from the closed form
    f_plain        Π d̃_k in float64
    f_sum, f_rest  Σ log1p of float64's ΔJ, in float64, with Knuth's two-sum: the plain additions'
                   errors are summed apart, and Λ = expm1(f_sum + f_rest)

Where H depends on time, float64 has a clock, f_t ← f_t + f_h, which the wide lines at z̃_k read,
too. Beside them a wide state of its own steps at these times (names that begin with `w_at_`), of
which w_clock is the product.

The source is in the language of `verify.arithmetic.wide.translate`: names begin with `f_` where
their value is a float64 and with `w_` where it is wide, but for functions of wide numbers, which
have their own name; `wide(x)` is the exact value of a float64. Python runs it with its own floats
and libm, and LLVM compiles it for fixed-point numbers; both round as a float64 kernel does
(tests hold all three against each other).
"""

import keyword
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel, Writer
from verify.kernels.step import newton
from verify.kernels.step.computation import step_map_of
from verify.kernels.step.kinds import may_leave_range
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.program import Program
from verify.schemes.maps.step_map import StepMap

WORKING = frozenset({"lambda", "lambda_plain"})  # with these `verify run` steps in float64, too
AT = "w_at_"  # before names of the wide state that steps by float64's clock
LIMITS = ("f_reach_p", "f_reach_q", "w_reach_part")  # of an arithmetic of limited range
_NAME = re.compile(r"[A-Za-z_]\w*")
_BARE = {*keyword.kwlist, "abs", "range"}  # where equations are solved there is a loop in the loop
_CLOSED_SUM = (
    "f_log = f_log1p(f_dj)",
    "f_total = f_sum + f_log",
    "f_part = f_total - f_sum",
    "f_rest = f_rest + ((f_sum - (f_total - f_part)) + (f_log - f_part))",
    "f_sum = f_total",
)


@dataclass(frozen=True)
class Mixed:
    """`function(steps, f_h, *f_parameters, w_h, *w_parameters, *limits, *state_names)` → (steps
    done, *state_names).

    `state_names` names what goes from step to step, `start` has the initial values but for those
    that are coordinates or ends of the region that they visit. `closed`: whether ΔJ, or S, in
    closed form is not constantly 0.
    """

    function: Callable[..., tuple[int, *tuple[Number, ...]]]
    parameters: tuple[str, ...]
    state_names: tuple[str, ...]
    start: dict[str, int]
    closed: bool
    source: str


@dataclass(frozen=True)
class MixedKernel(Mixed):
    """`limits`: of an arithmetic of limited range. `wide`: the kernel of the wide numbers alone,
    whose `outputs["dj"]` is the ΔJ that is followed; its function is none."""

    limits: tuple[str, ...]
    wide: Kernel


@lru_cache(maxsize=16)
def mixed_kernel(
    hamiltonian: Hamiltonian, scheme: str, arithmetic: Arithmetic, follow: bool
) -> MixedKernel:
    """The kernel for a generic Hamiltonian; `follow`: with ΔJ exactly at the float64 states.

    Raises UnsupportedError where the arithmetic lacks a function.
    """
    step_map, timed = step_map_of(hamiltonian, scheme), hamiltonian.time_dependent
    if timed and arithmetic.absolute:
        raise UnsupportedError(f"{arithmetic.name} follows no float64 clock")
    working = float64.make(17)
    narrow = _uncompiled(step_map, working, WORKING)
    if arithmetic.absolute and narrow.lowering.solves(narrow.roots):
        raise UnsupportedError(f"{arithmetic.name} follows no float64 that solves equations")
    value = {name: f"f_v{index}" for name, index in narrow.outputs.items()}
    closed = not narrow.lowering.program.is_constant(narrow.outputs["dj"], 0)
    before, inside = _lines(narrow, list(value), working, "f_")
    inside += [f"f_det = {value['det']}", f"f_dj = {value['dj']}"]

    wide = _uncompiled(step_map, arithmetic, frozenset({"lambda"}))
    totals: dict[str, int] = {}
    if follow:
        _check(wide, arithmetic)
        static, dynamic = _lines(wide, ["dj"], arithmetic, "w_")
        before += static
        inside += [f"w_{n} = wide(f_{n})" for n in ("p", "q", *("t" * timed))] + dynamic
        inside += _accumulate("trajectory", f"w_v{wide.outputs['dj']}", totals)
    if follow and timed:
        static, dynamic = _clocked(wide, arithmetic, narrow.parameters, totals)
        before, inside = before + static, inside + dynamic
    inside += ["w_own = wide(f_det) - w_one", *_accumulate("determinant", "w_own", totals)]
    totals["f_plain"] = 1
    inside.append("f_plain = f_plain * f_det")
    if closed:
        inside += ["w_own = wide(f_dj)", *_accumulate("closed", "w_own", totals), *_CLOSED_SUM]
        totals |= {"f_sum": 0, "f_rest": 0}
    sides: list[str] = []
    if follow:  # the region visited, over which the rounding of ΔJ is bounded
        inside += box_of("f_p") + box_of("f_q")
        sides = [f"{n}_{side}" for n in ("f_p", "f_q") for side in ("low", "high")]
    inside += [f"f_p = f_p + ({value['dp']})", f"f_q = f_q + ({value['dq']})"]
    inside += ["f_t = f_t + f_h"] * timed

    moved = (*(AT + n for n in "pq"),) if follow and timed else ()
    names = ("f_p", "f_q", *(["f_t"] * timed), *moved, *sides, *totals)
    limits = LIMITS if arithmetic.absolute else ()
    source = assemble(len(narrow.parameters), limits, names, before, inside)
    constants = _constants(narrow, working), _constants(wide, arithmetic)
    scope = scope_of(working, constants[0], arithmetic, constants[1])
    scope |= {"f_log1p": _log1p, "w_one": arithmetic.number(Fraction(1))}
    function = _compiled(source, arithmetic, scope)
    return MixedKernel(function, narrow.parameters, names, totals, closed, source, limits, wide)


def _clocked(
    wide: Kernel, arithmetic: Arithmetic, parameters: Sequence[str], totals: dict[str, int]
) -> tuple[list[str], list[str]]:
    """The lines of the wide state that steps by float64's clock."""
    given = ("h", *(f"x{k}" for k in range(len(parameters))))
    static, dynamic = _lines(wide, ["dj", "dp", "dq"], arithmetic, AT)
    value = {name: f"{AT}v{wide.outputs[name]}" for name in ("dj", "dp", "dq")}
    return (
        [*(f"{AT}{name} = w_{name}" for name in given), *static],
        [
            f"{AT}t = w_t", *dynamic, *_accumulate("clock", value["dj"], totals),
            f"{AT}p = {AT}p + ({value['dp']})", f"{AT}q = {AT}q + ({value['dq']})",
        ],
    )  # fmt: skip


def _uncompiled(step_map: StepMap, arithmetic: Arithmetic, observables: frozenset[str]) -> Kernel:
    """The arithmetic's own kernel, not compiled; ΔJ is not divided by a power of h."""
    uncompiled = replace(arithmetic, compile=lambda *_: lambda *_: ())
    return Writer(step_map, uncompiled, observables, False, scaled=False).kernel()


def _check(wide: Kernel, arithmetic: Arithmetic) -> None:
    """Where the range is limited, only what stays within it by the state's limits alone."""
    lowering = wide.lowering
    operations = (lowering.program.ops[i] for i in lowering.live([wide.outputs["dj"]]))
    partial = {
        op.function.name if op.kind == "call" else op.kind
        for op in operations
        if may_leave_range(op)
    }
    if arithmetic.absolute and partial:
        raise UnsupportedError(
            f"{', '.join(sorted(partial))} may leave the range of {arithmetic.name}"
        )


def _lines(
    kernel: Kernel, outputs: Sequence[str], arithmetic: Arithmetic, prefix: str
) -> tuple[list[str], list[str]]:
    """The kernel's lines before the loop and in it that make these outputs, names prefixed."""
    roots = [kernel.outputs[name] for name in outputs]
    return prefixed_lines(kernel.lowering.program, roots, arithmetic, prefix)


def prefixed_lines(
    program: Program, roots: Sequence[int], arithmetic: Arithmetic, prefix: str
) -> tuple[list[str], list[str]]:
    """A program's lines before the loop and in it that make these values, names prefixed."""
    bare = _BARE if prefix == "f_" else _BARE | set(arithmetic.functions)
    fresh = Lowering(program, arithmetic.functions, bits=arithmetic.bits, guard=arithmetic.guard)
    before, inside = fresh.lines(roots)

    def prefixed(line: str) -> str:
        return _NAME.sub(lambda m: m[0] if m[0] in bare else prefix + m[0], line)

    return [prefixed(line) for line in before], [prefixed(line) for line in inside]


def scope_of(
    working: Arithmetic,
    narrow: Mapping[str, Number],
    arithmetic: Arithmetic,
    wide: Mapping[str, Number],
) -> dict[str, Number]:
    """The functions that the source names, and its constants, in float64 and in wide numbers."""
    return {
        "wide": lambda x: arithmetic.number(Fraction(x)),
        **arithmetic.functions,
        **{f"f_{name}": x for name, x in {**working.functions, **narrow}.items()},
        **{f"{prefix}{name}": x for prefix in ("w_", AT) for name, x in wide.items()},
    }


def _constants(kernel: Kernel, arithmetic: Arithmetic) -> dict[str, Number]:
    return {
        **kernel.lowering.named_constants(arithmetic.number),
        **newton.constants(arithmetic.bits, arithmetic.number),
    }


def _log1p(x: float) -> float:
    """log1p; where 1 + x ≤ 0 it is not defined, and that is found afterwards."""
    return math.log1p(x) if x > -1.0 else math.nan


def _accumulate(name: str, own: str, state_names: dict[str, int]) -> list[str]:
    """Λ ← Λ + e + Λ e, and the greatest |Λ| on the way, which its error bound needs."""
    lam, top = f"w_{name}", f"w_{name}_top"
    state_names |= {lam: 0, top: 0}
    return [
        f"{lam} = {lam} + ({own} + {lam} * {own})",
        f"w_size = abs({lam})",
        f"if w_size > {top}: {top} = w_size",
    ]


def box_of(name: str) -> list[str]:
    """The lines that keep the least and the greatest value of a name."""
    low, high = f"{name}_low", f"{name}_high"
    return [f"if {low} > {name}: {low} = {name}", f"if {name} > {high}: {high} = {name}"]


def assemble(
    parameters: int,
    limits: Sequence[str],
    state_names: Sequence[str],
    before: Sequence[str],
    inside: Sequence[str],
) -> str:
    inputs = ["h", *(f"x{k}" for k in range(parameters))]
    given = [prefix + name for prefix in ("f_", "w_") for name in inputs]
    kinds = {"f": ": 'float'", "w": ""}
    arguments = ["steps: 'int'", *(n + kinds[n[0]] for n in (*given, *limits, *state_names))]
    names = ", ".join(state_names)
    guard = []
    if limits:
        tops = [f"{name} < w_reach_part" for name in state_names if name.endswith("_top")]
        inner = [f"-f_reach_{n} < f_{n} < f_reach_{n}" for n in ("p", "q")]
        guard = [f"if not ({' and '.join([*inner, *tops])}): return k, {names}"]
    return "\n".join(
        [
            f"def kernel({', '.join(arguments)}):",
            *(f"    {line}" for line in before),
            "    for k in range(steps):",
            *(f"        {line}" for line in [*inside, *guard]),
            f"    return steps, {names}",
            "",
        ]
    )


def _compiled(
    source: str, arithmetic: Arithmetic, scope: dict[str, Number]
) -> Callable[..., tuple[int, *tuple[Number, ...]]]:
    try:
        return arithmetic.compile(source, "kernel", scope)
    except NotImplementedError as missing:
        raise UnsupportedError(f"{arithmetic.name} has no {missing} of float64") from None
