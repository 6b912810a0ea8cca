"""An initial value problem with its exact solution, and the errors of states against it."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import isqrt

from verify.algebra.enclosure import enclose
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.exact import decimal
from verify.flows.solution import ExactSolution, Point, solution_from
from verify.hamiltonians.canonical_field import energy_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.bounded_value import Value
from verify.structures import AREA, SYMPLECTIC
from verify.studies.work_precision.peers import InitialValueProblem

SHOWN = 12  # the most printed digits of an error
# Digits of the exact solution, more than float64's 16. In n degrees of freedom most solutions have
# no closed form, and each further digit takes time.
_REFERENCE_DIGITS = {AREA: 33, SYMPLECTIC: 20}
_ENERGY_BITS = 400  # the precision of the balls that enclose H
_ROOT_BITS = 160  # the precision of a distance, the root of a sum of squares
State = tuple[Fraction, ...]  # p1 … pn, q1 … qn


def reference(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, t0: Fraction
) -> ExactSolution:
    """Return the exact solution that errors are measured from; NoFlowError if it is not reached."""
    return solution_from(hamiltonian, point, time, _REFERENCE_DIGITS[hamiltonian.structure], t0)


@dataclass(frozen=True)
class ReferenceProblem(InitialValueProblem):
    """An initial value problem with its exact solution at its final time."""

    solution: ExactSolution

    @classmethod
    def with_solution(
        cls, problem: InitialValueProblem, solution: ExactSolution
    ) -> "ReferenceProblem":
        """Return the problem with its solution."""
        return cls(**vars(problem), solution=solution)

    @cached_property
    def _ends(self) -> dict[Fraction, ExactSolution]:
        return {self.time: self.solution}

    def solution_after(self, h: Fraction) -> ExactSolution:
        """Return the exact solution after N·h, N = T/h rounded down, where the steps end."""
        # Where h does not divide T the run ends before T, and is compared with the solution there.
        end = self.time // h * h
        if end not in self._ends:
            self._ends[end] = reference(self.hamiltonian, self.point, end, self.t0)
        return self._ends[end]

    @property
    def start(self) -> State:
        """The initial values of p1 … pn, q1 … qn."""
        return tuple(self.point.values())

    @cached_property
    def _energy(self) -> tuple[Ring, Poly]:
        return energy_of(self.hamiltonian)

    @property
    def scale(self) -> str:
        """The greater |z| of the orbit's two ends."""
        ends = self.start, tuple(self.solution.point.values())
        return decimal(max(size(z) for z in ends), 3)

    def error(self, state: State, h: Fraction | None = None) -> tuple[Fraction, Fraction]:
        """Return |state − z(T)| with its bound; with h, the distance from z(N·h)."""
        solution = self.solution if h is None else self.solution_after(h)
        difference, root_error = distance(state, tuple(solution.point.values()))
        return difference, root_error + len(state) * solution.bound  # the bound is of a coordinate

    def energy_error(self, state: State) -> Value | None:
        """Return |H(state) − H(z₀)|.

        None if H is not defined or too large at one of the two, and if it depends on time, as the
        motion then does not keep it.
        """
        if self.hamiltonian.time_dependent:
            return None
        ring, energy = self._energy
        ends = [
            enclose(ring, energy, dict(zip(self.point, end, strict=True)), _ENERGY_BITS)
            for end in (state, self.start)
        ]
        usable = [x for x in ends if x is not None and is_representable(x)]
        if len(usable) < len(ends):
            return None
        (a, a_bound), (b, b_bound) = map(midpoint_and_radius, usable)
        return Value.from_bound(abs(a - b), a_bound + b_bound, SHOWN)


def size(state: State) -> Fraction:
    """Return the Euclidean norm of a state."""
    return distance(state, (Fraction(0),) * len(state))[0]


def distance(x: State, y: State) -> tuple[Fraction, Fraction]:
    """Return the Euclidean |x − y|, with a bound of the root's error."""
    square = sum(((a - b) ** 2 for a, b in zip(x, y, strict=True)), Fraction(0))
    if square == 0:
        return square, square
    # An even shift that leaves the root enough bits, however small the square is.
    bits = square.denominator.bit_length() - square.numerator.bit_length()
    half = _ROOT_BITS + max(0, bits)
    root = isqrt((square.numerator << 2 * half) // square.denominator)
    return Fraction(root, 1 << half), Fraction(1, 1 << half)
