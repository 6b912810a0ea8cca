"""The computation of one step of a kernel, in any number system: a step map → a straight-line
program.

On request it has z' − z; S = JᵀΩJ − Ω, by which the step's Jacobian J misses symplecticity (in the
plane ΔJ dp∧dq); ΔJ = det J − 1; det J from J's entries; the tangent map M, the product of the
Jacobians; and W = MᵀΩM − Ω. If the map has S in closed form, a formula for each coefficient of a
power of h, S is written from it, and nothing cancels. Else S = KᵀΩ + ΩK + KᵀΩK with K = J − 1,
which costs digits: terms that cancel identically do so in floating sums. K comes from the step's
operations by differentiation. Along an orbit M ← M + K M and W ← W + MᵀSM, with M before the step.

A computation depends on no precision, and on no number system beyond the `StepRequest`. So it is
built once, and shared by all runs of the map.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import combinations

from verify.algebra.ring import Ring
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.evaluator import Evaluator, increments
from verify.kernels.step.integral import integral_of
from verify.kernels.step.matrix_operations import (
    Matrix,
    Pfaffian,
    Place,
    change_of_determinant,
    change_of_volume,
    defect_from_slopes,
    multiply,
)
from verify.kernels.step.operations import StepProgram
from verify.kernels.step.program_algebra import Dual, ProgramAlgebra, ProgramValue, TangentAlgebra
from verify.kernels.step.shared_part import common_power, shared_part, source_names, sum_of
from verify.kernels.step.tangent_map import Tangent
from verify.observables.observable import Need
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap


@dataclass(frozen=True)
class StepRequest:
    """The quantities requested of a step.

    `needs`: the quantities that observables need. `tangent`: K = J − 1 in float64, for the tangent
    map. `slopes`: K itself. `scaled`: S and ΔJ are divided by their power of h and multiplied by κ.
    `pipelined`: as in `verify.arithmetic.number_system.Arithmetic`. `integrals`: functions of the
    state, see `verify.kernels.step.integral`.
    """

    pipelined: bool
    scaled: bool
    tangent: bool
    needs: frozenset[Need] = frozenset()
    slopes: bool = False
    integrals: tuple[str, ...] = ()

    @property
    def defect(self) -> bool:
        """True if S is needed, or ΔJ."""
        return bool(self.needs & {"delta_j", "symplectic", "carried"})


@dataclass(frozen=True, eq=False)
class Computation:
    """A step's program, and the indices of its values in it.

    `outputs`: the increments of the coordinates (`dp`, …), ΔJ (`dj`), and on request det J (`det`),
    the increments of M's and of W's entries (`dm_a_b`, `dw_a_b`), and the integrals before the step
    (`e0`, …). `power`: the r of κ = 2^s h^r. `parameters`: the names of H's. `timed`: t is one more
    input. `coordinates`: their names in the source; `canonical`: they are p and q. `defect`: the
    requested entries of S (`s_a_b`); `slopes`: K by rows, on request. No operation is added later.
    """

    program: StepProgram
    outputs: Mapping[str, int]
    tangent: Tangent | None
    power: int
    parameters: tuple[str, ...]
    timed: bool
    coordinates: tuple[str, ...]
    canonical: bool
    defect: Mapping[str, int]
    slopes: Matrix

    @property
    def matrix(self) -> list[str]:
        """The names of M's entries, if it is carried."""
        return [name[1:] for name in self.outputs if name.startswith("dm_")]

    @property
    def roots(self) -> list[int]:
        """The indices of all values that are read from the program."""
        tangent_values = self.tangent.main_values if self.tangent else ()
        return [*self.outputs.values(), *self.defect.values(), *tangent_values]


def step_map_of(hamiltonian: Hamiltonian, scheme: str) -> StepMap:
    """Return the scheme's map of a Hamiltonian, which is cached."""
    return get(scheme).step_map(hamiltonian)


@lru_cache(maxsize=64)
def computation_of(step_map: StepMap, request: StepRequest) -> Computation:
    """Return the requested computation of a map; the latest ones are cached."""
    return _Step(step_map, request).computation()


