"""What one step computes in n degrees of freedom: z', S, det J − 1, the tangent map, and W.

S = JᵀΩJ − Ω is written in closed form where the map has one, coefficient by coefficient of h, so
that nothing cancels in it; else from K = J − 1 as S = KᵀΩ + ΩK + KᵀΩK, which costs digits, since
what vanishes identically does so in the sum alone. K is what the step's own operations give, one
derivative after the other. Along an orbit M ← M + K M and W ← W + MᵀSM, with M before the step.
"""

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import combinations

from verify.algebra.ring import Poly
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import Computation, Observed, step_map_of
from verify.kernels.step.pfaffian import Pfaffian, change_of_volume
from verify.kernels.step.program import Evaluator, Program
from verify.kernels.step.program_algebra import Partials, ProgramAlgebra
from verify.kernels.step.tangent_map import Tangent
from verify.proof.symplectic.closed_form import ClosedDefect
from verify.schemes import get
from verify.schemes.degrees import map_in_degrees
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.step_map import StepMap

Place = tuple[int, int]


def map_of(hamiltonian: Hamiltonian, scheme: str) -> StepMap | CanonicalMap:
    """The scheme's map of a Hamiltonian, in the plane or in n degrees of freedom; the same one for
    the next that asks."""
    planar = hamiltonian.planar
    return step_map_of(hamiltonian, scheme) if planar else _in_degrees(hamiltonian, scheme)


def preserves(step_map: StepMap | CanonicalMap) -> bool:
    """Whether ΔJ ≡ 0 is shown; in n degrees of freedom S ≡ 0."""
    if isinstance(step_map, StepMap):
        return step_map.preserves_area
    return ClosedDefect.of(step_map).vanishes


def is_written_out(hamiltonian: Hamiltonian, scheme: str) -> bool:
    """Whether S of its map in n degrees of freedom is evaluated from a closed form, in which
    nothing cancels."""
    step_map = map_of(hamiltonian, scheme)
    return isinstance(step_map, CanonicalMap) and ClosedDefect.of(step_map).forms is not None


@lru_cache(maxsize=32)
def _in_degrees(hamiltonian: Hamiltonian, scheme: str) -> CanonicalMap:
    return map_in_degrees(get(scheme), hamiltonian)


@lru_cache(maxsize=64)
def computed_in_degrees(step: CanonicalMap, asked: Observed) -> Computation:
    """What is asked of a map, made once as long as it is among the last ones."""
    return _Step(step, asked).computation()


def with_slopes(made: Computation) -> tuple[Program, Partials, list[list[int]]]:
    """A copy of the step's program, what differentiates in it, and K = J − 1, row by row."""
    program = made.program.copy()
    partials = Partials(program, [program.input(n, static=False) for n in made.coordinates])
    changes = [made.outputs[f"d{name}"] for name in made.coordinates]
    return program, partials, [partials.gradient(at) for at in changes]


