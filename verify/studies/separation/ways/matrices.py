"""The links of W in n degrees of freedom, which is made of products of matrices.

W_N = MᵀΩM − Ω, M the product of N steps' Jacobians, is to n degrees what Λ is to one. Each of its
n (2n − 1) entries above the diagonal has a chain (`verify.studies.separation.chain`) of its own:

    W₀  exact arithmetic at the exact inputs
    W₁  exact arithmetic at the inputs rounded to float64
    W₂  the states that float64 steps to, bit by bit; the Jacobians at them and W exactly
    W₃  the Jacobians, or S, as float64 computes them, bit by bit; their products and W exactly
    W₄  products and W in float64 too, `w_working`

    W₄ = W₀ + (W₁ − W₀) + (W₂ − W₁) + (W₃ − W₂) + (W₄ − W₃)
       = truncation + input + trajectory + derivatives + product,

an equation of rationals, entry by entry. What is carried is in
`verify.studies.separation.ways.matrix_lines`: of a wide M W = MᵀΩM − Ω as exact rationals, and of
float64's M in float64, each entry a sum of 2n products from the left, p's row first, and then less
1 where Ω has one.

The rounding of a wide link is counted in `verify.studies.separation.ways.matrix_bounds`, except for
that of a clock.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any, ClassVar

from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.kernels.chunked_loop import ENTRIES
from verify.kernels.step.computation import Computation, Observed, computation_of, step_map_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.observables.observable import Need
from verify.scenes.results.separation import SeparationInDegrees
from verify.scenes.results.separation_parts import FormParts
from verify.schemes.maps.step_map import StepMap
from verify.studies.separation.stepper.run import marks_of
from verify.studies.separation.stepper.trail import Entries, Links, exact_links
from verify.studies.separation.stepper.way import Lines, Side, Size, State, SteppedRun, Way
from verify.studies.separation.ways.matrix_bounds import bound_entries
from verify.studies.separation.ways.matrix_lines import matrix_lines

POINTS = 512  # checkpoints of a run; each has a matrix for each link


@dataclass(frozen=True)
class Matrices(Way):
    """W = MᵀΩM − Ω of a run."""

    result: ClassVar = SeparationInDegrees
    observable: ClassVar = "symplectic_defect"
    observables: ClassVar = frozenset({"symplectic_defect", ENTRIES})
    points: ClassVar = POINTS
    parts: ClassVar = FormParts.rounding
    cancelled: ClassVar = 20
    products: ClassVar = 20
    hidden: ClassVar = 25
    vanishes: ClassVar = "S ≡ 0"

    # -- the kernel ---------------------------------------------------------------------------

    def step(self, step_map: StepMap, arithmetic: Arithmetic, exactly: bool) -> Computation:
        """Return the computation with K, and in float64 with S, M and W."""
        if exactly and arithmetic.absolute:
            raise UnsupportedError(f"{arithmetic.name} follows no matrices")
        form = not (exactly or step_map.preserves_area)
        needs: frozenset[Need] = frozenset({"symplectic", "carried"} if form else ())
        request = Observed(
            pipelined=arithmetic.pipelined, scaled=False, tangent=False, needs=needs, slopes=True
        )
        return computation_of(step_map, request)

    def lines(self, narrow: Side, wide: Side | None, clocked: Side | None) -> Lines:
        return matrix_lines(narrow, wide, clocked)

    # -- reading its states -------------------------------------------------------------------

    def read(self, state: State, name: str, arithmetic: Arithmetic) -> Entries:
        if name == "closed":
            return tuple(arithmetic.exact(x) for x in self._above(state, "w_closed"))
        matrix, one = self._whole_matrix(state, name, arithmetic)
        entries = entries_of_defect(lambda a, b: matrix[a][b], self.count, one * one)
        return tuple(Fraction(x, one * one) for x in entries)

    def plain(self, state: State) -> tuple[float, ...]:
        return entries_of_defect(lambda a, b: state[f"f_plain_{a}_{b}"], self.count)

    def closed_form(self, state: State) -> tuple[float, ...]:
        return self._above(state, "f_closed")

    def in_range(self, state: State) -> bool:
        norm = math.hypot(*(x for row in self._matrix(state, "f_plain") for x in row))
        return all(map(math.isfinite, (*self.plain(state), norm)))

    def size(self, state: State, arithmetic: Arithmetic) -> Size:
        return compute_size(*self._whole_matrix(state, "factors", arithmetic))

    def _matrix(self, state: State, name: str) -> list[list[Any]]:
        every = range(self.count)
        return [[state[f"{name}_{a}_{b}"] for b in every] for a in every]

    def _above(self, state: State, name: str) -> tuple[Any, ...]:
        """Return the entries above the diagonal, row by row."""
        return tuple(state[f"{name}_{a}_{b}"] for a, b in combinations(range(self.count), 2))

    def _whole_matrix(
        self, state: State, name: str, arithmetic: Arithmetic
    ) -> tuple[list[list[int]], int]:
        """Return a wide matrix as whole numbers over one denominator, as Fractions are slow."""
        exact = [[arithmetic.exact(x) for x in row] for row in self._matrix(state, f"w_{name}")]
        one = max(x.denominator for row in exact for x in row)  # of powers of 2
        return [[x.numerator * (one // x.denominator) for x in row] for row in exact], one

    # -- how far it is known ------------------------------------------------------------------

    def bounds(self, run: SteppedRun) -> Mapping[str, Fraction | None]:
        return bound_entries(run)

    def hidden_size(self, run: SteppedRun, name: str) -> Fraction:
        names = [n for n in run.last if n.startswith(f"w_{name}_")]
        size = Fraction(max(abs(float(state[n])) for state in run.states for n in names))
        return (1 + size * size) * Fraction(1, 1 << (run.arithmetic.bits - 4))

    # -- runs in exact arithmetic's stead -----------------------------------------------------

    def prove_links(self, run: KernelRun, exact: StepMap | None, digits: int) -> Links | None:
        """Return links of 0 where S ≡ 0 whatever the parameters are, else None."""
        if not step_map_of(run.hamiltonian, run.scheme).preserves_area:
            return None
        nothing = (Fraction(0),) * (self.count * (self.count - 1) // 2)
        return exact_links([nothing] * len(marks_of(run.steps, POINTS)), self.vanishes)

    def values(self, run: RunOutcome, last: Fraction) -> list[Entries]:
        names = [n for n in run.tangents[0] if n.startswith("w_")]
        return [tuple(note[n] for n in names) for note in run.tangents]


def entries_of_defect(entry: Callable[[int, int], Any], size: int, one: int = 1) -> tuple[Any, ...]:
    """Return the entries of MᵀΩM − Ω above the diagonal, row by row, in the entries' arithmetic.

    With `one`, M is scaled by the root of `one`, and the entries by `one`.
    """
    n, entries = size // 2, []
    for a, b in combinations(range(size), 2):
        total = entry(0, a) * entry(n, b) - entry(n, a) * entry(0, b)
        for i in range(1, n):
            total = total + entry(i, a) * entry(n + i, b)
            total = total - entry(n + i, a) * entry(i, b)
        entries.append(total - one if b == n + a else total)
    return tuple(entries)


def compute_size(matrix: Sequence[Sequence[int]], one: int) -> Size:
    """Return the sizes of `matrix`/`one`: ‖∧²M‖² = (‖M‖⁴ − ‖MᵀM‖²)/2."""
    columns, every = list(zip(*matrix, strict=True)), range(len(matrix))
    square = {
        (a, b): sum(x * y for x, y in zip(columns[a], columns[b], strict=True))
        for a in every
        for b in range(a, len(matrix))
    }
    norm = sum(square[a, a] for a in every)
    # MᵀM is symmetric: entries off the diagonal count twice in its norm.
    whole = sum((1 if a == b else 2) * x * x for (a, b), x in square.items())
    return Size(Fraction(norm, one**2), Fraction(norm * norm - whole, 2 * one**4))
