"""One step of a scheme with its Jacobian, from the scheme's definition in the textbook.

The code takes numbers of any type that has + − * /: flint's balls, and power series of balls in h.
z = (p, q), or (p1 … pn, q1 … qn), z' = f(z, t) = (−∂H/∂q, ∂H/∂p), and A = ∂f/∂z; entries of A that
vanish identically are left out. The sources are those of `verify.schemes`; the coefficients are
repeated here. In a step that begins at t a stage's time is t + c h, c the sum of its row; the time
of a part of a splitting is t + h times the sum of the earlier parts of the other kind.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import combinations

import flint

from verify.reference.check.tape import FormulaTape
from verify.reference.check.taylor import Number, TapeExpansion, number

Vector = list[Number]
Matrix = list[Number]  # its entries, row by row
Step = Callable[[Vector, Number, Number], tuple[Vector, Matrix]]  # (z, h, t) ↦ (z', J)
_F = Fraction


class UnknownSchemeError(ValueError):
    """A scheme, or a scheme for such an H, is not recomputed here."""


class Rows:
    """Some rows of f, and the entries of A in them that do not vanish.

    `expansion` evaluates them at a point or expands them along a solution.
    """

    def __init__(
        self, tape: FormulaTape, f: dict[int, int], a: Iterable[tuple[int, int, int]]
    ) -> None:
        """`f`: nodes by their rows; `a`: row, column and node of each entry."""
        self.f, self.a = list(f.items()), [entry for entry in a if entry[0] in f]
        self.expansion = TapeExpansion(tape, [*f.values(), *(x for _, _, x in self.a)])


class TextbookField:
    """The field f and its derivative A of one Hamiltonian, from its formula alone."""

    def __init__(self, formula: str, parameters: dict[str, Fraction], degrees: int) -> None:
        numbers = [""] if degrees == 1 else range(1, degrees + 1)
        self.names = [f"{letter}{k}" for letter in "pq" for k in numbers]
        self.degrees, self.tape = degrees, FormulaTape(parameters, (*self.names, "t"))
        tape = self.tape
        self.h = h = tape.read(formula)
        momenta, displacements = self.names[:degrees], self.names[degrees:]
        slopes = [tape.scale(-1, tape.diff(h, q)) for q in displacements]
        slopes += [tape.diff(h, p) for p in momenta]
        f = dict(enumerate(slopes))
        derivatives = [
            (r, c, tape.diff(x, z)) for r, x in f.items() for c, z in enumerate(self.names)
        ]
        a = [entry for entry in derivatives if tape.value(entry[2]) != 0]
        # H = T(p, t) + V(q, t) exactly if ∂f/∂z has no entry of p by p, or of q by q.
        self.separable = all((row < degrees) != (column < degrees) for row, column, _ in a)
        self.time_dependent = any(tape.nodes[x] == ("t",) for x in tape.nodes_below(h))
        self.energy_expansion = TapeExpansion(tape, [h])
        self.slopes, self.all_rows = Rows(tape, f, []), Rows(tape, f, a)
        self.kick_rows = Rows(tape, {row: f[row] for row in range(degrees)}, a)
        self.drift_rows = Rows(tape, {row: f[row] for row in range(degrees, 2 * degrees)}, a)

    def energy(self, z: Sequence[Number], t: Number) -> Number:
        """Return H(z, t)."""
        self.energy_expansion.begin([*z, t])
        return self.energy_expansion.value(self.h)


def identity(size: int) -> Matrix:
    """Return the identity matrix."""
    return [int(k % (size + 1) == 0) for k in range(size**2)]


def defect(j: Matrix, degrees: int) -> dict[tuple[int, int], Number]:
    """Return the entries of JᵀΩJ − Ω above its diagonal, Ω = Σ dp_i∧dq_i.

    In one degree of freedom the only one is det J − 1.
    """
    half = 2 * degrees**2  # the number of entries in the rows of p
    # Pairs of rows, of p_i and of q_i: each contributes dp_i∧dq_i to the pulled-back form.
    rows = [(j[k : k + 2 * degrees], j[half + k :]) for k in range(0, half, 2 * degrees)]
    return {
        (a, b): sum((p[a] * q[b] - q[a] * p[b] for p, q in rows), -int(b == a + degrees))
        for a, b in combinations(range(2 * degrees), 2)
    }


def step_of(name: str, field: TextbookField) -> Step:
    """Return the scheme's step. Raises UnknownSchemeError for a scheme that is not recomputed."""
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


def flow_series(rows: Rows, z: Vector, t: Number, order: int) -> list[Vector]:
    """Return the Taylor coefficients of z at t up to that order, by (k+1) z_(k+1) = f_k.

    `rows`: all rows of f; afterwards its expansion has the coefficients of f and A.
    """
    zs, expansion = [z], rows.expansion
    expansion.begin([*z, t])
    for k in range(order):
        if k > 0:
            expansion.extend(zs[-1])
        zs.append([expansion.c[x][k] / (k + 1) for _, x in rows.f])
    return zs


