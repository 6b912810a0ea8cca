"""Whether what a checked certificate prints is true, from the printed formulas alone.

In numbers of 100 digits, or more, at random points. Formulas are read by Python's own parser;
values carry their derivatives by p and q, and powers of h or t as truncated series. Nothing here
comes from `verify`: not the reading of formulas, not the arithmetic, not the flow.
"""

import ast
import random
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from mpmath.ctx_mp import MPContext

MP = MPContext()
DIGITS = 100
MP.dps = DIGITS
TOLERANCE = MP.mpf(10) ** -60
Data = Mapping[str, Any]  # what `verify certificate check --json` prints


class Series:
    """A power series in one variable, cut off: Σ c_n xⁿ."""

    def __init__(self, coefficients: Sequence[Any]) -> None:
        self.c = list(coefficients)

    def like(self, x: Any) -> "Series":
        return x if isinstance(x, Series) else Series([MP.mpf(x), *[MP.mpf(0)] * (len(self.c) - 1)])

    def __add__(self, other: Any) -> "Series":
        return Series([a + b for a, b in zip(self.c, self.like(other).c, strict=True)])

    def __neg__(self) -> "Series":
        return Series([-a for a in self.c])

    def __mul__(self, other: Any) -> "Series":
        # Constants are series of zeros but for one number: what is 0 is left out.
        own = [(k, x) for k, x in enumerate(self.c) if x]
        found = [MP.mpf(0)] * len(self.c)
        for m, y in enumerate(self.like(other).c):
            if y:
                for k, x in own:
                    if k + m < len(found):
                        found[k + m] += x * y
        return Series(found)

    def inverse(self) -> "Series":
        found: list[Any] = []
        for n in range(len(self.c)):
            known = sum((self.c[k] * found[n - k] for k in range(1, n + 1)), MP.mpf(0))
            found.append(((1 if n == 0 else 0) - known) / self.c[0])
        return Series(found)

    def of(self, kind: str) -> "Series":
        """exp, sin or cos, by f' = g u' with g the derivative of the function."""
        u = self.c
        other, sign = {"exp": ("exp", 1), "sin": ("cos", 1), "cos": ("sin", -1)}[kind]
        own, side = [getattr(MP, kind)(u[0])], [getattr(MP, other)(u[0])]
        for n in range(1, len(u)):
            slope = sum((k * u[k] * side[n - k] for k in range(1, n + 1)), MP.mpf(0)) / n
            back = sum((k * u[k] * own[n - k] for k in range(1, n + 1)), MP.mpf(0)) / n
            own.append(sign * slope)
            side.append(own[-1] if kind == "exp" else -sign * back)
        return Series(own)


@dataclass
class Dual:
    """A series with its derivatives by p and q."""

    v: Series
    p: Series
    q: Series

    def like(self, x: Any) -> "Dual":
        zero = self.v.like(0)
        return x if isinstance(x, Dual) else Dual(self.v.like(x), zero, zero)

    def __add__(self, other: Any) -> "Dual":
        o = self.like(other)
        return Dual(self.v + o.v, self.p + o.p, self.q + o.q)

    def __neg__(self) -> "Dual":
        return Dual(-self.v, -self.p, -self.q)

    def __mul__(self, other: Any) -> "Dual":
        o = self.like(other)
        return Dual(self.v * o.v, self.p * o.v + self.v * o.p, self.q * o.v + self.v * o.q)

    def chained(self, value: Series, slope: Series) -> "Dual":
        return Dual(value, slope * self.p, slope * self.q)

    def inverse(self) -> "Dual":
        one = self.v.inverse()
        return self.chained(one, -(one * one))

    def of(self, kind: str) -> "Dual":
        slope = {"exp": "exp", "sin": "cos", "cos": "sin"}[kind]
        by = self.v.of(slope)
        return self.chained(self.v.of(kind), -by if kind == "cos" else by)

    def power(self, n: int) -> "Dual":
        found, base = self.like(1), self
        while n:
            found, base, n = (found * base if n % 2 else found), base * base, n // 2
        return found


# -- reading formulas -----------------------------------------------------------------------------

Names = Mapping[str, Any]  # values, and functions of several arguments


def evaluate(formula: str, names: Names, zero: Dual) -> Dual:
    """The value of a printed formula; `zero` is a 0 of the kind that is wanted."""
    return _value(ast.parse(formula, mode="eval").body, names, zero)


