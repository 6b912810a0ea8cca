"""What one step of a kernel computes, whatever the numbers: a step map → a straight-line program.

z' − z, S = JᵀΩJ − Ω, det J − 1, det J the plain way, the tangent map, and W. In the plane S is
ΔJ dp∧dq. S is written in closed form where the map has one, coefficient by coefficient of h, so
that nothing cancels in it; else from K = J − 1 as S = KᵀΩ + ΩK + KᵀΩK, which costs digits, since
what vanishes identically does so in the sum alone. K is what the step's own operations give, one
derivative after the other. Along an orbit M ← M + K M and W ← W + MᵀSM, with M before the step.

It depends on the map, and on what is asked of it, but on no precision and on no number system
beyond `Observed`. So it is made once for a map, and shared by the runs of it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import combinations

from verify.algebra.ring import Poly
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.increments import increments
from verify.kernels.step.pfaffian import Pfaffian, change_of_volume
from verify.kernels.step.program import Evaluator, Program
from verify.kernels.step.program_algebra import Dual, ProgramAlgebra, TangentAlgebra, Value
from verify.kernels.step.tangent_map import Tangent
from verify.observables.observable import Need
from verify.schemes import get
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.step_map import StepMap

Place = tuple[int, int]
Matrix = list[list[int]]  # of indices


@dataclass(frozen=True)
class Observed:
    """What is asked of a step: what observables need, A − 1 of the tangent map, K = J − 1 itself.

    `scaled`: ΔJ is divided by the power of h that it has, and multiplied by κ. `pipelined` as in
    `verify.arithmetic.number_system.Arithmetic`.
    """

    pipelined: bool
    scaled: bool
    tangent: bool
    needs: frozenset[Need] = frozenset()
    slopes: bool = False

    @property
    def defect(self) -> bool:
        """Whether S is needed, or ΔJ."""
        return bool(self.needs & {"delta_j", "symplectic", "carried"})


@dataclass(frozen=True, eq=False)
class Computation:
    """`outputs`: the indices of the increments of the coordinates, as `dp`, of ΔJ, `dj`, and where
    they are asked for of det J, `det`, of H, `de`, and of M's and W's entries. `power` is the r of
    κ; `parameters` are those of H; `timed` says whether it depends on t, which is one more input
    then. `coordinates` name the state; `defect` has the entries of S that are asked for, `slopes` K
    by rows, where that is. Nobody writes into the program any more.
    """

    program: Program
    outputs: Mapping[str, int]
    tangent: Tangent | None
    power: int
    parameters: tuple[str, ...]
    timed: bool
    coordinates: tuple[str, ...]
    defect: Mapping[str, int]
    slopes: Matrix

    @property
    def matrix(self) -> list[str]:
        """The names of M's entries, where it is carried."""
        return [name[1:] for name in self.outputs if name.startswith("dm_")]

    @property
    def roots(self) -> list[int]:
        """What is read of the program's values."""
        needed = self.tangent.needed if self.tangent else ()
        return [*self.outputs.values(), *self.defect.values(), *needed]


def step_map_of(hamiltonian: Hamiltonian, scheme: str) -> StepMap:
    """The scheme's map of a Hamiltonian; the same one for the next that asks."""
    return get(scheme).step_map(hamiltonian)


@lru_cache(maxsize=64)
def computed(step_map: StepMap, asked: Observed) -> Computation:
    """What is asked of a map, made once as long as it is among the last ones."""
    return _Step(step_map, asked).computation()


@dataclass(frozen=True)
class _Begun:
    """What all that is asked of a map has in common: S in closed form is the longest part of it.

    The program, to be copied, its inputs by their names, and the entries of S.
    """

    program: Program
    named: Mapping[str, int]
    forms: Mapping[Place, int]