class _Step:
    def __init__(self, step: CanonicalMap, asked: Observed) -> None:
        self.step, self.asked, self.program = step, asked, Program()
        exact, program = step.hamiltonian, self.program
        arguments = {"h": "h"} | {n: f"x{k}" for k, n in enumerate(exact.symbols)}
        self.named = {n: program.input(a, static=True) for n, a in arguments.items()}
        time = ("t",) if exact.time_dependent else ()
        self.names = exact.coordinates
        self.named |= {n: program.input(n, static=False) for n in (*self.names, *time)}
        self.algebra = ProgramAlgebra(program, step.field, self.named, asked.pipelined)
        self.power = 0

    def computation(self) -> Computation:
        step, asked, program = self.step, self.asked, self.program
        changes = self.changes()
        outputs = {f"d{name}": at for name, at in zip(self.names, changes, strict=True)}
        outputs["dj"] = program.constant(Fraction(0))
        forms: dict[Place, int] = {}
        wanted = asked.delta_j or asked.symplectic or asked.carried
        preserved = wanted and ClosedDefect.of(step).vanishes
        if wanted and not preserved:
            forms = self.defect(changes)
        if asked.delta_j and forms:
            outputs["dj"] = self.volume(forms)
        if asked.carried and forms:
            outputs |= self.carried(changes, forms)
        tangent = None
        if asked.tangent:
            tangent = Tangent(program)
            tangent.take([x for row in self.slopes(changes) for x in row])
        shown = forms if asked.symplectic else {}
        exact = step.hamiltonian
        defect = {f"s_{a}_{b}": at for (a, b), at in shown.items()}
        return Computation(
            program, outputs, tangent, self.power, exact.symbols, exact.time_dependent,
            self.names, defect,
        )  # fmt: skip

    def changes(self) -> list[int]:
        """z' − z."""
        step = self.step
        if step.step is not None:
            return [x.index for x in step.step(self.algebra)]
        assert step.closed is not None  # noqa: S101 - a map has one or the other
        ring = step.ring
        evaluator = Evaluator(self.program, ring, self.named, self.asked.pipelined)
        pairs = zip(step.closed, self.names, strict=True)
        return [evaluator.evaluate(x - ring.variable(name)) for x, name in pairs]

    def slopes(self, changes: list[int]) -> list[list[int]]:
        """K = J − 1, row by row."""
        partials = Partials(self.program, [self.named[name] for name in self.names])
        return [partials.gradient(at) for at in changes]

    # -- S and what follows from it -----------------------------------------------------------

    def defect(self, changes: list[int]) -> dict[Place, int]:
        """The entries of S, or 2^s S by κ (S/h^r), a < b."""
        kappa = self.program.input("kappa", static=True) if self.asked.scaled else None
        closed = ClosedDefect.of(self.step).forms
        if closed is None:
            found = self.from_slopes(changes)
            scaled = found if kappa is None else {
                place: self.program.mul(kappa, at) for place, at in found.items()
            }  # fmt: skip
            return scaled
        self.power = min(closed) if kappa is not None and closed else 0
        places = combinations(range(len(self.names)), 2)
        return {place: self.written(self.sum_of(closed, [place]), kappa) for place in places}

    def written(self, x: Poly, factor: int | None) -> int:
        ring = self.step.ring
        return Evaluator(self.program, ring, self.named, self.asked.pipelined).evaluate(x, factor)

    def sum_of(self, forms: Mapping[int, Mapping[Place, Poly]], places: list[Place]) -> Poly:
        """The sum of these entries of S, divided by h^r."""
        ring = self.step.ring
        h, total = ring.variable("h"), ring.zero
        for m, form in forms.items():
            for place in places:
                if place in form:
                    total += h ** (m - self.power) * form[place]
        return total

    def from_slopes(self, changes: list[int]) -> dict[Place, int]:
        """S = KᵀΩ + ΩK + KᵀΩK."""
        program, slopes = self.program, self.slopes(changes)
        n, found = len(self.names) // 2, {}
        add, mul, neg = program.add, program.mul, program.neg
        for a, b in combinations(range(2 * n), 2):
            total = program.constant(Fraction(0))
            for i in range(n):
                u, v = slopes[i], slopes[n + i]
                # du∧dq + dp∧dv at ab, and du∧dv
                if b == n + i:
                    total = add(total, u[a])
                if a == n + i:
                    total = add(total, neg(u[b]))
                if a == i:
                    total = add(total, v[b])
                if b == i:
                    total = add(total, neg(v[a]))
                total = add(total, add(mul(u[a], v[b]), neg(mul(u[b], v[a]))))
            found[a, b] = total
        return found

    def volume(self, forms: Mapping[Place, int]) -> int:
        """det J − 1, or 2^s of it."""
        program, n = self.program, len(self.names) // 2
        pairs = [(i, n + i) for i in range(n)]
        closed = ClosedDefect.of(self.step).forms
        if closed is None:
            first = forms[pairs[0]]
            for pair in pairs[1:]:
                first = program.add(first, forms[pair])
        else:
            kappa = program.input("kappa", static=True) if self.asked.scaled else None
            first = self.written(self.sum_of(closed, pairs), kappa)
        down = program.input("down", static=True) if self.asked.scaled else None
        made = Pfaffian(program, lambda a, b: forms[a, b], down)
        return change_of_volume(made, n, first)

    def carried(self, changes: list[int], forms: Mapping[Place, int]) -> dict[str, int]:
        """The increments of M and of W."""
        program, size = self.program, len(self.names)
        every = range(size)
        own = [[program.input(f"m_{a}_{b}", static=False) for b in every] for a in every]
        moved = _product(program, self.slopes(changes), own)
        outputs = {f"dm_{a}_{b}": moved[a][b] for a in every for b in every}
        matrix = [[program.constant(Fraction(0))] * size for _ in every]
        for (a, b), at in forms.items():
            matrix[a][b], matrix[b][a] = at, program.neg(at)
        right = _product(program, matrix, own)
        for a, b in combinations(every, 2):
            total = program.constant(Fraction(0))
            for c in every:
                total = program.add(total, program.mul(own[c][a], right[c][b]))
            outputs[f"dw_{a}_{b}"] = total
        return outputs


def _product(program: Program, x: list[list[int]], y: list[list[int]]) -> list[list[int]]:
    columns, found = list(zip(*y, strict=True)), []
    for row in x:
        line = []
        for column in columns:
            total = program.constant(Fraction(0))
            for a, b in zip(row, column, strict=True):
                total = program.add(total, program.mul(a, b))
            line.append(total)
        found.append(line)
    return found
