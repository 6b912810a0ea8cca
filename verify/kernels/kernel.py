"""Step map + observables → a loop over N steps in one arithmetic, which computes only what was
requested.

`verify.kernels.statements` writes the statements of the loop that use a step's values.

If H depends on time, step k is made at t = t₀ + k h; the error of t does not accumulate. In
floating point the integer k is carried, exactly; t₀, h, the product and the sum are rounded once
each. In fixed point the clock adds h to t, which is exact in the format; the remainders of t₀ and h
that the format cuts off are carried beside it, times 2^60, so that t is right to its last place.

If an arithmetic's numbers have an absolute precision (fixed point), the loop ends when p, q, Λ,
Π det J, an entry of M or a function's value leaves the limits that are passed with the parameters.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.number_system import Arithmetic, SystemNumber, UnsupportedError
from verify.arithmetic.systems.float64 import nearest_double
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.statements import TANGENT, Statements, integrals_of, is_scaled, needs_of
from verify.kernels.step.computation import Computation, StepRequest, computation_of, step_map_of
from verify.kernels.step.kinds import may_leave_range
from verify.kernels.step.lowering import Lowering, newton_constants
from verify.schemes.maps.step_map import StepMap

SCALES = ("kappa", "down", "shift")  # 2^s h^r, 2^−s and s itself
LIMITS = ("reach_p", "reach_q", "reach_part", "reach_value")
_MATRIX_LIMIT = "reach_m"  # one more limit, if M is carried
_REMAINDER_BITS = 60  # a remainder is carried times 2^60
_CLOCK_ROUNDINGS = 4  # each is at most a unit of |t₀| + N h; fixed point has fewer


@dataclass(frozen=True)
class Clock:
    """The time in a kernel's source.

    `arguments`: the names of the kernel's arguments for it. `carried`: (name, start value) of its
    carried numbers; a start value is a number, or a name among the run's inputs. `reading`: the
    statement that computes t at the beginning of a step; `ticks`: the statements at its end.
    """

    arguments: tuple[str, ...]
    carried: tuple[tuple[str, int | str], ...]
    reading: str
    ticks: tuple[str, ...]
    absolute: bool

    def constants(self, arithmetic: Arithmetic) -> dict[str, SystemNumber]:
        """Return the constants of the statements, by name."""
        return {} if self.absolute else {"clock_one": arithmetic.number(Fraction(1))}


_FLOATING = Clock(
    ("t0",), (("step", 0),), "t = t0 + step * h", ("step = step + clock_one",), absolute=False
)
_FIXED = Clock(
    ("h_rest",),
    (("clock", "t"), ("clock_rest", "t_rest")),
    f"t = clock + shifted(clock_rest, {_REMAINDER_BITS})",
    ("clock = clock + h", "clock_rest = clock_rest + h_rest"),
    absolute=True,
)


def choose_clock(arithmetic: Arithmetic) -> Clock:
    """Return the clock for kernels of this arithmetic."""
    return _FIXED if arithmetic.absolute else _FLOATING


def clock_inputs(arithmetic: Arithmetic, start: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Return the values of a clock's arguments, by name."""
    if arithmetic.absolute:
        return {"h_rest": _scaled_remainder(arithmetic, start["h"])}
    return {"t0": start["t"]}


def initial_remainder(arithmetic: Arithmetic, t: Fraction) -> dict[str, Fraction]:
    """Return the remainder of the initial t, by name; empty in floating point, which has none."""
    return {"t_rest": _scaled_remainder(arithmetic, t)} if arithmetic.absolute else {}


def _scaled_remainder(arithmetic: Arithmetic, x: Fraction) -> Fraction:
    """Return x minus its number in the format, times 2^60: exactly, as a rational."""
    remainder: Fraction = x - arithmetic.exact(arithmetic.number(x))
    return remainder * (1 << _REMAINDER_BITS)