@lru_cache(maxsize=64)
def _begun(step_map: StepMap, pipelined: bool, scaled: bool, defect: bool) -> _Begun:
    program, exact = Program(), step_map.hamiltonian
    # A user's parameter may be named like anything; in the source it is x0, x1, ….
    arguments = {"h": "h"} | {n: f"x{k}" for k, n in enumerate(exact.symbols)}
    named = {n: program.input(a, static=True) for n, a in arguments.items()}
    time = ("t",) if exact.time_dependent else ()
    named |= {n: program.input(n, static=False) for n in (*exact.coordinates, *time)}
    kappa = program.input("kappa", static=True) if scaled else None
    closed = step_map.written_defect
    forms: dict[Place, int] = {}
    if defect and closed and not step_map.preserves_area:
        evaluator = Evaluator(program, step_map.ring, named, pipelined)
        power = common_power(step_map) if scaled else 0
        for place in combinations(range(len(exact.coordinates)), 2):
            forms[place] = evaluator.evaluate(_sum_of(closed, [place], power), kappa)
    return _Begun(program, named, forms)


def common_power(step_map: StepMap) -> int:
    """The greatest r for which h^r divides all of S as it is written; 0 where it is not."""
    closed = step_map.written_defect
    return min(closed.forms or {}, default=0) if closed and not step_map.preserves_area else 0


def _sum_of(closed: ClosedForm, places: Sequence[Place], power: int) -> Poly:
    """The sum of these entries of S, divided by h^power."""
    h, total = closed.ring.variable("h"), closed.ring.zero
    for m, form in (closed.forms or {}).items():
        for place in places:
            if place in form.entries:
                total += h ** (m - power) * form.entries[place]
    return total


