"""Linear stability of a scheme at an equilibrium of H, in one or more degrees of freedom.

The quadratic part of H at the equilibrium, with rational coefficients, gives the linear field A z.
The frequencies are the positive roots ω of det(A − iω), a polynomial in ω² with rational
coefficients; they are isolated exactly.

If the quadratic part is T(p) + V(q), both positive definite, a linear change of p and of q takes it
to a sum of oscillators (p² + ω²q²)/2. Our schemes treat all p alike and all q alike, so that they
make the same steps in the new coordinates. Powers of a step then stay bounded up to the h at which
the greatest hω reaches the end of the scheme's interval
(`verify.studies.stability.linear_stability`). Otherwise the matrix of a step decides it for each
requested h (`verify.studies.stability.step_matrix`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import flint
import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import known_digits
from verify.effort import limit_effort
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import check_start, coordinate_texts
from verify.schemes import get
from verify.studies.stability.linear_stability import LinearStability, NearbyLimit
from verify.studies.stability.positive_roots import PositiveRoot, positive_roots
from verify.studies.stability.scheme_interval import linear_stability
from verify.studies.stability.step_matrix import stays_bounded, step_matrix

_DIGITS = 30


@dataclass(frozen=True)
class Frequency:
    """A normal frequency ω with its multiplicity."""

    root: PositiveRoot
    multiplicity: int

    @property
    def closed_form(self) -> sympy.Expr | None:
        """A formula with square roots, where the frequency has one."""
        return self.root.closed_form()

    @property
    def exact(self) -> str:
        """The frequency as a formula, or as a root of a polynomial."""
        return self.root.describe("ω") if self.closed_form is None else str(self.closed_form)

    def decimal(self, digits: int = _DIGITS) -> str:
        """Return the frequency rounded to so many significant digits."""
        formula = self.closed_form
        return self.root.decimal(digits) if formula is None else str(formula.evalf(digits))


@dataclass(frozen=True)
class LinearAtEquilibrium:
    """The linear stability of a scheme at an equilibrium.

    `frequencies`: from the smallest on; fewer than n, with multiplicities, if motion near the
    equilibrium is not oscillation alone. `interval`: the scheme's, of hω, if H's quadratic part is
    a sum of oscillators; else None. `decided`: for each requested h True if powers of a step stay
    bounded, False if not, None if it is not decided.
    """

    scheme: str
    hamiltonian: Hamiltonian
    point: Mapping[str, Fraction]
    frequencies: tuple[Frequency, ...]
    interval: LinearStability | None
    decided: Mapping[Fraction, bool | None] = field(default_factory=dict)

    @property
    def oscillates(self) -> bool:
        """True if all n degrees of freedom have a frequency."""
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
        """Return the end of the steps, and its bound."""
        end, omega = interval.interval, Fraction(self.frequencies[-1].decimal(2 * _DIGITS))
        if isinstance(end, NearbyLimit):
            y, error = end.value, end.radius
        else:
            y, error = Fraction(interval.decimal(2 * _DIGITS)), Fraction(0)
        # Y and ω have a relative error of 10^−(2 · `_DIGITS`) each; 4 covers both and the rounding
        # of the quotient.
        bound = 4 * y / 10 ** (2 * _DIGITS) + error
        return known_digits(y / omega, bound / omega, _DIGITS)

    def allows(self, h: Fraction) -> bool:
        """Return True if every h ω is certainly within the interval."""
        if self.interval is None or self.step_size in ("0", "infinite"):
            return self.step_size == "infinite"
        limit, bound = map(Fraction, self._limit(self.interval))
        # The limit has `_DIGITS` digits and a bound; h must be below it by more than both.
        return h < limit * (1 - Fraction(1, 10 ** (_DIGITS - 1))) - 2 * bound

    @property
    def step_size_exact(self) -> str:
        """The end of the steps as a formula, where Y and ω have one; else empty."""
        if self.interval is None or self.step_size in ("0", "infinite"):
            return ""
        y, omega = self.interval.interval, self.frequencies[-1].closed_form
        if isinstance(y, PositiveRoot | NearbyLimit) or omega is None:
            return ""
        return str(sympy.radsimp(y / omega))


def linear_at_equilibrium(
    hamiltonian: Hamiltonian,
    scheme: str,
    point: Mapping[str, Fraction],
    step_sizes: Sequence[Fraction] = (),
) -> LinearAtEquilibrium:
    """Return the linear stability of a scheme at the equilibrium `point`, by coordinates' names.

    `step_sizes`: for each of them it is decided if powers of a step's matrix stay bounded.

    Raises InputError if H depends on time or a parameter has no value, if the point is none, for
    second derivatives that are not rational, and if only step sizes could be decided and none is
    given.
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
    result = LinearAtEquilibrium(scheme, hamiltonian, point, tuple(frequencies), interval)
    decisions: dict[Fraction, bool | None] = dict.fromkeys(step_sizes, True)
    # Beyond the interval powers may still stay bounded, as at isolated resonances: then the step's
    # own matrix decides.
    for h in (h for h in step_sizes if not result.allows(h)):
        step = step_matrix(scheme, _quadratic(hamiltonian, hessian), matrix, h)
        decisions[h] = None if step is None else stays_bounded(step)
    return replace(result, decided=decisions)


