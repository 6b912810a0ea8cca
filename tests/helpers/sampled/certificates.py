"""Drawn certificates of proofs, and whether one says the truth, by sympy's derivatives.

In numbers of 60 digits at a point: for "every H" with a polynomial H of so high a degree that its
derivatives there are as good as free.
"""

import json
import math
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath
import sympy
from hypothesis import strategies as st

from tests.helpers.sampled.formulas import P, Q, polynomials, rationals
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.every import of_every
from verify.proof.certificates.one import of_one
from verify.proof.every import prove_every
from verify.proof.order import prove
from verify.proof.potential import potential_of
from verify.schemes import get

POINT = {P: sympy.Rational(3, 7), Q: sympy.Rational(-5, 11)}
TINY = mpmath.mpf(10) ** -30
FREE = sum(
    sympy.Rational((7 * i + 5 * j) ** 2 % 23 - 11, 1 + (i + j) % 5) * P**i * Q**j
    for i in range(8)
    for j in range(8)
    if 0 < i + j < 9
)
APART = FREE.subs(Q, 0) + FREE.subs(P, 0)
INVOLVED = (
    "cos({})",
    "sin({})",
    "exp({})",
    "1/(2 + ({})**2)",
    "exp(sin({}))",
    "cos({0})*sin({0})",
    "d*{}",
)
EVERY = (
    "lie1",
    "lie2",
    "lie3",
    "symplectic-euler",
    "stormer-verlet",
    "implicit-midpoint",
    "ruth3",
    "implicit-symplectic-euler",
    "explicit-midpoint",
)
Data = dict[str, Any]


def as_read(data: Data) -> Data:
    return json.loads(json.dumps(data))  # type: ignore[no-any-return]


@st.composite
def of_drawn(draw: st.DrawFn) -> Data:
    """The certificate of a drawn H, separable for a half of them, and a scheme."""
    separable = draw(st.booleans())
    inner = draw(polynomials("q" if separable else "pq", degree=2, most_terms=2))
    bent = draw(st.sampled_from(INVOLVED)).format(f"({inner})")
    text = f"p**2/2 + ({draw(rationals(4))})*{bent} + ({draw(rationals(3))})*q**3 + 5"
    scheme = get(draw(st.sampled_from(["lie1", "lie2", *["symplectic-euler"] * separable])))
    proof = prove(scheme.step_map(Hamiltonian.parse(text)), scheme)
    potential = potential_of(proof, scheme)
    data = as_read(of_one(proof, potential))
    assert (data["order"], data["convergence_order"]) == (proof.order, proof.convergence_order)
    assert all(data.get("cofactors", {}).values()), "what is zero as it stands has none"
    assert ("potential" in data) == (potential.potential is not None and proof.order is not None)
    needed = max(proof.order or 0, proof.convergence_order or 0) + 1
    assert proof.order is None or max(map(len, (data["p_next"], data["q_next"]))) <= needed
    return data


certificates = st.one_of(
    of_drawn(), of_drawn(), st.sampled_from(EVERY).map(lambda n: as_read(of_every(prove_every(n))))
)


# -- what a certificate says, by sympy ------------------------------------------------------------

Dual = tuple[Any, Any, Any]  # a value at the point, and its derivatives by p and q


def names_of(data: Data) -> dict[str, sympy.Expr]:
    known = {"p": P, "q": Q}
    for name, kind, argument in data.get("functions", []):
        u = expression(argument, known)
        known[name] = 1 / u if kind == "inverse" else getattr(sympy, kind)(u)
    return known


def expression(terms: list[list[str]], known: dict[str, sympy.Expr]) -> sympy.Expr:
    total = sympy.S.Zero
    for c, *names in terms:
        factors = [known.get(n, sympy.Symbol(n, real=True)) for n in names]
        total += sympy.prod(factors, sympy.Rational(c))
    return total


@cache
def number(x: sympy.Expr) -> Any:
    others = {s: sympy.Rational(2, 3) for s in x.free_symbols - {P, Q}}
    return mpmath.mpf(sympy.N(x.subs({**POINT, **others}), 60))


@cache
def dual(x: sympy.Expr) -> Dual:
    return number(x), number(x.diff(P)), number(x.diff(Q))


