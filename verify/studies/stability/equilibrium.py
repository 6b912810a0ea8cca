"""Linear stability of a scheme at an equilibrium of H, in one or more degrees of freedom.

The quadratic part of H at the equilibrium, with rational coefficients, gives the linear field A z.
Its frequencies are the positive roots ω of det(A − iω), a polynomial in ω² with rational
coefficients, which are isolated exactly.

Where that part is T(p) + V(q), and both are positive definite, a linear change of p and of q takes
it to a sum of oscillators (p² + ω²q²)/2. Our schemes do the same in the new coordinates, since they
treat all p alike and all q alike; so powers of a step stay bounded up to that h with which the
greatest ω reaches the end of the scheme's interval in hω (`verify.studies.stability.linear`).
Otherwise it is decided for a given h, by the matrix of a step
(`verify.studies.stability.step_matrix`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import flint
import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import known_digits
from verify.effort import limited
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import check_start, shown_of
from verify.schemes import get
from verify.studies.stability.linear import LinearStability, NearbyLimit
from verify.studies.stability.nearby_linear import linear_stability
from verify.studies.stability.positive_roots import PositiveRoot, positive_roots
from verify.studies.stability.step_matrix import stays_bounded, step_matrix

_DIGITS = 30


@dataclass(frozen=True)
class Frequency:
    """A normal frequency ω, so many times; `exact`: as a formula, or as a root of a polynomial."""

    root: PositiveRoot
    multiplicity: int

    @property
    def closed(self) -> sympy.Expr | None:
        """With square roots, where it has such a form."""
        return self.root.closed_form()

    @property
    def exact(self) -> str:
        return self.root.written("ω") if self.closed is None else str(self.closed)

    def decimal(self, digits: int = _DIGITS) -> str:
        """Rounded to so many significant digits."""
        closed = self.closed
        return self.root.decimal(digits) if closed is None else str(closed.evalf(digits))


@dataclass(frozen=True)
class LinearAtEquilibrium:
    """`frequencies`: from the smallest on; less than n of them, with multiplicities, where motion
    near the equilibrium is not oscillation alone. `interval`: of hω, where H's quadratic part is a
    sum of oscillators; else None. `decided`: whether powers of a step stay bounded, for each h that
    was asked for; None where it is not decided.
    """

    scheme: str
    hamiltonian: Hamiltonian
    point: Mapping[str, Fraction]
    frequencies: tuple[Frequency, ...]
    interval: LinearStability | None
    decided: Mapping[Fraction, bool | None] = field(default_factory=dict)

    @property
    def oscillates(self) -> bool:
        """Whether all n degrees of freedom have a frequency."""
        return sum(f.multiplicity for f in self.frequencies) == self.hamiltonian.degrees

    @property
    def step_size(self) -> str | None:
        """The end of the steps with bounded powers: decimal, "0" or "infinite"."""
        if self.interval is None:
            return None
        if self.interval.exact in ("0", "infinite"):
            return self.interval.exact
        return self._limit(self.interval)[0]

    def _limit(self, interval: LinearStability) -> tuple[str, str]:
        """The end of the steps, and its bound."""
        end, omega = interval.interval, Fraction(self.frequencies[-1].decimal(2 * _DIGITS))
        if isinstance(end, NearbyLimit):
            y, error = end.value, end.radius
        else:
            y, error = Fraction(interval.decimal(2 * _DIGITS)), Fraction(0)
        bound = 4 * y / 10 ** (2 * _DIGITS) + error
        return known_digits(y / omega, bound / omega, _DIGITS)

    def allows(self, h: Fraction) -> bool:
        """Whether every h ω is certainly within the interval."""
        if self.interval is None or self.step_size in ("0", "infinite"):
            return self.step_size == "infinite"
        limit, bound = map(Fraction, self._limit(self.interval))
        return h < limit * (1 - Fraction(1, 10 ** (_DIGITS - 1))) - 2 * bound

    @property
    def step_size_exact(self) -> str:
        """The same as a formula, where both have one; else empty."""
        if self.interval is None or self.step_size in ("0", "infinite"):
            return ""
        y, omega = self.interval.interval, self.frequencies[-1].closed
        if isinstance(y, PositiveRoot | NearbyLimit) or omega is None:
            return ""
        return str(sympy.radsimp(y / omega))


def linear_at_equilibrium(
    hamiltonian: Hamiltonian,
    scheme: str,
    point: Mapping[str, Fraction],
    step_sizes: Sequence[Fraction] = (),
) -> LinearAtEquilibrium:
    """At the equilibrium `point`, by the names of H's coordinates.

    Raises InputError where H depends on time or a parameter has no value, where the point is none,
    for second derivatives that are not rational, and where only step sizes could be decided and
    none is given.
    """
    if get(scheme).formulas:
        raise InputError("scheme", scheme, "is a formula; linear theory takes a named scheme")
    hessian = hessian_at(hamiltonian, point)
    get(scheme).step_map(hamiltonian)
    matrix = _field_matrix(hessian)
    splits = _is_sum_of_oscillators(hessian, hamiltonian.degrees)
    if not splits and not step_sizes:
        problem = "is needed: H's quadratic part there is no sum of oscillators T(p) + V(q)"
        raise InputError("step_sizes", NOT_GIVEN, problem)
    interval, frequencies = linear_stability(scheme) if splits else None, _frequencies(matrix)
    found = LinearAtEquilibrium(scheme, hamiltonian, point, tuple(frequencies), interval)
    decided: dict[Fraction, bool | None] = dict.fromkeys(step_sizes, True)
    for h in (h for h in step_sizes if not found.allows(h)):
        step = step_matrix(scheme, _quadratic(hamiltonian, hessian), matrix, h)
        decided[h] = None if step is None else stays_bounded(step)
    return replace(found, decided=decided)


def hessian_at(hamiltonian: Hamiltonian, point: Mapping[str, Fraction]) -> flint.fmpq_mat:
    """H's second derivatives by p1 … pn, q1 … qn at an equilibrium."""
    if hamiltonian.time_dependent:
        raise InputError("hamiltonian", hamiltonian.formula, "depends on t; --linear takes no such")
    if hamiltonian.symbols:
        name = hamiltonian.symbols[0]
        raise InputError("parameter", name, f"has no value; give one, as {name}=1")
    names = [symbol(name) for name in hamiltonian.coordinates]
    q, p = (shown_of(hamiltonian, point, letter) for letter in "qp")
    check_start(hamiltonian, q, p)
    at = {z: sympy.Rational(*point[z.name].as_integer_ratio()) for z in names}
    found = flint.fmpq_mat(len(names), len(names))
    for i, z in enumerate(names):
        slope = sympy.diff(hamiltonian.exact, z)
        _check_equilibrium(slope, at, z.name)
        for j, other in enumerate(names):
            if other in slope.free_symbols:
                second = _value(sympy.diff(slope, other), at)
                if not second.is_Rational:
                    what = f"∂²H/∂{z.name}∂{other.name}"
                    raise InputError(
                        what, str(second), "is not rational there; --linear needs that"
                    )
                found[i, j] = flint.fmpq(int(second.p), int(second.q))
    return found


