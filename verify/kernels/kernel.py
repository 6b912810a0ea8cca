"""Step map + observables → a loop over N steps in one arithmetic, with nothing that was not
requested.

The statements of the loop that use a step's values are written in `verify.kernels.statements`.

If H depends on time, step k is made at t = t₀ + k h, without an error that accumulates. Floating
point: k is carried, an exact number, and t₀ + k h is rounded three times in addition to t₀ itself.
Fixed point: t₀ and h in the format are carried and added, which is exact; the parts that the format
cuts off from both are carried with them, 2^60 times as large, so that t is right to its last place.

If an arithmetic's numbers have an absolute precision (fixed point), the loop ends where p, q, Λ,
Π det J or a function's value leaves the limits that are passed with the parameters.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

from verify.arithmetic.number_system import Arithmetic, SystemNumber, UnsupportedError
from verify.arithmetic.systems.float64 import nearest_double
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.statements import TANGENT, Statements, is_scaled, needs_of
from verify.kernels.step.computation import Computation, StepRequest, computation_of, step_map_of
from verify.kernels.step.kinds import may_leave_range
from verify.kernels.step.lowering import Lowering, newton_constants
from verify.schemes.maps.step_map import StepMap

SCALES = ("kappa", "down", "shift")  # 2^s h^r, 2^−s and s itself
LIMITS = ("reach_p", "reach_q", "reach_part", "reach_value")
_OF_MATRIX = "reach_m"  # if M is carried
_PLACES = 60  # bits by which the cut-off remainder is scaled up
_ERRORS = 4  # roundings of t, each at most a unit of |t₀| + N h; in fixed point fewer


@dataclass(frozen=True)
class Clock:
    """The time in a kernel's source.

    Names of the kernel's `arguments` and of `carried` numbers, with the start's name or number;
    `reading` is the statement that computes t at the beginning of a step, `ticks` are those at its
    end.
    """

    arguments: tuple[str, ...]
    carried: tuple[tuple[str, int | str], ...]
    reading: str
    ticks: tuple[str, ...]
    absolute: bool

    def constants(self, arithmetic: Arithmetic) -> dict[str, SystemNumber]:
        """Return the constants that the statements name."""
        return {} if self.absolute else {"clock_one": arithmetic.number(Fraction(1))}


_FLOATING = Clock(
    ("t0",), (("step", 0),), "t = t0 + step * h", ("step = step + clock_one",), absolute=False
)
_FIXED = Clock(
    ("h_rest",),
    (("clock", "t"), ("clock_rest", "t_rest")),
    f"t = clock + shifted(clock_rest, {_PLACES})",
    ("clock = clock + h", "clock_rest = clock_rest + h_rest"),
    absolute=True,
)


def clock_of(arithmetic: Arithmetic) -> Clock:
    """Return the clock for kernels of this arithmetic."""
    return _FIXED if arithmetic.absolute else _FLOATING


def clock_inputs(arithmetic: Arithmetic, start: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Return the values of a clock's arguments by their names."""
    if arithmetic.absolute:
        return {"h_rest": _cut(arithmetic, start["h"])}
    return {"t0": start["t"]}


def first_rest(arithmetic: Arithmetic, t: Fraction) -> dict[str, Fraction]:
    """Return the remainder that is carried with t from its start."""
    return {"t_rest": _cut(arithmetic, t)} if arithmetic.absolute else {}


def _cut(arithmetic: Arithmetic, x: Fraction) -> Fraction:
    """Return the part of x that the format cuts off, as it is carried."""
    # The remainder is exact: a rational minus the rational that the format holds.
    cut: Fraction = x - arithmetic.exact(arithmetic.number(x))
    return cut * (1 << _PLACES)


def error_of_time(arithmetic: Arithmetic, latest: Fraction) -> Fraction:
    """Return a bound on the error of t, `latest` being the greatest |t₀| + k h."""
    # In fixed point a unit is absolute; in floating point it is relative to the largest time.
    unit = Fraction(1, 2**arithmetic.bits)
    return _ERRORS * unit * (1 if arithmetic.absolute else latest)


