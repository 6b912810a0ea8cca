"""One step of a scheme with its Jacobian, from the scheme's definition in the textbook.

All is written for numbers of any kind that has + − * /: flint's balls, and power series of balls in
h. z' = f(z, t) = (−H_q, H_p), and A = ∂f/∂(p, q). Sources as in `verify.schemes`; the coefficients
stand here once more. A step begins at t: its stages are at t + c h, c the sum of their row, and of
a splitting each part is at t + h times what the parts of the other kind before it add up to.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Any

import flint

from verify.reference.check.tape import Tape
from verify.reference.check.taylor import Expansion, Number, number

State = tuple[Number, Number]
Matrix = tuple[Number, Number, Number, Number]  # ∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q
Step = Callable[[Number, Number, Number, Number], tuple[State, Matrix]]  # of p, q, h and t
IDENTITY: Matrix = (1, 0, 0, 1)
_F = Fraction


class UnknownSchemeError(ValueError):
    """A scheme, or a scheme for such an H, that is not recomputed here."""


class Field:
    """f and A of one Hamiltonian, from its formula alone."""

    def __init__(self, formula: str, parameters: dict[str, Fraction]) -> None:
        self.tape = Tape(parameters)
        self.h = h = self.tape.read(formula)
        self.h_p, self.h_q = (self.tape.diff(h, name) for name in ("p", "q"))
        self.h_pp, self.h_pq = (self.tape.diff(self.h_p, name) for name in ("p", "q"))
        self.h_qq = self.tape.diff(self.h_q, "q")
        self.separable = self.tape.value(self.h_pq) == 0
        self.timed = any(self.tape.nodes[x] == ("t",) for x in self.tape.needed(h))
        self.first = Expansion(self.tape, (self.h_p, self.h_q))
        self.both = Expansion(self.tape, (self.h_p, self.h_q, self.h_pp, self.h_pq, self.h_qq))
        self.alone = Expansion(self.tape, (h,))
        self.of_p = Expansion(self.tape, (self.h_p, self.h_pp))
        self.of_q = Expansion(self.tape, (self.h_q, self.h_qq))

    def energy(self, p: Number, q: Number) -> Number:
        """H there, which does not depend on time."""
        self.alone.begin(p, q)
        return self.alone.value(self.h)

    def at(self, p: Number, q: Number, t: Number) -> tuple[State, Matrix]:
        """f and A there, at t."""
        known = self.both
        known.begin(p, q, t)
        pq = known.value(self.h_pq)
        a = (-pq, -known.value(self.h_qq), known.value(self.h_pp), pq)
        return (-known.value(self.h_q), known.value(self.h_p)), a


def step_of(name: str, field: Field) -> Step:
    """The scheme's step. UnknownSchemeError names what is not recomputed."""
    if match := re.fullmatch(r"lie([0-9]+)", name, re.ASCII):
        return lie(field, int(match[1]))
    if name == "euler":
        return lie(field, 1)
    if name in TABLEAUS:
        return runge_kutta(field, *TABLEAUS[name])
    if name in SHEARS:
        if not field.separable:
            raise UnknownSchemeError(f"{name} for an H that is not T(p) + V(q)")
        return shears(field, SHEARS[name])
    raise UnknownSchemeError(name)


# -- the Lie-derivative scheme: the Taylor polynomial of the flow ---------------------------------


def flow_series(
    field: Field, p: Number, q: Number, t: Number, order: int
) -> tuple[list[Any], list[Any]]:
    """The Taylor coefficients of p and q from t on, up to that order: (k+1) z_(k+1) = f_k."""
    ps, qs = [p], [q]
    for _ in _orders(field, field.first, ps, qs, t, order):
        pass
    return ps, qs


def _orders(
    field: Field, known: Expansion, ps: list[Number], qs: list[Number], t: Number, order: int
) -> Iterator[int]:
    """The orders 0 … order − 1 of `known`; after each, ps and qs have their next coefficient."""
    p, q = ps[0], qs[0]
    known.begin(p, q, t)
    for k in range(order):
        if k > 0:
            known.more(ps[-1], qs[-1])
        h_p, h_q = known.coefficient(field.h_p, k), known.coefficient(field.h_q, k)
        ps.append(0 * p if h_q is None else -h_q / (k + 1))
        qs.append(0 * q if h_p is None else h_p / (k + 1))
        yield k


def lie(field: Field, eta: int) -> Step:
    """z' = Σ h^k z_k, and J the same sum of the variational equation M' = A M, M_0 = 1."""
    entries = (field.h_pq, field.h_qq, field.h_pp)

    def step(p: Number, q: Number, h: Number, t: Number) -> tuple[State, Matrix]:
        ps, qs, ms = [p], [q], [IDENTITY]
        a: list[list[Number | None]] = []
        for k in _orders(field, field.both, ps, qs, t, eta):
            a.append([field.both.coefficient(x, k) for x in entries])
            ms.append(_variation(a, ms, k))
        z = polynomial(ps, h), polynomial(qs, h)
        return z, tuple(polynomial([m[i] for m in ms], h) for i in range(4))

    return step