def hessian_at(hamiltonian: Hamiltonian, point: Mapping[str, Fraction]) -> flint.fmpq_mat:
    """Return H's second derivatives by p1 … pn, q1 … qn at an equilibrium."""
    if hamiltonian.time_dependent:
        raise InputError("hamiltonian", hamiltonian.formula, "depends on t; --linear takes no such")
    if hamiltonian.symbols:
        name = hamiltonian.symbols[0]
        raise InputError("parameter", name, f"has no value; give one, as {name}=1")
    names = [symbol(name) for name in hamiltonian.coordinates]
    q, p = (coordinate_texts(hamiltonian, point, letter) for letter in "qp")
    check_start(hamiltonian, q, p)
    point_values = {z: sympy.Rational(*point[z.name].as_integer_ratio()) for z in names}
    second_derivatives = flint.fmpq_mat(len(names), len(names))
    for i, z in enumerate(names):
        slope = sympy.diff(hamiltonian.exact, z)
        _check_equilibrium(slope, point_values, z.name)
        for j, partner in enumerate(names):
            if partner in slope.free_symbols:
                second = _evaluate(sympy.diff(slope, partner), point_values)
                if not second.is_Rational:
                    second_name = f"∂²H/∂{z.name}∂{partner.name}"
                    raise InputError(
                        second_name, str(second), "is not rational there; --linear needs that"
                    )
                second_derivatives[i, j] = flint.fmpq(int(second.p), int(second.q))
    return second_derivatives


def _check_equilibrium(
    slope: sympy.Expr, point_values: Mapping[sympy.Symbol, sympy.Rational], name: str
) -> None:
    value = _evaluate(slope, point_values)
    if value != 0:
        point_text = ", ".join(f"{z.name}={x}" for z, x in point_values.items())
        raise InputError(
            "q, p", point_text, f"is no equilibrium: ∂H/∂{name} = {value} there, not 0"
        )


def _evaluate(x: sympy.Expr, point_values: Mapping[sympy.Symbol, sympy.Rational]) -> sympy.Expr:
    with limit_effort("hamiltonian", str(x), "to evaluate this derivative of it"):
        return sympy.simplify(x.xreplace({z: point_values[z] for z in x.free_symbols}))


def _field_matrix(hessian: flint.fmpq_mat) -> flint.fmpq_mat:
    """Return A of the linear field z' = A z, with p' = −∂H/∂q and q' = ∂H/∂p."""
    size = hessian.nrows()
    n, rows = size // 2, hessian.tolist()
    field_rows = [[-x for x in row] for row in rows[n:]] + rows[:n]
    return flint.fmpq_mat(size, size, [x for row in field_rows for x in row])


def _quadratic(hamiltonian: Hamiltonian, hessian: flint.fmpq_mat) -> Hamiltonian:
    """Return H's quadratic part, whose step costs less; H itself where it lacks a coordinate."""
    names = [symbol(name) for name in hamiltonian.coordinates]
    rows = [[sympy.Rational(int(x.p), int(x.q)) for x in row] for row in hessian.tolist()]
    pairs = ((x, a, b) for row, a in zip(rows, names, strict=True)
             for x, b in zip(row, names, strict=True) if x)  # fmt: skip
    quadratic = Hamiltonian(sympy.Add(*(x * a * b / 2 for x, a, b in pairs)))
    return quadratic if quadratic.coordinates == hamiltonian.coordinates else hamiltonian


def _is_sum_of_oscillators(hessian: flint.fmpq_mat, n: int) -> bool:
    """Return True if the quadratic form is T(p) + V(q), both positive definite."""
    rows = hessian.tolist()
    has_mixed_terms = any(x for row in rows[:n] for x in row[n:])
    return not has_mixed_terms and all(
        _is_positive([row[k : k + n] for row in rows[k : k + n]]) for k in (0, n)
    )


def _is_positive(rows: list[list[flint.fmpq]]) -> bool:
    """Return True if a symmetric matrix is positive definite: if all pivots are positive."""
    for k in range(len(rows)):
        if rows[k][k] <= 0:
            return False
        for i in range(k + 1, len(rows)):
            if factor := rows[i][k] / rows[k][k]:
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return True


def _frequencies(matrix: flint.fmpq_mat) -> list[Frequency]:
    """Return the positive roots ω of det(A − iω), from the smallest on."""
    # The characteristic polynomial is one in λ², since λ and −λ are roots together. With λ = iω its
    # coefficients change their signs in turn, and odd powers of ω have coefficient 0.
    even = matrix.charpoly().coeffs()[::2]
    coefficients = [x for k, c in enumerate(even) for x in ((-1) ** k * c, 0)][:-1]
    polynomial = flint.fmpq_poly(coefficients).numer()
    times = {factor.repr(): m for factor, m in polynomial.factor()[1]}
    return [Frequency(x, times[x.polynomial.repr()]) for x, _ in positive_roots([polynomial])]