@cache
def of_flow(hamiltonian: sympy.Expr, start: sympy.Symbol, n: int) -> sympy.Expr:
    """Xⁿ of p or q."""
    if n == 0:
        return start
    y = of_flow(hamiltonian, start, n - 1)
    return hamiltonian.diff(P) * y.diff(Q) - hamiltonian.diff(Q) * y.diff(P)


def dual_of(terms: list[list[str]], known: dict[str, sympy.Expr]) -> Dual:
    """Of a polynomial in the names, by the product rule."""
    total = [mpmath.mpf(0)] * 3
    for c, *names in terms:
        term = [mpmath.mpf(Fraction(c).numerator) / Fraction(c).denominator, 0, 0]
        for n in names:
            x = dual(known.get(n, sympy.Symbol(n, real=True)))
            term = [term[0] * x[0], *(term[k] * x[0] + term[0] * x[k] for k in (1, 2))]
        total = [a + b for a, b in zip(total, term, strict=True)]
    return total[0], total[1], total[2]


def zero(x: Any) -> bool:
    return bool(abs(number(x) if isinstance(x, sympy.Expr) else x) < TINY)


def true(data: Data) -> bool:
    """Whether what it says holds, as far as one point shows it."""
    with mpmath.workdps(60):
        if "stages" in data:
            return all(preserved(*map(Fraction, r), data["separable"]) for r in data["stages"])
        return said_truly(data)


def said_truly(data: Data) -> bool:
    known = names_of(data)
    hamiltonian = APART if data.get("separable") else FREE
    if data["hamiltonian"] == "every":
        known |= free_derivatives(hamiltonian)
    else:
        hamiltonian = expression(data["hamiltonian"], known)
    order, agreed = data["order"], data["convergence_order"]
    length = max(len(data["p_next"]), len(data["q_next"]), agreed + 1)
    last = order or 2 * length
    series = [[dual_of(x, known) for x in data[n]] for n in ("p_next", "q_next")]
    series = [s + [dual_of([], known)] * (last + agreed + 1) for s in series]
    for start, own in zip((P, Q), series, strict=True):
        for n in range(agreed + 1):
            if not zero(own[n][0] - number(of_flow(hamiltonian, start, n)) / math.factorial(n)):
                return False
    leading = dual_of(data["leading"], known)[0]
    for n in range(1, last + 1):
        pairs = [(series[0][k], series[1][n - k]) for k in range(n + 1)]
        det = sum(x[1] * y[2] - x[2] * y[1] for x, y in pairs)
        if not zero(det - (leading if n == order else 0)):
            return False
    if order is None:
        return not data["leading"]
    if data["hamiltonian"] != "every":
        at = {sympy.Symbol(n, real=True): sympy.Rational(x) for n, x in data["witness"].items()}
        if zero(mpmath.mpf(sympy.N(expression(data["leading"], known).subs(at), 60))):
            return False
    if not data.get("potential"):
        return True
    _, by_p, by_q = dual_of(data["potential"], known)
    h_p, h_q = dual(hamiltonian)[1:]
    return zero(h_p * by_q - h_q * by_p - leading)


@cache
def free_derivatives(hamiltonian: sympy.Expr) -> dict[str, sympy.Expr]:
    powers = [(i, j) for i in range(7) for j in range(7 - i)]
    return {f"H_{'p' * i}{'q' * j}": hamiltonian.diff(P, i, Q, j) for i, j in powers}


def preserved(k: Fraction, d: Fraction, s: Fraction, t: Fraction, separable: bool) -> bool:
    """det A = det B of a stage with H_pp, H_pq, H_qq = 2, 3, 5 (2, 0, 5) at h = 1/7."""
    a, b, c, h = 2, 0 if separable else 3, 5, Fraction(1, 7)
    left = sympy.Matrix([[1 + h * k * b * s, h * k * c * t], [-h * d * a * s, 1 - h * d * b * t]])
    right = sympy.Matrix(
        [
            [1 - h * k * b * (1 - s), -h * k * c * (1 - t)],
            [h * d * a * (1 - s), 1 + h * d * b * (1 - t)],
        ]
    )
    return bool(left.det() == right.det())
