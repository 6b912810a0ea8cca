"""One loop that steps in float64 and evaluates in high precision beside it.

The float64 lines are those of the float64 kernel that `verify run` steps with: the same step is
written, so that the same operations are rounded in the same order, and states and products agree
with it bit for bit. At each float64 state z̃_k the `wide` lines, in an arithmetic of high precision,
evaluate what the chain of `verify.studies.separation.truncation_and_rounding` needs. The way
(`verify.studies.separation.way`) decides which values are carried in each arithmetic.

If H depends on time, float64 has a clock, f_t ← f_t + f_h, and the wide lines at z̃_k read it. A
second wide state steps at the clock's times from the rounded inputs (its names begin with `w_at_`).

The source is in the language of `verify.arithmetic.wide.translator`: the name of a float64 begins
with `f_` and that of a wide number with `w_`, but functions of wide numbers have no prefix;
`wide(x)` is the wide number of a float64. Python runs it with its own floats and libm, and LLVM
compiles it for fixed-point numbers; both round as a float64 kernel does (tests compare all three).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.number_system import Arithmetic, SystemNumber, UnsupportedError
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import step_map_of
from verify.studies.separation.way import MixedKernel, Side, Way

CLOCKED_PREFIX = "w_at_"  # names of the wide state that steps by float64's clock
LIMITS = ("f_reach_p", "f_reach_q", "w_reach_part")  # arguments in an arithmetic of limited range


@lru_cache(maxsize=16)
def mixed_kernel(
    way: Way, hamiltonian: Hamiltonian, scheme: str, arithmetic: Arithmetic, follow: bool
) -> MixedKernel:
    """Build the kernel for a generic Hamiltonian; `follow`: with exact steps at float64's states.

    Raises UnsupportedError if the arithmetic lacks a function, or cannot follow float64.
    """
    step_map, has_time = step_map_of(hamiltonian, scheme), hamiltonian.time_dependent
    if has_time and arithmetic.absolute:
        raise UnsupportedError(f"{arithmetic.name} follows no float64 clock")
    working = float64.make(17)
    # Both sides compute the same step; only the arithmetic and the prefix of the names differ.
    narrow = Side(way.step(step_map, working, exactly=False), working, "f_")
    wide = Side(way.step(step_map, arithmetic, exactly=True), arithmetic, "w_")
    step, coordinates = narrow.step, narrow.step.coordinates
    # The same step a second time, under other names, at float64's times.
    clocked = replace(wide, prefix=CLOCKED_PREFIX) if follow and has_time else None
    before, inside = narrow.lines([*step.outputs.values(), *step.defect.values(), *narrow.entries])
    wide_roots = wide.entries or [wide.step.outputs["dj"]]
    regions, sides = [f"f_{n}" for n in coordinates], list[str]()
    if follow:
        static, dynamic = wide.lines(wide_roots)
        before += static
        inside += [f"w_{n} = wide(f_{n})" for n in (*coordinates, *("t" * has_time))] + dynamic
    if clocked:
        static, dynamic = clocked.lines(
            [*wide_roots, *(clocked.step.outputs[f"d{n}"] for n in coordinates)]
        )
        before += [
            f"{CLOCKED_PREFIX}{name} = w_{name}" for name in _inputs(step.parameters)
        ] + static
        inside += [f"{CLOCKED_PREFIX}t = w_t", *dynamic]
    lines = way.lines(narrow, wide if follow else None, clocked)
    inside += lines.inside
    if follow:  # the region visited, over which the rounding of the wide step is bounded
        inside += [line for name in regions for line in _box(name)]
        sides = [f"{name}_{side}" for name in regions for side in ("low", "high")]
    inside += _state_update("f_", narrow)
    inside += _state_update(CLOCKED_PREFIX, clocked) if clocked else []
    inside += ["f_t = f_t + f_h"] * has_time
    clocked_names = [f"{CLOCKED_PREFIX}{n}" for n in coordinates] if clocked else []
    names = (*regions, *(["f_t"] * has_time), *clocked_names, *sides, *lines.start)
    limits = LIMITS if arithmetic.absolute else ()
    source = assemble(_inputs(step.parameters), limits, names, before, inside)
    function = _compile(source, narrow, wide)
    return MixedKernel(
        function, names, lines.start, lines.followed, lines.closed, source, limits, wide.step
    )


def _inputs(parameters: Sequence[str]) -> list[str]:
    """Return the names that the source has for h and the parameters."""
    return ["h", *(f"x{k}" for k in range(len(parameters)))]


def _state_update(prefix: str, side: Side) -> list[str]:
    """Return the lines of z ← z + (z' − z)."""
    names = side.step.coordinates
    return [f"{prefix}{n} = {prefix}{n} + ({side.output(f'd{n}')})" for n in names]


def _box(name: str) -> list[str]:
    """Return the lines that keep the least and the greatest value of a name."""
    low, high = f"{name}_low", f"{name}_high"
    return [f"if {low} > {name}: {low} = {name}", f"if {name} > {high}: {high} = {name}"]


def assemble(
    inputs: Sequence[str],
    limits: Sequence[str],
    state_names: Sequence[str],
    before: Sequence[str],
    inside: Sequence[str],
) -> str:
    """Return the source of a kernel."""
    numbers = [prefix + name for prefix in ("f_", "w_") for name in inputs]
    kinds = {"f": ": 'float'", "w": ""}
    arguments = ["steps: 'int'", *(n + kinds[n[0]] for n in (*numbers, *limits, *state_names))]
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


def _compile(
    source: str, narrow: Side, wide: Side
) -> Callable[..., tuple[int, *tuple[SystemNumber, ...]]]:
    """Compile the kernel, with the functions that its source names, and its constants."""
    arithmetic, working, constants = wide.arithmetic, narrow.arithmetic, wide.constants
    scope = {
        "wide": lambda x: arithmetic.number(Fraction(x)),
        **arithmetic.functions,
        **{f"f_{name}": x for name, x in {**working.functions, **narrow.constants}.items()},
        **{
            f"{prefix}{name}": x
            for prefix in ("w_", CLOCKED_PREFIX)
            for name, x in constants.items()
        },
        "f_log1p": _log1p,
        "w_one": arithmetic.number(Fraction(1)),
    }
    try:
        return arithmetic.compile(source, "kernel", scope)
    except NotImplementedError as missing:
        raise UnsupportedError(f"{arithmetic.name} has no {missing} of float64") from None


def _log1p(x: float) -> float:
    """Return log1p(x), or nan where 1 + x ≤ 0, which is noticed afterwards."""
    return math.log1p(x) if x > -1.0 else math.nan
