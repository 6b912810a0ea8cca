"""Step map + observables → a loop over N steps in one arithmetic, with nothing not asked for.

What the loop does with a step's values is in `verify.kernels.statements`. Where H depends on time,
step k is made at t = t₀ + k h (`verify.kernels.clock`).

Where an arithmetic's numbers have an absolute precision (fixed point), the loop ends where p, q, Λ,
Π det J or a function's value leaves the limits that are given with the parameters.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems.float64 import nearest_double
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.clock import clock_of
from verify.kernels.statements import TANGENT, Statements, is_scaled, needs_of
from verify.kernels.step import newton
from verify.kernels.step.computation import Computation, Observed, computed, step_map_of
from verify.kernels.step.kinds import may_leave_range
from verify.kernels.step.lowering import Lowering
from verify.schemes.maps.step_map import StepMap

SCALES = ("kappa", "down", "shift")  # 2^s h^r, 2^−s and s itself
LIMITS = ("reach_p", "reach_q", "reach_part", "reach_value")
_OF_MATRIX = "reach_m"  # where M is carried


@dataclass(frozen=True, eq=False)
class Kernel(Computation):
    """What is computed, in an arithmetic.

    `function(steps, h, *parameters, *scales, *limits, *clock, *state)` → (steps done, *state).

    `state_names` names the state and accumulators in their order: p, q, then those of the
    observables; `kinds` says of each what it is (see `verify.arithmetic.wide.translate`), `start`
    has the initial values, coordinates apart: numbers, or names of the run's own. An arithmetic of
    absolute precision has `scales` and `limits`, the numbers that the loop's guard compares with.
    `lowering` writes the program; `names` is what the source's names stand for.
    """

    function: Callable[..., tuple[int, *tuple[Number, ...]]]
    scales: tuple[str, ...]
    limits: tuple[str, ...]
    state_names: tuple[str, ...]
    kinds: tuple[str, ...]
    start: tuple[int | str, ...]
    lowering: Lowering
    source: str
    names: Mapping[str, Number]


@lru_cache(maxsize=64)
def kernel_for(
    hamiltonian: Hamiltonian,
    scheme: str,
    arithmetic: Arithmetic,
    observables: frozenset[str],
    compensated: bool = False,
) -> Kernel:
    """The kernel for a generic Hamiltonian (see `Hamiltonian.with_symbols`), compiled once."""
    step_map = step_map_of(hamiltonian, scheme)
    return Writer(step_map, arithmetic, observables, compensated).kernel()


class Writer:
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
        asked = Observed(
            pipelined=arithmetic.pipelined,
            scaled=self.scaled,
            tangent=TANGENT in observables,
            needs=frozenset(needs_of(observables)),
        )
        self.made: Computation = computed(step_map, asked)
        self.coordinates = self.made.coordinates
        self.program, self.tangent = self.made.program, self.made.tangent
        self.lowering = Lowering(
            self.program, arithmetic.functions, bits=arithmetic.bits, guard=arithmetic.guard
        )
        self.statements = Statements(self.made, self.lowering, arithmetic, observables, compensated)
        self.state = self.statements.state
        self.clock = clock_of(arithmetic) if self.made.timed else None
        for name, start in self.clock.carried if self.clock else ():
            self.statements.carry(name, start)

    # -- what is computed ---------------------------------------------------------------------

    def kernel(self) -> Kernel:
        """The kernel, compiled. UnsupportedError where the arithmetic lacks what it needs."""
        lines = self.statements.written()
        matrix = (_OF_MATRIX,) * bool(self.made.matrix)
        limits = (*LIMITS, *matrix) if self.arithmetic.absolute else ()
        scales = SCALES if self.scaled else ()
        clock = self.clock.arguments if self.clock else ()
        needed = self.made.roots
        self.check(needed)
        source = self.assemble(needed, lines, (*scales, *limits, *clock))
        scope = {
            **self.arithmetic.functions,
            **self.lowering.named_constants(self.arithmetic.number, needed),
            **newton.constants(self.arithmetic.bits, self.arithmetic.number),
            **self.constants_of_tangent(),
            **(self.clock.constants(self.arithmetic) if self.clock else {}),
        }
        names, kinds, start = zip(*self.state, strict=True)
        return Kernel(
            **vars(self.made),
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

    def check(self, needed: Sequence[int]) -> None:
        """Raises UnsupportedError where the arithmetic lacks a function, or solves no equations."""
        for function in sorted(self.lowering.called(needed)):
            if function not in self.arithmetic.functions:
                raise UnsupportedError(f"{self.arithmetic.name} has no {function}")
        rounded = not self.arithmetic.absolute and self.arithmetic.radius is None
        if self.lowering.solves(needed) and not rounded:
            raise UnsupportedError(f"{self.arithmetic.name} solves no equations")

    def constants_of_tangent(self) -> dict[str, Number]:
        """The constants of the tangent map's lines, as doubles by their names."""
        made = self.tangent
        return made.lowering.named_constants(nearest_double, made.change) if made else {}

    # -- how it is written --------------------------------------------------------------------

    def assemble(
        self, needed: Sequence[int], statements: list[str], more_arguments: Sequence[str]
    ) -> str:
        """The kernel's source for `needed` operations; more arguments follow H's parameters."""
        static, dynamic = self.lowering.lines(needed)
        if self.tangent:
            more = self.tangent.lowering.lines(self.tangent.change)
            static, dynamic = static + more[0], dynamic + more[1]
        if self.clock:
            dynamic, statements = [self.clock.now, *dynamic], [*statements, *self.clock.later]
        names = ", ".join(name for name, _, _ in self.state)
        parameters = [f"x{k}" for k in range(len(self.made.parameters))]
        given = [f"{name}: 'int'" if name == "shift" else name for name in more_arguments]
        annotated = [f"{name}: '{kind}'" for name, kind, _ in self.state]
        arguments = ", ".join(["steps: 'int'", "h", *parameters, *given, *annotated])
        guard = self.guard(needed)
        return "\n".join(
            [
                f"def kernel({arguments}):",
                *(f"    {line}" for line in static),
                "    for k in range(steps):",  # what is before it is the same for every k
                *(f"        {line}" for line in [*dynamic, *statements]),
                *([f"        if not ({guard}): return k, {names}"] if guard else []),
                f"    return steps, {names}",
                "",
            ]
        )

    def guard(self, needed: Sequence[int]) -> str:
        """What holds as long as the orbit is in range; empty where nothing is to be looked at."""
        if not self.arithmetic.absolute:
            template = self.arithmetic.guard
            inside = (template.format(x=x) for x in self.coordinates) if template else ()
            return " and ".join(inside)
        looked_at = {name: f"reach_{name[0]}" for name in self.coordinates}
        products = [name for name, _, _ in self.state if name in ("part", "plain")]
        looked_at |= dict.fromkeys(products, "reach_part")
        looked_at |= dict.fromkeys(self.made.matrix, _OF_MATRIX)
        for index in self.lowering.live(needed):
            if may_leave_range(self.program.ops[index]):
                looked_at[self.lowering.name(index)] = "reach_value"
        return " and ".join(["valid", *(f"inside({x}, {m})" for x, m in looked_at.items())])
