"""One step of a scheme with its Jacobian in n degrees of freedom, from the textbook's definition.

As `verify.reference.check.textbook` in the plane, and for numbers of any kind that has + − * /.
z = (p1 … pn, q1 … qn), z' = f(z, t) = (−∂H/∂q, ∂H/∂p), A = ∂f/∂z; matrices are lists of rows.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

import flint

from verify.reference.check.tape import Tape
from verify.reference.check.taylor import Expansion, Number, number
from verify.reference.check.textbook import SHEARS, TABLEAUS, UnknownSchemeError, polynomial

Vector = list[Number]
Matrix = list[list[Number]]
Step = Callable[[Vector, Number, Number], tuple[Vector, Matrix]]  # of z, h and t
_Rows = tuple[tuple[Fraction, ...], ...]


class FieldInDegrees:
    """f and A of one Hamiltonian, from its formula alone."""

    def __init__(self, formula: str, parameters: dict[str, Fraction], degrees: int) -> None:
        self.names = [f"{letter}{k}" for letter in "pq" for k in range(1, degrees + 1)]
        self.degrees, self.tape = degrees, Tape(parameters, (*self.names, "t"))
        self.h = tape_h = self.tape.read(formula)
        first = {name: self.tape.diff(tape_h, name) for name in self.names}
        momenta, places = self.names[:degrees], self.names[degrees:]
        diff = self.tape.diff
        self.f = [*(self.tape.scale(-1, first[q]) for q in places), *(first[p] for p in momenta)]
        self.a = [[diff(x, name) for name in self.names] for x in self.f]
        mixed = (diff(first[p], q) for p in momenta for q in places)
        self.separable = all(self.tape.value(x) == 0 for x in mixed)
        self.timed = any(self.tape.nodes[x] == ("t",) for x in self.tape.needed(tape_h))
        every = [x for row in self.a for x in row]
        self.first = Expansion(self.tape, self.f)
        self.both = Expansion(self.tape, [*self.f, *every])
        self.alone = Expansion(self.tape, [self.h])

    def point(self, z: Sequence[Number], t: Number) -> dict[str, Number]:
        """The coordinates by name, and t."""
        return dict(zip(self.names, z, strict=True)) | {"t": t}

    def energy(self, z: Sequence[Number], t: Number) -> Number:
        """H there."""
        self.alone.begin_at(self.point(z, t))
        return self.alone.value(self.h)

    def at(self, z: Sequence[Number], t: Number) -> tuple[Vector, Matrix]:
        """f and A there, at t."""
        self.both.begin_at(self.point(z, t))
        value = self.both.value
        return [value(x) for x in self.f], [[value(x) for x in row] for row in self.a]


def identity(size: int) -> Matrix:
    """The matrix 1."""
    return [[int(a == b) for b in range(size)] for a in range(size)]


def product(x: Matrix, y: Matrix) -> Matrix:
    """x y."""
    columns = list(zip(*y, strict=True))
    return [
        [sum((a * b for a, b in zip(row, column, strict=True)), 0) for column in columns]
        for row in x
    ]


def defect(j: Matrix) -> Matrix:
    """JᵀΩJ − Ω, Ω = Σ dp_i∧dq_i, entry by entry from its definition."""
    size, n = len(j), len(j) // 2

    def entry(a: int, b: int) -> Number:
        total = sum((j[i][a] * j[n + i][b] - j[n + i][a] * j[i][b] for i in range(n)), 0)
        return total - ((b == a + n) - (a == b + n))

    return [[entry(a, b) for b in range(size)] for a in range(size)]


def step_of(name: str, field: FieldInDegrees) -> Step:
    """The scheme's step. UnknownSchemeError names what is not recomputed."""
    if match := re.fullmatch(r"lie([0-9]+)", name, re.ASCII):
        return _lie(field, int(match[1]))
    if name == "euler":
        return _lie(field, 1)
    if name in TABLEAUS:
        return _runge_kutta(field, *TABLEAUS[name])
    if name in SHEARS:
        if not field.separable:
            raise UnknownSchemeError(f"{name} for an H that is not T(p) + V(q)")
        return _shears(field, SHEARS[name])
    raise UnknownSchemeError(f"{name} is not recomputed")


# -- the Lie-derivative scheme --------------------------------------------------------------------


