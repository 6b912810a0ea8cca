"""The operations of a tape on power series, coefficient by coefficient, in balls or in series of h.

Every rule is the textbook's: with u(t) = Σ u_k t^k, k·v_k of v = f(u) follows from v' = f'(u) u'
(Moore, Interval Analysis, 1966). The coefficients are flint's balls, or power series of balls in
another variable. flint's own functions of series take all coefficients of u at once; along a
solution each coefficient follows from the earlier ones, by the field.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint

from verify.reference.check.tape import PAIRS, FormulaTape

Number = Any  # flint.arb or flint.arb_series
_VARIABLE = "variable"  # the kind of all variables; the operand is the variable's index
Work = tuple[int, str, Any, Any]  # node, kind, and two operands: nodes or a factor


def number(x: Fraction) -> Any:
    """Return a rational as flint's."""
    return flint.fmpq(x.numerator, x.denominator)


class TapeExpansion:
    """The Taylor coefficients in t of some nodes, as far as those of the variables are supplied."""

    def __init__(self, tape: FormulaTape, roots: Sequence[int]) -> None:
        self._work: list[Work] = []
        self.c: dict[int, list[Number]] = {}
        for x in tape.nodes_below(*roots):
            kind, *args = tape.nodes[x]
            if kind in PAIRS:
                args.append(tape.node(PAIRS[kind], args[0]))
            elif kind in tape.variables:
                kind, args = _VARIABLE, [tape.variables.index(kind)]
            args = [number(a) if isinstance(a, Fraction) else a for a in args]
            self._work.append((x, kind, *[*args, None, None][:2]))

    def begin(self, point: Sequence[Number]) -> None:
        """Compute the first coefficients, the nodes' values at a point, in flint's precision.

        `point`: numbers in the order of the tape's variables.
        """
        self.c = {}
        for x, kind, a, b in self._work:
            self.c[x] = [point[a] if kind == _VARIABLE else _first_coefficient(kind, a, b, self.c)]

    def extend(self, point: Sequence[Number]) -> None:
        """Compute the next coefficient of every node; `point` has those of all variables but t."""
        for x, kind, a, b in self._work:
            k = len(self.c[x])
            if kind == _VARIABLE:
                self.c[x].append(point[a] if a < len(point) else flint.arb(int(k == 1)))
            else:
                self.c[x].append(_next_coefficient(kind, a, b, self.c, self.c[x], k))

    def value(self, x: int) -> Number:
        """Return a node's first coefficient."""
        return self.c[x][0]


def _first_coefficient(kind: str, a: Any, b: Any, c: dict[int, list[Number]]) -> Number:
    if kind == "const":
        return flint.arb(a)
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
    if kind in ("sinh", "cosh") and not hasattr(u, kind):  # flint lacks both for series
        up, down = u.exp(), (-u).exp()
        return (up - down if kind == "sinh" else up + down) / 2
    return getattr(u, kind)()


def _power(u: Number, exponent: flint.fmpq) -> Number:
    if exponent.q == 1:
        return (1 / u) ** int(-exponent.p)  # negative: on a tape positive powers are products
    if not isinstance(u, flint.arb):
        return (u.log() * exponent).exp()
    result = u.root(int(exponent.q)) ** abs(int(exponent.p))
    return result if exponent > 0 else 1 / result


def _next_coefficient(
    kind: str, a: Any, b: Any, c: dict[int, list[Number]], coefficients: list[Number], k: int
) -> Number:
    """Return the k-th coefficient of a node whose earlier ones are `coefficients`."""
    if kind in ("const", "pi"):
        return flint.arb(0)
    if kind == "scale":
        return c[b][k] * a
    if kind == "power":  # u v' = r v u'
        r, u = a, c[b]
        first = r * k * (u[k] * coefficients[0])
        total = sum(((r * j - (k - j)) * (u[j] * coefficients[k - j]) for j in range(1, k)), first)
        return total / (k * u[0])
    u = c[a]
    if kind == "add":
        return u[k] + c[b][k]
    if kind == "mul" and a == b:
        total = 2 * sum((u[j] * u[k - j] for j in range(1, (k + 1) // 2)), u[0] * u[k])
        return total if k % 2 else total + u[k // 2] * u[k // 2]
    if kind == "mul":
        return sum((u[j] * c[b][k - j] for j in range(1, k + 1)), u[0] * c[b][k])
    if kind in ("log", "atan"):  # w v' = u', w being u or 1 + u²
        w = u if kind == "log" else c[b]
        total = sum((j * (coefficients[j] * w[k - j]) for j in range(1, k)), 0 * u[k])
        return (k * u[k] - total) / (k * w[0])
    # exp, sin, cos, sinh and cosh: k v_k = ± Σ j u_j w_(k−j), where w is exp u itself or the other
    # of the pair.
    partner = coefficients if kind == "exp" else c[b]  # v' = ± w u'
    total = sum((j * (u[j] * partner[k - j]) for j in range(1, k)), k * (u[k] * partner[0])) / k
    return -total if kind == "cos" else total