def _value(node: ast.expr, names: Names, zero: Dual) -> Dual:
    value = partial(_value, names=names, zero=zero)
    match node:
        case ast.BinOp(left, ast.Pow(), ast.Constant(int(n))):
            return value(left).power(n)
        case ast.BinOp(left, op, right):
            one, two = value(left), value(right)
            match op:
                case ast.Add():
                    return one + two
                case ast.Sub():
                    return one + -two
                case ast.Mult():
                    return one * two
                case ast.Div():
                    return one * two.inverse()
        case ast.UnaryOp(ast.USub(), x):
            return -value(x)
        case ast.Constant(int(n)):
            return zero.like(n)
        case ast.Name(name):
            return zero.like(names[name])
        case ast.Call(ast.Name("O"), _):
            return zero
        case ast.Call(ast.Name(kind), [x]) if kind in ("sin", "cos", "exp"):
            return value(x).of(kind)
        case ast.Call(ast.Name(name), arguments):
            found: Dual = names[name](*map(value, arguments))
            return found
    raise AssertionError(ast.dump(node))


# -- H --------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Polynomial:
    """A polynomial H with random coefficients, whose derivatives at a point are as good as free."""

    terms: tuple[tuple[int, int, Any], ...]

    @classmethod
    def drawn(cls, rng: random.Random, degree: int, *, separable: bool) -> "Polynomial":
        powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
        kept = [(i, j) for i, j in powers if not (separable and i and j)]
        return cls(tuple((i, j, MP.mpf(rng.randint(-99, 99)) / 64) for i, j in kept))

    def derivative(self, m: int, n: int, p: Dual, q: Dual) -> Dual:
        """∂ᵐ/∂pᵐ ∂ⁿ/∂qⁿ H at (p, q)."""
        most = max(i + j for i, j, _ in self.terms)
        of_p, of_q = ([x.power(k) for k in range(most + 1)] for x in (p, q))
        total = p.like(0)
        for i in range(m, most + 1):
            inner = p.like(0)
            for j, c in ((j, c) for k, j, c in self.terms if k == i and j >= n):
                inner = inner + of_q[j - n] * (MP.ff(i, m) * MP.ff(j, n) * c)
            total = total + of_p[i - m] * inner
        return total


# -- what is said ---------------------------------------------------------------------------------


def is_true(said: Data, seed: int = 1, points: int = 3) -> bool:
    """Whether it holds at so many random points, and L is other than 0 at one of them."""
    rng = random.Random(seed)  # noqa: S311 - no secret
    with MP.workdps(_digits(said)):
        found = [_holds_at(said, rng) for _ in range(points)]
    return all(holds for holds, _ in found) and (
        said["area_preserving"] or any(not_zero for _, not_zero in found)
    )


def _digits(said: Data) -> int:
    """Enough where coefficients of thousands of digits are multiplied, and cancel."""
    longest = max(len(n) for name in ("p_next", "q_next") for n in re.findall(r"\d+", said[name]))
    return DIGITS + 12 * max(0, longest - 20)


def _holds_at(said: Data, rng: random.Random) -> tuple[bool, bool]:
    """(whether all of it holds at a random point, whether L is other than 0 there)."""
    if re.match(r"p1 = ", said["p_next"]):
        return _stages_hold(said, rng), True
    separable = "T(p) + V(q)" in said["hamiltonian"]
    every = said["hamiltonian"].startswith("every")
    powers = [int(n) for n in re.findall(r"h\*\*(\d+)", said["p_next"] + said["q_next"])]
    length = 2 * max([*powers, 1]) + 2
    agreed = said["convergence_order"] or 0
    point = [_drawn(rng) for _ in "pq"]
    zero = _constant(0, max(length, agreed + 1))
    p, q = (_variable(x, name, zero) for x, name in zip(point, "pq", strict=True))
    h = Series([MP.mpf(n == 1) for n in range(len(zero.v.c))])
    free = Polynomial.drawn(rng, 9, separable=separable)
    names: dict[str, Any] = {"p": p, "q": q, "h": _series(h, zero)}
    one = _constant(0, 1)
    alone = [_variable(x, name, one) for x, name in zip(point, "pq", strict=True)]
    for name in sorted(_names(said)):
        if every:
            m, n = name.count("p"), name.count("q")
            at = free.derivative(m, n, *alone)
            names[name] = Dual(*(zero.v.like(x.c[0]) for x in (at.v, at.p, at.q)))
        else:
            names[name] = zero.like(_drawn(rng))

    def hamiltonian(at_p: Dual, at_q: Dual) -> Dual:
        if every:
            return free.derivative(0, 0, at_p, at_q)
        own = {name: at_p.like(x.v.c[0]) for name, x in names.items() if name not in "pqh"}
        return evaluate(said["hamiltonian"], {**own, "p": at_p, "q": at_q}, at_p.like(0))

    p_next, q_next = (evaluate(said[name], names, zero) for name in ("p_next", "q_next"))
    leading = evaluate(said["leading"] or "0", names, zero)
    holds = _known_far_enough(said)
    holds &= _agrees(hamiltonian, (p, q), (p_next.v.c, q_next.v.c), agreed)
    det = (p_next.p * q_next.q + -(p_next.q * q_next.p)).c
    last = said["order"] or len(det) - 1
    wanted = [MP.mpf(n == 0) + leading.v.c[0] * (n == said["order"]) for n in range(last + 1)]
    holds &= all(map(_same, det, wanted))
    if said["potential"] is not None:
        g, at = evaluate(said["potential"], names, zero), hamiltonian(p, q)
        holds &= _same((at.p * g.q + -(at.q * g.p)).c[0], leading.v.c[0])
    return bool(holds), abs(leading.v.c[0]) > TOLERANCE


