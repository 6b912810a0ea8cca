"""Step map + observables → a loop over N steps in one arithmetic, with nothing not asked for.

Observables: `delta_j_max` max |ΔJ|, `mse` Σ ΔJ² (Eq. 15 before its 1/N), `lambda` Λ (Eq. 16) by
the closed form of ΔJ as Λ ← Λ + ΔJ + Λ ΔJ, `lambda_max` the greatest |Λ| after any step,
`lambda_plain` Π det J the plain way (four entries,
their determinant, the product), `extremes` the least and greatest ΔJ and Λ of one call's steps. In
n degrees of freedom also `symplectic_defect_max`, the greatest |entry| of S, and
`symplectic_defect`, W, with the Jacobian M of all steps so far: W ← W + MᵀSM, M ← J M.

Where H depends on time, step k is made at t = t₀ + k h (`verify.kernels.clock`).

`tangent` carries the tangent map along, for a rigorous bound (`verify.kernels.step.tangent_map`).

Where an arithmetic's numbers have an absolute precision (fixed point), D = 2^s ΔJ is carried, and
so are its sums, so that they keep their significant digits however small h is; it is evaluated from
ΔJ/h^r, r as great as can be, with κ = 2^s h^r in its coefficients. Λ itself is carried beside them
as `part`, since it multiplies. There the loop ends where p, q, Λ, Π det J or a function's value
leaves the limits that are given with the parameters.

A compensated kernel adds the increments to the state, and ΔJ to its sums, in twice the working
precision (Knuth's two-sum): what remains is the rounding of the increments, smaller by a factor of
about h. Its difference from the plain kernel estimates the plain kernel's rounding error.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.clock import clock_of
from verify.kernels.step import newton, tangent_map
from verify.kernels.step.computation import Computation, Observed, computed
from verify.kernels.step.in_degrees import computed_in_degrees, map_of
from verify.kernels.step.lowering import Lowering
from verify.scenes.observables import OF_FORM
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.step_map import StepMap

OBSERVABLES = (
    "delta_j_max", "mse", "lambda", "lambda_max", "lambda_plain", "extremes", "tangent",
)  # fmt: skip
CLOSED_FORM = frozenset({"delta_j_max", "mse", "lambda", "lambda_max", "extremes"})
PARTIAL = ("inverse", "root", "log", "exp", "sinh", "cosh")  # functions that may leave a range
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
    step_map = map_of(hamiltonian, scheme)
    return Writer(step_map, arithmetic, observables, compensated).kernel()


class Writer:
    """Writes the source of one kernel."""

    def __init__(
        self,
        step_map: StepMap | CanonicalMap,
        arithmetic: Arithmetic,
        observables: frozenset[str],
        compensated: bool,
        scaled: bool = True,
    ) -> None:
        self.arithmetic, self.observables, self.compensated = arithmetic, observables, compensated
        self.scaled = (
            scaled and arithmetic.absolute and bool(observables & {*CLOSED_FORM, *OF_FORM})
        )
        asked = Observed(
            pipelined=arithmetic.pipelined,
            scaled=self.scaled,
            delta_j=bool(observables & CLOSED_FORM),
            determinant="lambda_plain" in observables,
            tangent="tangent" in observables,
            symplectic="symplectic_defect_max" in observables,
            carried="symplectic_defect" in observables,
        )
        if isinstance(step_map, StepMap):
            self.made: Computation = computed(step_map, asked)
        else:
            self.made = computed_in_degrees(step_map, asked)
        self.coordinates = self.made.coordinates
        self.program, self.tangent = self.made.program, self.made.tangent
        self.lowering = Lowering(
            self.program, arithmetic.functions, bits=arithmetic.bits, guard=arithmetic.guard
        )
        self.state_names: list[tuple[str, str, int | str]] = [
            (name, "wide", name) for name in self.coordinates
        ]
        self.clock = clock_of(arithmetic) if self.made.timed else None
        for name, start in self.clock.carried if self.clock else ():
            self.carry(name, start)

    # -- what is computed ---------------------------------------------------------------------

    def kernel(self) -> Kernel:
        """The kernel, compiled. UnsupportedError where the arithmetic lacks what it needs."""
        lines = self.statements(self.made.outputs)
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
        names, kinds, start = zip(*self.state_names, strict=True)
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
        return (
            made.lowering.named_constants(tangent_map.nearest_double, made.change) if made else {}
        )

    # -- how it is written --------------------------------------------------------------------

    def statements(self, outputs: Mapping[str, int]) -> list[str]:
        """The loop's statements after the values: observables first, then the step."""
        value = {name: self.lowering.name(index) for name, index in outputs.items()}
        lines: list[str] = []
        asked = self.observables
        if "lambda_plain" in asked:
            self.carry("plain", 1)
            lines.append(f"plain = plain * {value['det']}")
        if asked & CLOSED_FORM:
            lines.append(f"dj = {value['dj']}")
        if {"lambda", "lambda_max", "extremes"} & asked:
            lines += self.product_of_factors()
        if "lambda_max" in asked:
            self.carry("lam_top", 0, "sum")
            lines += ["lam_size = abs(lam)", self.keep_extreme("lam_top", "lam_size", ">")]
        if "mse" in asked:
            lines += self.sum_up("mse", "dj * dj")
        if "delta_j_max" in asked:
            self.carry("top", 0)
            lines += ["size = abs(dj)", self.keep_extreme("top", "size", ">")]
        if "extremes" in asked:
            for name, kind in (("dj", "wide"), ("lam", "sum")):
                for end, order in ((f"{name}_low", "<"), (f"{name}_high", ">")):
                    self.carry(end, 0, kind)
                    lines.append(self.keep_extreme(end, name, order, first="k == 0 or "))
        if "symplectic_defect_max" in asked:
            lines += self.greatest_entry()
        if self.tangent:
            for name, start in tangent_map.carried(self.coordinates):
                self.carry(name, start, "float")
            change = [self.tangent.lowering.name(index) for index in self.tangent.change]
            lines += tangent_map.statements(change, self.coordinates)
        lines += self.of_matrices(value)
        for name in self.coordinates:
            lines += self.accumulate(name, value[f"d{name}"])
        return lines

    def greatest_entry(self) -> list[str]:
        """The greatest |entry| of S."""
        self.carry("s_top", 0)
        lines: list[str] = []
        for index in self.made.defect.values():
            name = self.lowering.name(index)
            lines += [f"s_size = abs({name})", self.keep_extreme("s_top", "s_size", ">")]
        return lines

    def of_matrices(self, value: Mapping[str, str]) -> list[str]:
        """W ← W + MᵀSM and M ← J M, entry by entry; all increments are made before."""
        lines: list[str] = []
        for name, increment in value.items():
            if name.startswith("dw_"):
                lines += self.sum_up(name[1:], increment)
            elif name.startswith("dm_"):
                _, a, b = name.split("_")
                self.carry(name[1:], int(a == b))
                lines += self.accumulate(name[1:], increment)
        return lines

    def product_of_factors(self) -> list[str]:
        """Λ ← Λ + ΔJ + Λ ΔJ."""
        lines = self.sum_up("lam", "dj + lam * dj")
        product = "lam"
        if self.arithmetic.absolute:
            self.carry("part", 0)
            product = "part"
            lines = [
                "grown = dj + dj * part",
                "part = part + shifted(grown, shift)",
                "lam = lam + grown",
            ]
        if self.tangent:
            for end, relation in (("least", "<"), ("most", ">")):
                self.carry(end, 0)
                lines.append(f"if {product} {relation} {end}: {end} = {product}")
        return lines

    def keep_extreme(self, name: str, of: str, order: str, first: str = "") -> str:
        """The statement that makes `name` the least or greatest of what it was and of `of`."""
        choose, opposite = {"<": ("minimum", ">="), ">": ("maximum", "<=")}[order]
        if choose not in self.arithmetic.functions:
            return f"if {first}{of} {order} {name}: {name} = {of}"
        # Balls, of which neither may be certainly the greater: then the extreme is a third ball.
        either = f"{choose}({of}, {name})"
        value = f"{of} if k == 0 else {either}" if first else either
        return f"if {first}not {of} {opposite} {name}: {name} = {value}"

    def carry(self, name: str, start: int | str, kind: str = "wide") -> None:
        """Adds to the state: its name, the value it starts with, and its kind of number."""
        self.state_names.append((name, kind, start))

    def sum_up(self, name: str, increment: str) -> list[str]:
        """The statements `name += increment` of a sum that begins with 0."""
        self.carry(name, 0, "sum")
        return self.accumulate(name, increment)

    def accumulate(self, name: str, increment: str) -> list[str]:
        """The statements `name += increment`; compensated (Kahan) where the kernel is."""
        if not self.compensated:
            return [f"{name} = {name} + ({increment})"]
        self.carry(f"{name}_rest", 0)
        return [
            f"add = {name}_rest + ({increment})",
            f"total = {name} + add",
            f"rest = total - {name}",
            f"{name}_rest = ({name} - (total - rest)) + (add - rest)",
            f"{name} = total",
        ]

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
        names = ", ".join(name for name, _, _ in self.state_names)
        parameters = [f"x{k}" for k in range(len(self.made.parameters))]
        given = [f"{name}: 'int'" if name == "shift" else name for name in more_arguments]
        annotated = [f"{name}: '{kind}'" for name, kind, _ in self.state_names]
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
        products = [name for name, _, _ in self.state_names if name in ("part", "plain")]
        looked_at |= dict.fromkeys(products, "reach_part")
        looked_at |= dict.fromkeys(self.made.matrix, _OF_MATRIX)
        for index in self.lowering.live(needed):
            if self.program.ops[index].kind in PARTIAL:
                looked_at[self.lowering.name(index)] = "reach_value"
        return " and ".join(["valid", *(f"inside({x}, {m})" for x, m in looked_at.items())])