def bound_time_error(arithmetic: Arithmetic, latest: Fraction) -> Fraction:
    """Return a bound on the error of t; `latest` is the greatest |t₀| + k h."""
    # In fixed point the unit is absolute; in floating point it is relative to the largest time.
    unit = Fraction(1, 2**arithmetic.bits)
    return _CLOCK_ROUNDINGS * unit * (1 if arithmetic.absolute else latest)


@dataclass(frozen=True, eq=False)
class Kernel(Computation):
    """A computation in one arithmetic, compiled.

    `function(steps, h, *parameters, *scales, *limits, *clock, *state)` → (steps done, *state).

    `state_names`: the carried numbers in their order: p, q, then the accumulators of observables;
    `kinds`: the kind of each (see `verify.arithmetic.wide.translator`). `start`: the initial values
    of all but the coordinates: numbers, or names among the run's inputs. An arithmetic of absolute
    precision has `scales` and `limits`, with which the loop's guard compares. `lowering` writes the
    program; `names`: the values of the names in the source.
    """

    function: Callable[..., tuple[int, *tuple[SystemNumber, ...]]]
    scales: tuple[str, ...]
    limits: tuple[str, ...]
    state_names: tuple[str, ...]
    kinds: tuple[str, ...]
    start: tuple[int | str, ...]
    lowering: Lowering
    source: str
    names: Mapping[str, SystemNumber]


@lru_cache(maxsize=64)
def kernel_for(
    hamiltonian: Hamiltonian,
    scheme: str,
    arithmetic: Arithmetic,
    observables: frozenset[str],
    compensated: bool = False,
) -> Kernel:
    """Return the kernel for a generic Hamiltonian (see `Hamiltonian.with_symbols`), cached."""
    step_map = step_map_of(hamiltonian, scheme)
    return KernelWriter(step_map, arithmetic, observables, compensated).kernel()