def _check_equilibrium(
    slope: sympy.Expr, at: Mapping[sympy.Symbol, sympy.Rational], name: str
) -> None:
    value = _value(slope, at)
    if value != 0:
        shown = ", ".join(f"{z.name}={x}" for z, x in at.items())
        raise InputError("q, p", shown, f"is no equilibrium: ∂H/∂{name} = {value} there, not 0")


def _value(x: sympy.Expr, at: Mapping[sympy.Symbol, sympy.Rational]) -> sympy.Expr:
    with limited("hamiltonian", str(x), "to evaluate this derivative of it"):
        return sympy.simplify(x.xreplace({z: at[z] for z in x.free_symbols}))


def _field_matrix(hessian: flint.fmpq_mat) -> flint.fmpq_mat:
    """A: p' = −∂H/∂q and q' = ∂H/∂p."""
    size = hessian.nrows()
    n, rows = size // 2, hessian.tolist()
    turned = [[-x for x in row] for row in rows[n:]] + rows[:n]
    return flint.fmpq_mat(size, size, [x for row in turned for x in row])


def _quadratic(hamiltonian: Hamiltonian, hessian: flint.fmpq_mat) -> Hamiltonian:
    """The quadratic part, of which a step is made at less cost; H where it lacks a coordinate."""
    names = [symbol(name) for name in hamiltonian.coordinates]
    rows = [[sympy.Rational(int(x.p), int(x.q)) for x in row] for row in hessian.tolist()]
    pairs = ((x, a, b) for row, a in zip(rows, names, strict=True)
             for x, b in zip(row, names, strict=True) if x)  # fmt: skip
    made = Hamiltonian(sympy.Add(*(x * a * b / 2 for x, a, b in pairs)))
    return made if made.coordinates == hamiltonian.coordinates else hamiltonian


def _is_sum_of_oscillators(hessian: flint.fmpq_mat, n: int) -> bool:
    """Whether it is T(p) + V(q), both positive definite."""
    rows = hessian.tolist()
    mixed = any(x for row in rows[:n] for x in row[n:])
    return not mixed and all(
        _is_positive([row[k : k + n] for row in rows[k : k + n]]) for k in (0, n)
    )


def _is_positive(rows: list[list[flint.fmpq]]) -> bool:
    """Whether a symmetric matrix is positive definite: all pivots of elimination are."""
    for k in range(len(rows)):
        if rows[k][k] <= 0:
            return False
        for i in range(k + 1, len(rows)):
            if factor := rows[i][k] / rows[k][k]:
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return True


def _frequencies(matrix: flint.fmpq_mat) -> list[Frequency]:
    """The positive roots ω of det(A − iω), from the smallest on."""
    even = matrix.charpoly().coeffs()[::2]  # the field of an H: λ and −λ are roots together
    turned = [x for k, c in enumerate(even) for x in ((-1) ** k * c, 0)][:-1]
    polynomial = flint.fmpq_poly(turned).numer()
    times = {factor.repr(): m for factor, m in polynomial.factor()[1]}
    return [Frequency(x, times[x.polynomial.repr()]) for x, _ in positive_roots([polynomial])]