def lie(field: TextbookField, eta: int) -> Step:
    """Return the step z' = Σ h^k z_k, with J = Σ h^k M_k of the variational equation M' = A M."""
    size, rows = len(field.names), field.all_rows

    def step(z: Vector, h: Number, t: Number) -> tuple[Vector, Matrix]:
        zs, ms = flow_series(rows, z, t, eta), [identity(size)]
        a = [(row, column, rows.expansion.c[x]) for row, column, x in rows.a]
        orders = [[(row, column, c[k]) for row, column, c in a] for k in range(eta)]
        for k in range(eta):
            total: Matrix = [0] * size**2
            for m, a_j in zip(reversed(ms), orders, strict=False):  # Σ A_j M_(k−j)
                _add_product(total, a_j, m, size)
            ms.append([x / (k + 1) for x in total])
        return polynomials(zs, h), polynomials(ms, h)

    return step


def polynomials(coefficients: list[Vector], h: Number) -> Vector:
    """Return Σ z_k h^k, of vectors, by Horner's rule."""
    *lower, total = coefficients
    for z in reversed(lower):
        total = _add_scaled(z, h, total)
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


def runge_kutta(field: TextbookField, rows: _Rows, weights: tuple[Fraction, ...]) -> Step:
    """Return the step z' = z + h Σ b_i k_i, k_i = f(z + h Σ a_ij k_j).

    J is by the same method for the variational equation.
    """
    size = len(field.names)

    def step(z: Vector, h: Number, t: Number) -> tuple[Vector, Matrix]:
        slopes: list[Vector] = []

        def stage_point(row: Sequence[Fraction]) -> Vector:
            total: Vector = [*z, *identity(size)]
            for b, slope in zip(row, slopes, strict=True):
                if b:
                    total = _add_scaled(total, h * number(b), slope)
            return total

        for row in rows:
            slopes.append(
                _slope(field.all_rows, stage_point(row), t + h * number(sum(row, _F(0))), size)
            )
        after = stage_point(weights)
        return after[:size], after[size:]

    return step


def _slope(rows: Rows, point: Vector, t: Number, size: int) -> Vector:
    """Return f, then A M row by row; `point`: z, then M row by row. Rows left out are 0."""
    expansion = rows.expansion
    expansion.begin([*point[:size], t])
    f, product = [0] * size, [0] * size**2
    for row, x in rows.f:
        f[row] = expansion.value(x)
    _add_product(product, [(r, c, expansion.value(x)) for r, c, x in rows.a], point[size:], size)
    return [*f, *product]


def _add_scaled(x: Vector, factor: Number, slope: Vector) -> Vector:
    """Return x + factor · slope."""
    return [a + factor * b for a, b in zip(x, slope, strict=True)]


def _add_product(
    total: Matrix, entries: Iterable[tuple[int, int, Number]], m: Matrix, size: int
) -> None:
    """Add A m to `total`; `entries`: row, column and value of A's entries that are not 0."""
    columns = range(size)
    for row, column, x in entries:
        row_start, factor_start = row * size, column * size
        for k in columns:
            total[row_start + k] += x * m[factor_start + k]


# -- compositions of shears -----------------------------------------------------------------------


def _yoshida() -> list[tuple[str, Number]]:
    """Return the parts of three Störmer–Verlet steps, of sizes γh, (1 − 2γ)h and γh.

    γ = 1/(2 − 2^(1/3)).

    H. Yoshida, Construction of higher order symplectic integrators, Phys. Lett. A 150 (1990) 262.
    """
    outer = 1 / (2 - flint.arb(2).root(3))
    steps = outer, 1 - 2 * outer, outer
    return [x for s in steps for x in (("kick", s / 2), ("drift", s), ("kick", s / 2))]


def _fixed_parts(*parts: tuple[str, Fraction]) -> Callable[[], list[tuple[str, Number]]]:
    return lambda: [(kind, flint.arb(number(size))) for kind, size in parts]


_HALF, _ONE = _F(1, 2), _F(1)
SHEARS: dict[str, Callable[[], list[tuple[str, Number]]]] = {
    "symplectic-euler": _fixed_parts(("kick", _ONE), ("drift", _ONE)),
    "stormer-verlet": _fixed_parts(("kick", _HALF), ("drift", _ONE), ("kick", _HALF)),
    "position-verlet": _fixed_parts(("drift", _HALF), ("kick", _ONE), ("drift", _HALF)),
    "yoshida4": _yoshida,
}


def shears(field: TextbookField, parts: Callable[[], list[tuple[str, Number]]]) -> Step:
    """Return the step of kicks p ← p − a h ∂V/∂q(q, s) and drifts q ← q + a h ∂T/∂p(p, s).

    J's rows are changed by A in the same way.
    """
    size = len(field.names)

    def step(z: Vector, h: Number, t: Number) -> tuple[Vector, Matrix]:
        point, clocks = [*z, *identity(size)], {"kick": t, "drift": t}
        for kind, share in parts():
            rows = field.kick_rows if kind == "kick" else field.drift_rows
            point = _add_scaled(point, h * share, _slope(rows, point, clocks[kind], size))
            # A part is evaluated at the time that the parts of the other kind have reached: this is
            # the splitting of the extended system in which t is a coordinate.
            clocks["drift" if kind == "kick" else "kick"] += h * share
        return point[:size], point[size:]

    return step