def flow_series(field: FieldInDegrees, z: Vector, t: Number, order: int) -> list[Vector]:
    """The Taylor coefficients of z from t on, up to that order: (k+1) z_(k+1) = f_k."""
    found = [z]
    for _ in _orders(field, field.first, found, t, order):
        pass
    return found


def _orders(
    field: FieldInDegrees, known: Expansion, zs: list[Vector], t: Number, order: int
) -> Iterator[int]:
    """The orders 0 … order − 1 of `known`; after each, zs has the next coefficients."""
    zero = [0 * x for x in zs[0]]
    known.begin_at(field.point(zs[0], t))
    for k in range(order):
        if k > 0:
            known.more_at(dict(zip(field.names, zs[-1], strict=True)))
        slopes = [known.coefficient(x, k) for x in field.f]
        pairs = zip(slopes, zero, strict=True)
        zs.append([nothing if x is None else x / (k + 1) for x, nothing in pairs])
        yield k


def _lie(field: FieldInDegrees, eta: int) -> Step:
    """z' = Σ h^k z_k, and J the same sum of the variational equation M' = A M, M_0 = 1."""
    size = len(field.names)

    def step(z: Vector, h: Number, t: Number) -> tuple[Vector, Matrix]:
        zs, ms, a = [z], [identity(size)], []
        for k in _orders(field, field.both, zs, t, eta):
            every = [[field.both.coefficient(x, k) for x in row] for row in field.a]
            a.append([[0 if x is None else x for x in row] for row in every])
            terms = [product(a[j], ms[k - j]) for j in range(k + 1)]
            ms.append([[sum((m[r][c] for m in terms), 0) / (k + 1) for c in range(size)]
                       for r in range(size)])  # fmt: skip
        after = [polynomial([x[k] for x in zs], h) for k in range(size)]
        return after, [
            [polynomial([m[r][c] for m in ms], h) for c in range(size)] for r in range(size)
        ]

    return step


# -- Runge–Kutta, and compositions of shears ------------------------------------------------------


def _runge_kutta(field: FieldInDegrees, rows: _Rows, weights: tuple[Fraction, ...]) -> Step:
    """k_i = f(z + h Σ a_ij k_j), K_i = A(…) (1 + h Σ a_ij K_j), z' = z + h Σ b_i k_i."""
    size = len(field.names)

    def step(z: Vector, h: Number, t: Number) -> tuple[Vector, Matrix]:
        slopes: list[tuple[Vector, Matrix]] = []

        def moved(row: Sequence[Fraction]) -> tuple[Vector, Matrix]:
            point, matrix = list(z), identity(size)
            for b, (k, own) in zip(row, slopes, strict=True):
                by = h * number(b)
                point = [x + by * y for x, y in zip(point, k, strict=True)]
                matrix = [[x + by * y for x, y in zip(r, s, strict=True)]
                          for r, s in zip(matrix, own, strict=True)]  # fmt: skip
            return point, matrix

        for row in rows:
            at, m = moved(row)
            f, a = field.at(at, t + h * number(sum(row, Fraction(0))))
            slopes.append((f, product(a, m)))
        return moved(weights)

    return step


def _shears(field: FieldInDegrees, parts: Callable[[], list[tuple[str, Number]]]) -> Step:
    """p ← p − a h ∂V/∂q(q, s), q ← q + a h ∂T/∂p(p, s), and J's rows by A likewise."""
    n = field.degrees
    made: dict[int, list[tuple[str, Number]]] = {}

    def step(z: Vector, h: Number, t: Number) -> tuple[Vector, Matrix]:
        if flint.ctx.prec not in made:
            made[flint.ctx.prec] = parts()
        z, j, reads = list(z), identity(2 * n), {"kick": t, "drift": t}
        for kind, size in made[flint.ctx.prec]:
            f, a = field.at(z, reads[kind])
            own = h * size
            reads["drift" if kind == "kick" else "kick"] += own
            rows = range(n) if kind == "kick" else range(n, 2 * n)
            bent = product([a[k] for k in rows], j)
            for k, bend in zip(rows, bent, strict=True):
                z[k] = z[k] + own * f[k]
                j[k] = [x + own * y for x, y in zip(j[k], bend, strict=True)]
        return z, j

    return step
