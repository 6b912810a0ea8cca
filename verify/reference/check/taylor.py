"""The operations of a tape on power series, coefficient by coefficient, in balls or in series of h.

Every rule is the textbook's: with u(t) = Σ u_k t^k, k·v_k of v = f(u) follows from v' = f'(u) u'
(Moore, Interval Analysis, 1966). The coefficients are flint's balls, or power series of balls in
another variable. flint's own functions of series want all coefficients of u at once; along a
solution each is known only when those before it have gone through H's derivatives.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint

from verify.reference.check.tape import PAIRS, Tape

Number = Any  # flint.arb or flint.arb_series
_VARIABLE = "variable"  # its first operand is its place among them
Work = tuple[int, str, Any, Any]  # node, kind, and two operands: nodes or a factor


def number(x: Fraction) -> Any:
    """A rational as flint's."""
    return flint.fmpq(x.numerator, x.denominator)


class Expansion:
    """The coefficients of some nodes along the tape's variables, as far as those have been given,
    and t.

    `constant`: nodes that depend on none of them; they have a first coefficient and no others.
    """

    def __init__(self, tape: Tape, roots: Sequence[int]) -> None:
        self.constant: set[int] = set()
        self._work: list[Work] = []
        self._fixed: dict[int, Number] = {}  # constants, in the precision that was in force
        self._bits = 0
        self.count = 0  # of coefficients that are known
        self.c: dict[int, list[Number]] = {}
        for x in tape.needed(*roots):
            kind, *args = tape.nodes[x]
            inner = [a for a in args if not isinstance(a, Fraction)]
            if kind not in tape.variables and all(a in self.constant for a in inner):
                self.constant.add(x)
            if kind in PAIRS:
                args.append(tape.node(PAIRS[kind], args[0]))
            elif kind == "scale":
                args[0] = number(args[0])
            elif kind in tape.variables:
                kind, args = _VARIABLE, [tape.variables.index(kind)]
            self._work.append((x, kind, *[*args, None, None][:2]))

    def begin(self, point: Sequence[Number]) -> None:
        """The first coefficients: the nodes' values at a point, its numbers in the order of the
        tape's variables, in flint's present precision."""
        if self._bits != flint.ctx.prec:
            self._fixed, self._bits = {}, flint.ctx.prec
        c: dict[int, list[Number]] = {}
        for x, kind, a, b in self._work:
            value = self._fixed.get(x)
            if value is None:
                value = point[a] if kind == _VARIABLE else _first(kind, a, b, c)
                if x in self.constant:
                    self._fixed[x] = value
            c[x] = [value]
        self.c, self.count = c, 1

    def more(self, point: Sequence[Number]) -> None:
        """The next coefficient of every node, the point's being those of all variables but t."""
        c, k, constant = self.c, self.count, self.constant
        for x, kind, a, b in self._work:
            if kind == _VARIABLE:
                c[x].append(point[a] if a < len(point) else flint.arb(int(k == 1)))
            elif x in constant:
                continue
            elif kind == "scale":
                c[x].append(c[b][k] * a)
            elif kind in ("add", "mul"):
                c[x].append(_of_two(kind, a, b, c, k, constant))
            else:
                c[x].append(_of_function(kind, a, b, c, c[x], k))
        self.count += 1

    def value(self, x: int) -> Number:
        """A node's first coefficient."""
        return self.c[x][0]

    def coefficient(self, x: int, k: int) -> Number:
        """The k-th coefficient of a node, None for a 0 that every constant has."""
        return self.c[x][k] if k == 0 or x not in self.constant else None


def _first(kind: str, a: Any, b: Any, c: dict[int, list[Number]]) -> Number:
    if kind == "const":
        return flint.arb(number(a))
    if kind == "pi":
        return flint.arb.pi()
    if kind == "scale":
        return c[b][0] * a
    if kind == "power":
        return _power(c[b][0], a)
    u = c[a][0]
    if kind == "add":
        return u + c[b][0]
    if kind == "mul":
        return u * c[b][0]
    if kind in ("sinh", "cosh") and not hasattr(u, kind):  # flint has it of no series
        up, down = u.exp(), (-u).exp()
        return (up - down if kind == "sinh" else up + down) / 2
    return getattr(u, kind)()


def _power(u: Number, exponent: Fraction) -> Number:
    if exponent.denominator == 1:
        return (1 / u) ** int(-exponent)  # a tape's other whole powers are products
    if not isinstance(u, flint.arb):
        return (u.log() * number(exponent)).exp()
    result = u.root(exponent.denominator) ** abs(exponent.numerator)
    return result if exponent > 0 else 1 / result


def _of_two(
    kind: str, x: int, y: int, c: dict[int, list[Number]], k: int, constant: set[int]
) -> Number:
    if x in constant:
        x, y = y, x
    u, v = c[x], c[y]
    if kind == "add":
        return u[k] if y in constant else u[k] + v[k]
    if y in constant:
        return u[k] * v[0]
    if x == y:
        total = 2 * sum((u[j] * u[k - j] for j in range(1, (k + 1) // 2)), u[0] * u[k])
        return total if k % 2 else total + u[k // 2] * u[k // 2]
    return sum((u[j] * v[k - j] for j in range(1, k + 1)), u[0] * v[k])


def _of_function(
    kind: str, a: Any, b: Any, c: dict[int, list[Number]], own: list[Number], k: int
) -> Number:
    if kind == "power":  # u v' = r v u'
        r, u = number(a), c[b]
        first = r * k * (u[k] * own[0])
        total = sum(((r * j - (k - j)) * (u[j] * own[k - j]) for j in range(1, k)), first)
        return total / (k * u[0])
    u = c[a]
    if kind in ("log", "atan"):  # w v' = u', w being u or 1 + u²
        w = u if kind == "log" else c[b]
        total = sum((j * (own[j] * w[k - j]) for j in range(1, k)), 0 * u[k])
        return (k * u[k] - total) / (k * w[0])
    other = own if kind == "exp" else c[b]  # v' = ± w u'
    total = sum((j * (u[j] * other[k - j]) for j in range(1, k)), k * (u[k] * other[0])) / k
    return -total if kind == "cos" else total