class KernelWriter:
    """A writer of the source of one kernel."""

    def __init__(
        self,
        step_map: StepMap,
        arithmetic: Arithmetic,
        observables: frozenset[str],
        compensated: bool,
        scaled: bool = True,
    ) -> None:
        self.arithmetic = arithmetic
        self.scaled = scaled and arithmetic.absolute and is_scaled(observables)
        request = StepRequest(
            pipelined=arithmetic.pipelined,
            scaled=self.scaled,
            tangent=TANGENT in observables,
            needs=frozenset(needs_of(observables)),
            integrals=integrals_of(observables),
        )
        self.computation: Computation = computation_of(step_map, request)
        self.coordinates = self.computation.coordinates
        self.program, self.tangent = self.computation.program, self.computation.tangent
        self.lowering = Lowering(
            self.program, arithmetic.functions, bits=arithmetic.bits, guard=arithmetic.guard
        )
        self.statements = Statements(
            self.computation, self.lowering, arithmetic, observables, compensated
        )
        self.state = self.statements.state
        self.clock = choose_clock(arithmetic) if self.computation.timed else None
        # The clock is carried behind the state, so that p and q keep their places.
        for name, start in self.clock.carried if self.clock else ():
            self.statements.carry(name, start)

    # -- the computation ----------------------------------------------------------------------

    def kernel(self) -> Kernel:
        """Compile the kernel. Raises UnsupportedError if the arithmetic lacks something for it."""
        lines = self.statements.all_lines()
        matrix = (_MATRIX_LIMIT,) * bool(self.computation.matrix)
        limits = (*LIMITS, *matrix) if self.arithmetic.absolute else ()
        scales = SCALES if self.scaled else ()
        clock = self.clock.arguments if self.clock else ()
        roots = self.computation.roots
        self.check(roots)
        source = self.assemble(roots, lines, (*scales, *limits, *clock))
        scope = {
            **self.arithmetic.functions,
            **self.lowering.named_constants(self.arithmetic.number, roots),
            **newton_constants(self.arithmetic.bits, self.arithmetic.number),
            **self.constants_of_tangent(),
            **(self.clock.constants(self.arithmetic) if self.clock else {}),
        }
        names, kinds, start = zip(*self.state, strict=True)
        return Kernel(
            **vars(self.computation),
            function=self.arithmetic.compile(source, "kernel", scope),
            scales=scales,
            limits=limits,
            state_names=names,
            kinds=kinds,
            start=start[len(self.coordinates) :],
            lowering=self.lowering,
            source=source,
            names=scope,
        )

    def check(self, roots: Sequence[int]) -> None:
        """Raise UnsupportedError if the arithmetic lacks a function, or cannot solve the step's
        equations."""
        for function in sorted(self.lowering.function_names(roots)):
            if function not in self.arithmetic.functions:
                raise UnsupportedError(f"{self.arithmetic.name} has no {function}")
        # Newton's method needs floating point: its loop is written neither for fixed point nor for
        # enclosures.
        rounds = not self.arithmetic.absolute and self.arithmetic.radius is None
        if self.lowering.solves(roots) and not rounds:
            raise UnsupportedError(f"{self.arithmetic.name} solves no equations")

    def constants_of_tangent(self) -> dict[str, SystemNumber]:
        """Return the constants of the tangent map's lines, as doubles, by name."""
        tangent = self.tangent
        return tangent.lowering.named_constants(nearest_double, tangent.change) if tangent else {}

    # -- the source ---------------------------------------------------------------------------

    def assemble(
        self, roots: Sequence[int], statements: list[str], more_arguments: Sequence[str]
    ) -> str:
        """Return the kernel's source: the operations that the roots need, and the statements.

        `more_arguments` follow H's parameters in the signature.
        """
        # Static lines do not depend on the state: they stand before the loop.
        static, dynamic = self.lowering.lines(roots)
        if self.tangent:
            more = self.tangent.lowering.lines(self.tangent.change)
            static, dynamic = static + more[0], dynamic + more[1]
        if self.clock:
            dynamic, statements = [self.clock.reading, *dynamic], [*statements, *self.clock.ticks]
        names = ", ".join(name for name, _, _ in self.state)
        parameters = [f"x{k}" for k in range(len(self.computation.parameters))]
        extra_arguments = [f"{name}: 'int'" if name == "shift" else name for name in more_arguments]
        state_arguments = [f"{name}: '{kind}'" for name, kind, _ in self.state]
        arguments = ", ".join(
            ["steps: 'int'", "h", *parameters, *extra_arguments, *state_arguments]
        )
        guard = self.guard(roots)
        return "\n".join(
            [
                f"def kernel({arguments}):",
                *(f"    {line}" for line in static),
                "    for k in range(steps):",
                *(f"        {line}" for line in [*dynamic, *statements]),
                *([f"        if not ({guard}): return k, {names}"] if guard else []),
                f"    return steps, {names}",
                "",
            ]
        )

    def guard(self, roots: Sequence[int]) -> str:
        """Return the condition that holds while the orbit is in range; empty if there is none."""
        if not self.arithmetic.absolute:
            template = self.arithmetic.guard
            inside = (template.format(x=x) for x in self.coordinates) if template else ()
            return " and ".join(inside)
        limit_of = {name: "reach_p" if name[0] == "p" else "reach_q" for name in self.coordinates}
        products = [name for name, _, _ in self.state if name in ("part", "plain")]
        limit_of |= dict.fromkeys(products, "reach_part")
        limit_of |= dict.fromkeys(self.computation.matrix, _MATRIX_LIMIT)
        # While p, q and function values are within their limits, no sum or product overflows:
        # `verify.kernels.stepping.limits` chooses the limits so. A function whose value stays in
        # any range that contains its argument is not checked.
        for index in self.lowering.live(roots):
            if may_leave_range(self.program.ops[index]):
                limit_of[self.lowering.name(index)] = "reach_value"
        return " and ".join(["valid", *(f"inside({x}, {m})" for x, m in limit_of.items())])