class _Step:
    def __init__(self, step_map: StepMap, asked: Observed) -> None:
        self.step_map, self.asked = step_map, asked
        wanted = asked.defect
        begun = _begun(step_map, asked.pipelined, asked.scaled, wanted)
        self.program, self.named = begun.program.copy(), begun.named
        self.names, self.forms = step_map.hamiltonian.coordinates, dict(begun.forms)
        self.preserved = not wanted or step_map.preserves_area
        self.closed = step_map.written_defect
        self.power = common_power(step_map) if asked.scaled and wanted else 0
        self.points: set[int] = set()  # the coordinates of where f is looked at

    def computation(self) -> Computation:
        asked, program, exact = self.asked, self.program, self.step_map.hamiltonian
        changes = self.changes
        outputs = {f"d{name}": at for name, at in zip(self.names, changes, strict=True)}
        outputs["dj"] = program.constant(Fraction(0))
        if not self.preserved and self.closed is None:
            self.forms = self.from_slopes()
        if "delta_j" in asked.needs and self.forms:
            outputs["dj"] = self.volume()
        if "determinant" in asked.needs:
            outputs["det"] = self.determinant()
        if "carried" in asked.needs and self.forms:
            outputs |= self.carried()
        if "energy" in asked.needs:
            outputs["de"] = self.change_of_energy()
        tangent = None
        if asked.tangent:
            tangent = Tangent(program)
            tangent.take([x for row in self.slopes for x in row], self.points)
        shown = self.forms if "symplectic" in asked.needs else {}
        defect = {f"s_{a}_{b}": at for (a, b), at in shown.items()}
        return Computation(
            program, outputs, tangent, self.power, exact.symbols, exact.time_dependent,
            self.names, defect, self.slopes if asked.slopes else [],
        )  # fmt: skip

    @cached_property
    def changes(self) -> list[int]:
        """z' − z."""
        step, n = self.step_map, len(self.names) // 2
        if step.step is not None:
            return [x.index for x in self.read]
        moves = step.flat.increments
        evaluator = self.evaluator()
        pairs = [
            increments(evaluator, step.ring, pair, self.named["h"])
            for pair in zip(moves[:n], moves[n:], strict=True)
        ]
        return [pair[part] for part in (0, 1) for pair in pairs]

    @cached_property
    def slopes(self) -> Matrix:
        """K = J − 1, row by row."""
        step = self.step_map
        if step.step is not None:
            return [list(x.gradient) for x in self.read if isinstance(x, Dual)]
        evaluator, field = self.evaluator(), step.field
        rows = (field.gradient(x) for x in step.flat.increments)
        return [[evaluator.evaluate(x) for x in row] for row in rows]

    @cached_property
    def read(self) -> list[Value]:
        """z' − z of a map that is known by its step, with derivatives where K is needed."""
        asked, field = self.asked, self.step_map.field
        plain = ProgramAlgebra(self.program, field, self.named, asked.pipelined)
        self.points = plain.points
        of_slopes = asked.needs & {"determinant", "carried"}
        wanted = asked.tangent or asked.slopes or of_slopes
        assert self.step_map.step is not None  # noqa: S101 - the caller looks
        if wanted or not self.preserved:
            return self.step_map.step(TangentAlgebra(plain, coordinates=len(self.names)))
        return self.step_map.step(plain)

    def evaluator(self) -> Evaluator:
        return Evaluator(self.program, self.step_map.ring, self.named, self.asked.pipelined)

    # -- S and what follows from it -----------------------------------------------------------

    def from_slopes(self) -> dict[Place, int]:
        """S = KᵀΩ + ΩK + KᵀΩK, or 2^s of it."""
        program, slopes = self.program, self.slopes
        n, entries = len(self.names) // 2, {}
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
            entries[a, b] = total
        if self.asked.scaled:
            kappa = program.input("kappa", static=True)
            return {place: mul(kappa, at) for place, at in entries.items()}
        return entries

    def volume(self) -> int:
        """det J − 1, or 2^s of it."""
        program, n = self.program, len(self.names) // 2
        pairs = [(i, n + i) for i in range(n)]
        first = self.forms[pairs[0]]
        if self.closed is None:
            for pair in pairs[1:]:
                first = program.add(first, self.forms[pair])
        elif n > 1:
            kappa = program.input("kappa", static=True) if self.asked.scaled else None
            first = self.evaluator().evaluate(_sum_of(self.closed, pairs, self.power), kappa)
        down = program.input("down", static=True) if self.asked.scaled else None
        made = Pfaffian(program, lambda a, b: self.forms[a, b], down)
        return change_of_volume(made, n, first)

    def determinant(self) -> int:
        """That of J's four entries in the plane, the plain way."""
        program, given = self.program, self.step_map.formulas is not None
        if given:
            evaluator, rows = self.evaluator(), self.step_map.flat.jacobian
            (a, b), (c, d) = [[evaluator.evaluate(x) for x in row] for row in rows]
        else:
            (a, b), (c, d) = self.slopes
            a, d = (program.add(program.quotient(1, 1), x) for x in (a, d))
        return program.add(program.mul(a, d), program.neg(program.mul(b, c)))

    def change_of_energy(self) -> int:
        """H after the step, less H before it."""
        program, field = self.program, self.step_map.field
        moves = dict(zip(self.names, self.changes, strict=True))
        after = {**self.named, **{n: program.add(self.named[n], x) for n, x in moves.items()}}
        before, later = (
            Evaluator(program, field.ring, at, self.asked.pipelined).evaluate(field.energy)
            for at in (self.named, after)
        )
        return program.add(later, program.neg(before))

    def carried(self) -> dict[str, int]:
        """The increments of M and of W."""
        program, size = self.program, len(self.names)
        every = range(size)
        own = [[program.input(f"m_{a}_{b}", static=False) for b in every] for a in every]
        moved = _product(program, self.slopes, own)
        outputs = {f"dm_{a}_{b}": moved[a][b] for a in every for b in every}
        matrix = [[program.constant(Fraction(0))] * size for _ in every]
        for (a, b), at in self.forms.items():
            matrix[a][b], matrix[b][a] = at, program.neg(at)
        right = _product(program, matrix, own)
        for a, b in combinations(every, 2):
            total = program.constant(Fraction(0))
            for c in every:
                total = program.add(total, program.mul(own[c][a], right[c][b]))
            outputs[f"dw_{a}_{b}"] = total
        return outputs


def _product(program: Program, x: Matrix, y: Matrix) -> Matrix:
    columns, rows = list(zip(*y, strict=True)), []
    for row in x:
        line = []
        for column in columns:
            total = program.constant(Fraction(0))
            for a, b in zip(row, column, strict=True):
                total = program.add(total, program.mul(a, b))
            line.append(total)
        rows.append(line)
    return rows