def _variation(a: list[list[Number | None]], ms: list[Matrix], k: int) -> Matrix:
    """M_(k+1) = (Σ A_j M_(k−j))/(k+1)."""
    total: list[Number] = [0, 0, 0, 0]
    for j in range(k + 1):
        pq, qq, pp = a[j]
        m = ms[k - j]
        for i in (0, 1):  # the columns
            if pq is not None:
                total[i] -= pq * m[i]
                total[2 + i] += pq * m[2 + i]
            if qq is not None:
                total[i] -= qq * m[2 + i]
            if pp is not None:
                total[2 + i] += pp * m[i]
    return tuple(x / (k + 1) for x in total)


def polynomial(coefficients: Sequence[Number], h: Number) -> Number:
    """Σ c_k h^k, by Horner's rule."""
    total = coefficients[-1]
    for c in reversed(coefficients[:-1]):
        total = c + h * total
    return total


# -- Runge–Kutta ----------------------------------------------------------------------------------

_Rows = tuple[tuple[Fraction, ...], ...]
TABLEAUS: dict[str, tuple[_Rows, tuple[Fraction, ...]]] = {
    "explicit-midpoint": (((), (_F(1, 2),)), (_F(0), _F(1))),
    "rk4": (
        ((), (_F(1, 2),), (_F(0), _F(1, 2)), (_F(0), _F(0), _F(1))),
        (_F(1, 6), _F(1, 3), _F(1, 3), _F(1, 6)),
    ),
}


def runge_kutta(field: Field, rows: _Rows, weights: tuple[Fraction, ...]) -> Step:
    """k_i = f(z + h Σ a_ij k_j), K_i = A(…) (1 + h Σ a_ij K_j), z' = z + h Σ b_i k_i."""

    def step(p: Number, q: Number, h: Number, t: Number) -> tuple[State, Matrix]:
        slopes: list[tuple[Number, ...]] = []  # k_i, then K_i row by row

        def lie_derivatives(row: Sequence[Fraction]) -> list[Number]:
            total: list[Number] = [p, q, *IDENTITY]
            for b, slope in zip(row, slopes, strict=True):
                if b:
                    total = [x + h * (s * number(b)) for x, s in zip(total, slope, strict=True)]
            return total

        for row in rows:
            at_p, at_q, *m = lie_derivatives(row)
            f, a = field.at(at_p, at_q, t + h * number(sum(row, _F(0))))
            slopes.append((*f, *product(a, tuple(m))))
        z_p, z_q, *j = lie_derivatives(weights)
        return (z_p, z_q), tuple(j)

    return step


def product(x: Matrix, y: Matrix) -> Matrix:
    """x y, of matrices row by row."""
    a, b, c, d = x
    e, f, g, h = y
    return a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h


# -- compositions of shears -----------------------------------------------------------------------


def _yoshida() -> list[tuple[str, Number]]:
    """Störmer–Verlet steps of 1/(2 − 2^(1/3)) of h, what is left of 1, and the first again."""
    outer = 1 / (2 - flint.arb(2).root(3))
    steps = outer, 1 - 2 * outer, outer
    return [x for s in steps for x in (("kick", s / 2), ("drift", s), ("kick", s / 2))]


def _of(*parts: tuple[str, Fraction]) -> Callable[[], list[tuple[str, Number]]]:
    return lambda: [(kind, flint.arb(number(size))) for kind, size in parts]


_HALF, _ONE = _F(1, 2), _F(1)
SHEARS: dict[str, Callable[[], list[tuple[str, Number]]]] = {
    "symplectic-euler": _of(("kick", _ONE), ("drift", _ONE)),
    "stormer-verlet": _of(("kick", _HALF), ("drift", _ONE), ("kick", _HALF)),
    "position-verlet": _of(("drift", _HALF), ("kick", _ONE), ("drift", _HALF)),
    "yoshida4": _yoshida,
}


def shears(field: Field, parts: Callable[[], list[tuple[str, Number]]]) -> Step:
    """p ← p − a h V_q(q, s), q ← q + a h T_p(p, s), and J's rows by V_qq and T_pp likewise."""
    made: dict[int, list[tuple[str, Number]]] = {}

    def step(p: Number, q: Number, h: Number, t: Number) -> tuple[State, Matrix]:
        if flint.ctx.prec not in made:
            made[flint.ctx.prec] = parts()
        a, b, c, d = IDENTITY
        reads = {"kick": t, "drift": t}
        for kind, size in made[flint.ctx.prec]:
            known = field.of_q if kind == "kick" else field.of_p
            known.begin(p, q, reads[kind])
            own = h * size
            reads["drift" if kind == "kick" else "kick"] += own
            if kind == "kick":
                bend = own * known.value(field.h_qq)
                p = p - own * known.value(field.h_q)
                a, b = a - bend * c, b - bend * d
            else:
                bend = own * known.value(field.h_pp)
                q = q + own * known.value(field.h_p)
                c, d = c + bend * a, d + bend * b
        return (p, q), (a, b, c, d)

    return step