@dataclass(frozen=True, eq=False)
class Kernel(Computation):
    """A computation in one arithmetic, compiled.

    `function(steps, h, *parameters, *scales, *limits, *clock, *state)` → (steps done, *state).

    `state_names` names the state and accumulators in their order: p, q, then those of the
    observables; `kinds` says of each what it is (see `verify.arithmetic.wide.translator`), `start`
    has the initial values, coordinates apart: numbers, or names of the run's own. An arithmetic of
    absolute precision has `scales` and `limits`, the numbers that the loop's guard compares with.
    `lowering` writes the program; `names` is what the source's names stand for.
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
    """Return the kernel for a generic Hamiltonian (see `Hamiltonian.with_symbols`), compiled
    once."""
    step_map = step_map_of(hamiltonian, scheme)
    return KernelWriter(step_map, arithmetic, observables, compensated).kernel()


class KernelWriter:
    """Writes the source of one kernel."""

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
        self.clock = clock_of(arithmetic) if self.computation.timed else None
        # The clock is carried behind the state, so that p and q keep their places.
        for name, start in self.clock.carried if self.clock else ():
            self.statements.carry(name, start)

    # -- the computation ----------------------------------------------------------------------

    def kernel(self) -> Kernel:
        """Compile the kernel. UnsupportedError if the arithmetic lacks something that it
        needs."""
        lines = self.statements.all_lines()
        matrix = (_OF_MATRIX,) * bool(self.computation.matrix)
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
        """Raise UnsupportedError if the arithmetic lacks a function, or solves no equations."""
        for function in sorted(self.lowering.function_names(roots)):
            if function not in self.arithmetic.functions:
                raise UnsupportedError(f"{self.arithmetic.name} has no {function}")
        # Newton's method needs numbers of a relative precision that are no enclosures: it is
        # written neither for fixed point nor for balls.
        rounds = not self.arithmetic.absolute and self.arithmetic.radius is None
        if self.lowering.solves(roots) and not rounds:
            raise UnsupportedError(f"{self.arithmetic.name} solves no equations")

    def constants_of_tangent(self) -> dict[str, SystemNumber]:
        """Return the constants of the tangent map's lines, as doubles by their names."""
        tangent = self.tangent
        return tangent.lowering.named_constants(nearest_double, tangent.change) if tangent else {}

    # -- how it is written --------------------------------------------------------------------

    def assemble(
        self, roots: Sequence[int], statements: list[str], more_arguments: Sequence[str]
    ) -> str:
        """Return the kernel's source for the operations of these roots; more arguments follow H's
        parameters."""
        # Static lines do not depend on the state: they stand before the loop, and cost nothing per
        # step.
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
                "    for k in range(steps):",  # the lines before it are the same for every k
                *(f"        {line}" for line in [*dynamic, *statements]),
                *([f"        if not ({guard}): return k, {names}"] if guard else []),
                f"    return steps, {names}",
                "",
            ]
        )

    def guard(self, roots: Sequence[int]) -> str:
        """Return the condition that holds as long as the orbit is in range; empty if nothing is
        checked."""
        if not self.arithmetic.absolute:
            template = self.arithmetic.guard
            inside = (template.format(x=x) for x in self.coordinates) if template else ()
            return " and ".join(inside)
        limit_of = {name: f"reach_{name[0]}" for name in self.coordinates}
        products = [name for name, _, _ in self.state if name in ("part", "plain")]
        limit_of |= dict.fromkeys(products, "reach_part")
        limit_of |= dict.fromkeys(self.computation.matrix, _OF_MATRIX)
        # Sums and products cannot overflow while p, q and function values are within their limits:
        # `verify.kernels.stepping.limits` has chosen these so. Only unbounded functions are
        # checked.
        for index in self.lowering.live(roots):
            if may_leave_range(self.program.ops[index]):
                limit_of[self.lowering.name(index)] = "reach_value"
        return " and ".join(["valid", *(f"inside({x}, {m})" for x, m in limit_of.items())])