class _Step:
    """One computation while it is being written."""

    def __init__(self, step_map: StepMap, request: StepRequest) -> None:
        self.step_map, self.request = step_map, request
        needs_defect = request.defect
        shared = shared_part(step_map, request.pipelined, request.scaled, needs_defect)
        self.program, self.inputs = shared.program.copy(), shared.inputs
        self.names, self.forms = source_names(step_map.hamiltonian), dict(shared.forms)
        self.canonical = step_map.hamiltonian.has_energy
        self.preserved = not needs_defect or step_map.preserves_area
        self.closed_form = step_map.written_defect
        self.power = common_power(step_map) if request.scaled and needs_defect else 0
        self.points: set[int] = set()  # the coordinates of the points at which f is evaluated

    def computation(self) -> Computation:
        request, program, hamiltonian = self.request, self.program, self.step_map.hamiltonian
        changes = self.changes
        outputs = {f"d{name}": index for name, index in zip(self.names, changes, strict=True)}
        outputs["dj"] = program.constant(Fraction(0))
        # Without a closed form S is computed numerically from K, with some loss of digits.
        if not self.preserved and self.closed_form is None and self.canonical:
            self.forms = self.from_slopes()
        if "delta_j" in request.needs and self.forms:
            outputs["dj"] = self.volume()
        elif "delta_j" in request.needs and not self.preserved:
            outputs["dj"] = self.scale(change_of_determinant(program, self.slopes))
        if "determinant" in request.needs:
            outputs["det"] = self.determinant()
        if "carried" in request.needs and self.forms:
            outputs |= self.increments_of_matrices()
        elif "matrix" in request.needs:
            outputs |= self.increments_of_matrix()[1]
        for k, formula in enumerate(request.integrals):
            # Written last: its parts are mostly there already, for the slopes.
            integral = integral_of(hamiltonian, formula)
            outputs[f"e{k}"] = self.evaluator(integral.ring).evaluate(integral.element)
        tangent = None
        if request.tangent:
            tangent = Tangent(program)
            tangent.take([x for row in self.slopes for x in row], self.points)
        entries = self.forms if "symplectic" in request.needs else {}
        defect = {f"s_{a}_{b}": index for (a, b), index in entries.items()}
        return Computation(
            program, outputs, tangent, self.power, hamiltonian.symbols, hamiltonian.time_dependent,
            self.names, self.canonical, defect, self.slopes if request.slopes else [],
        )  # fmt: skip

    @cached_property
    def changes(self) -> list[int]:
        """The indices of z' − z."""
        step = self.step_map
        if step.step is not None:
            return [x.index for x in self.changes_of_step]
        return increments(self.evaluator(), step.flat.increments, self.inputs["h"])

    @cached_property
    def slopes(self) -> Matrix:
        """The indices of K = J − 1, row by row."""
        step = self.step_map
        if step.step is not None:
            return [list(x.gradient) for x in self.changes_of_step if isinstance(x, Dual)]
        evaluator, field = self.evaluator(), step.field
        rows = (field.gradient(x) for x in step.flat.increments)
        return [[evaluator.evaluate(x) for x in row] for row in rows]

    @cached_property
    def changes_of_step(self) -> list[ProgramValue]:
        """The values z' − z of a map that has a `step`, with derivatives if K is needed."""
        request, field = self.request, self.step_map.field
        plain = ProgramAlgebra(self.program, field, self.inputs, request.pipelined)
        self.points = plain.points
        needs_of_slopes = request.needs & {"determinant", "carried", "matrix"}
        needs_slopes = request.tangent or request.slopes or needs_of_slopes
        assert self.step_map.step is not None  # noqa: S101 - the caller checks it
        if needs_slopes or not self.preserved:
            return self.step_map.step(TangentAlgebra(plain, coordinates=len(self.names)))
        return self.step_map.step(plain)

    def evaluator(self, ring: Ring | None = None) -> Evaluator:
        ring = ring or self.step_map.ring
        return Evaluator(self.program, ring, self.inputs, self.request.pipelined)

    # -- S and what follows from it -----------------------------------------------------------

    def from_slopes(self) -> dict[Place, int]:
        """Return the entries of S, or of 2^s S, from K."""
        entries = defect_from_slopes(self.program, self.slopes)
        return {place: self.scale(index) for place, index in entries.items()}

    def scale(self, index: int) -> int:
        """Return a value, or 2^s times it."""
        if not self.request.scaled:
            return index
        return self.program.mul(self.program.input("kappa", static=True), index)

    def volume(self) -> int:
        """Return det J − 1, or 2^s (det J − 1)."""
        program, n = self.program, len(self.names) // 2
        pairs = [(i, n + i) for i in range(n)]
        # Σ S(p_i, q_i): one formula from the closed form, since terms may cancel between entries.
        pair_sum = self.forms[pairs[0]]
        if self.closed_form is None:
            for pair in pairs[1:]:
                pair_sum = program.add(pair_sum, self.forms[pair])
        elif n > 1:
            kappa = program.input("kappa", static=True) if self.request.scaled else None
            pair_sum = self.evaluator().evaluate(sum_of(self.closed_form, pairs, self.power), kappa)
        # Each entry has the factor 2^s, and a product of k entries 2^(k s): `down` = 2^−s removes
        # the excess.
        down = program.input("down", static=True) if self.request.scaled else None
        pfaffian = Pfaffian(program, lambda a, b: self.forms[a, b], down)
        return change_of_volume(pfaffian, n, pair_sum)

    def determinant(self) -> int:
        """Return det J in the plane as a d − b c, from the entries of J."""
        program, has_formulas = self.program, self.step_map.formulas is not None
        if has_formulas:
            evaluator, rows = self.evaluator(), self.step_map.flat.jacobian
            (a, b), (c, d) = [[evaluator.evaluate(x) for x in row] for row in rows]
        else:
            (a, b), (c, d) = self.slopes
            a, d = (program.add(program.quotient(1, 1), x) for x in (a, d))
        return program.add(program.mul(a, d), program.neg(program.mul(b, c)))

    def increments_of_matrix(self) -> tuple[Matrix, dict[str, int]]:
        """Return M, and its increments."""
        program, indices = self.program, range(len(self.names))
        matrix_m = [[program.input(f"m_{a}_{b}", static=False) for b in indices] for a in indices]
        change_m = multiply(program, self.slopes, matrix_m)
        return matrix_m, {f"dm_{a}_{b}": change_m[a][b] for a in indices for b in indices}

    def increments_of_matrices(self) -> dict[str, int]:
        """Return the increments of M and of W."""
        program, size = self.program, len(self.names)
        indices = range(size)
        matrix_m, outputs = self.increments_of_matrix()
        matrix = [[program.constant(Fraction(0))] * size for _ in indices]
        for (a, b), entry in self.forms.items():
            matrix[a][b], matrix[b][a] = entry, program.neg(entry)
        # W ← W + MᵀSM uses M before the step: the increment of M is applied later.
        right = multiply(program, matrix, matrix_m)
        for a, b in combinations(indices, 2):
            total = program.constant(Fraction(0))
            for c in indices:
                total = program.add(total, program.mul(matrix_m[c][a], right[c][b]))
            outputs[f"dw_{a}_{b}"] = total
        return outputs