def _known_far_enough(said: Data) -> bool:
    """A map that is known up to O(h**n) has to say so, with n beyond all that is said of it."""
    cut = [re.findall(r"O\(h\*\*(\d+)\)", said[name]) for name in ("p_next", "q_next")]
    if said["order"] is None:
        return cut == [[], []]
    return all(int(*n) > max(said["order"], said["convergence_order"]) for n in cut)


def _agrees(
    hamiltonian: Callable[[Dual, Dual], Dual],
    start: tuple[Dual, Dual],
    found: tuple[Sequence[Any], Sequence[Any]],
    agreed: int,
) -> bool:
    """Whether the coefficients are those of the solution of p' = −H_q, q' = H_p, as series in t."""
    p, q = (_constant(x.v.c[0], agreed + 1) for x in start)
    one = p.like(1).v
    for _ in range(agreed):  # each iteration makes one more coefficient right
        at = hamiltonian(Dual(p.v, one, one.like(0)), Dual(q.v, one.like(0), one))
        p, q = (
            _series(Series([x.v.c[0], *(c / (n + 1) for n, c in enumerate(slope.c[:-1]))]), p)
            for x, slope in zip(start, (-at.q, at.p), strict=True)
        )
    return all(
        _same(a, b)
        for flow, own in ((p, found[0]), (q, found[1]))
        for a, b in zip(flow.v.c[: agreed + 1], own, strict=False)
    )


def _stages_hold(said: Data, rng: random.Random) -> bool:
    """det J = 1 of the stages' solution as a series in h, for a random polynomial H."""
    length = 6
    h_of = Polynomial.drawn(rng, 5, separable="T(p) + V(q)" in said["hamiltonian"])
    zero = _constant(0, length)
    names: dict[str, Any] = {
        "p": _variable(_drawn(rng), "p", zero),
        "q": _variable(_drawn(rng), "q", zero),
        "h": _series(Series([MP.mpf(n == 1) for n in range(length)]), zero),
        "H_p": partial(h_of.derivative, 1, 0),
        "H_q": partial(h_of.derivative, 0, 1),
    }
    pairs = zip(said["p_next"].split("; "), said["q_next"].split("; "), strict=True)
    last = ("p", "q")
    for one, two in pairs:
        (p_name, p_new), (q_name, q_new) = one.split(" = ", 1), two.split(" = ", 1)
        names |= {p_name: names[last[0]], q_name: names[last[1]]}
        for _ in range(length):  # each iteration makes one more power of h right
            found = evaluate(p_new, names, zero), evaluate(q_new, names, zero)
            names |= {p_name: found[0], q_name: found[1]}
        last = p_name, q_name
    p, q = names[last[0]], names[last[1]]
    det = (p.p * q.q + -(p.q * q.p)).c
    return all(_same(x, MP.mpf(n == 0)) for n, x in enumerate(det))


def _names(said: Data) -> set[str]:
    formulas = [said[n] or "" for n in ("p_next", "q_next", "leading", "potential")]
    if not said["hamiltonian"].startswith("every"):
        formulas.append(said["hamiltonian"])
    found = set(re.findall(r"[A-Za-z_]\w*", " ".join(formulas)))
    return found - {"p", "q", "h", "O", "sin", "cos", "exp"}


def _drawn(rng: random.Random) -> Any:
    return MP.mpf(rng.randint(1, 10**30)) / 10**30 * rng.choice([-1, 1])


def _constant(x: Any, length: int) -> Dual:
    zero = Series([MP.mpf(0)] * length)
    return Dual(zero.like(x), zero, zero)


def _series(x: Series, like: Dual) -> Dual:
    zero = like.v.like(0)
    return Dual(x, zero, zero)


def _variable(x: Any, name: str, zero: Dual) -> Dual:
    one, none = zero.v.like(1), zero.v.like(0)
    return Dual(zero.v.like(x), one if name == "p" else none, one if name == "q" else none)


def _same(x: Any, y: Any) -> bool:
    return bool(abs(x - y) <= TOLERANCE * (1 + abs(x) + abs(y)))
