"""Whether what a checked certificate prints is true, from the printed formulas alone.

In numbers of 100 digits, or more, at random points. Formulas are read by Python's own parser;
values carry their derivatives by p, q and t, and powers of h as truncated series; a number that is
said to be a root is found by Newton's method. Nothing here comes from `verify`: not the reading of
formulas, not the arithmetic, not the flow.
"""

import ast
import random
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial, reduce
from itertools import accumulate
from math import perm, prod
from operator import mul
from typing import Any

from tests.oracle.truncated_series import DIGITS, MP, Dual, Series

TOLERANCE = MP.mpf(10) ** -60
Data = Mapping[str, Any]  # what `verify certificate check --json` prints


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

    terms: tuple[tuple[int, int, int, Any], ...]

    @classmethod
    def drawn(
        cls, rng: random.Random, degree: int, *, separable: bool, timed: bool = False
    ) -> "Polynomial":
        powers = [
            (i, j, k)
            for i in range(degree + 1)
            for j in range(degree + 1 - i)
            for k in range(degree + 1 - i - j if timed else 1)
        ]
        kept = [each for each in powers if not (separable and each[0] and each[1])]
        return cls(tuple((*each, MP.mpf(rng.randint(-99, 99)) / 64) for each in kept))

    def derivative(self, orders: Sequence[int], *at: Dual) -> Dual:
        """∂ˡ/∂pˡ ∂ᵐ/∂qᵐ ∂ⁿ/∂tⁿ H at (p, q, t)."""
        most = max(i + j + k for i, j, k, _ in self.terms)
        powers = [list(accumulate([x] * most, mul, initial=x.like(1))) for x in at]
        total = at[0].like(0)
        for *term, c in self.terms:
            left = [own - n for own, n in zip(term, orders, strict=True)]
            if min(left) >= 0:
                factors = [x[n] for x, n in zip(powers, left, strict=True) if n]
                scale = c * prod(map(perm, term, orders))
                total = total + reduce(mul, factors or [at[0].like(1)]) * scale
        return total


# -- what is said ---------------------------------------------------------------------------------


def is_true(said: Data, seed: int = 1, points: int = 3) -> bool:
    """Whether it holds at so many random points, and L is other than 0 at one of them."""
    rng = random.Random(seed)  # noqa: S311 - no secret
    other_than_0 = bool(said["area_preserving"])
    with MP.workdps(_digits(said)):
        for _ in range(points):
            holds, not_zero = _holds_at(said, rng)
            if not holds:
                return False
            other_than_0 |= not_zero
    return other_than_0


def _digits(said: Data) -> int:
    """Enough where coefficients of thousands of digits are multiplied, and cancel."""
    texts = (said["p_next"], said["q_next"], *said["numbers"])
    longest = max(len(n) for text in texts for n in re.findall(r"\d+", text))
    return DIGITS + 12 * max(0, longest - 20)


def _holds_at(said: Data, rng: random.Random) -> tuple[bool, bool]:
    """(whether all of it holds at a random point, whether L is other than 0 there)."""
    if re.match(r"[pP]1 = ", said["p_next"]):
        return _stages_hold(said, rng), True
    every = said["hamiltonian"].startswith("every")
    timed = _timed(said)
    powers = [int(n) for n in re.findall(r"h\*\*(\d+)", said["p_next"] + said["q_next"])]
    length = 2 * max([*powers, 1]) + 2
    agreed = said["convergence_order"] or 0
    point = [_drawn(rng) for _ in ("pqt" if timed else "pq")]
    if not timed:
        point.append(MP.mpf(0))
    zero = _constant(0, max(length, agreed + 1))
    start = [_variable(x, name, zero) for x, name in zip(point, "pqt", strict=True)]
    h = Series([MP.mpf(n == 1) for n in range(len(zero.v.c))])
    free = Polynomial.drawn(rng, 7 if timed else 9, separable=_separable(said), timed=timed)
    names: dict[str, Any] = {**dict(zip("pqt", start, strict=True)), "h": _series(h, zero)}
    one = _constant(0, 1)
    alone = [_variable(x, name, one) for x, name in zip(point, "pqt", strict=True)]
    for name in sorted(_names(said)):
        if every:
            at = free.derivative([name.count(by) for by in "pqt"], *alone)
            names[name] = Dual(*(zero.v.like(x.c[0]) for x in (at.v, *at.slopes)))
        else:
            names[name] = zero.like(_drawn(rng))

    def hamiltonian(*at: Dual) -> Dual:
        if every:
            return free.derivative((0, 0, 0), *at)
        own = {name: at[0].like(x.v.c[0]) for name, x in names.items() if name not in "pqth"}
        return evaluate(said["hamiltonian"], {**own, **dict(zip("pqt", at, strict=True))},
                        at[0].like(0))  # fmt: skip

    p_next, q_next = (evaluate(said[name], names, zero) for name in ("p_next", "q_next"))
    leading = evaluate(said["leading"] or "0", names, zero)
    holds = _known_far_enough(said)
    holds &= _agrees(hamiltonian, start, (p_next.v.c, q_next.v.c), agreed)
    det = (p_next.p * q_next.q + -(p_next.q * q_next.p)).c
    last = said["order"] or len(det) - 1
    wanted = [MP.mpf(n == 0) + leading.v.c[0] * (n == said["order"]) for n in range(last + 1)]
    holds &= all(map(_same, det, wanted))
    if said["potential"] is not None:
        g, at = evaluate(said["potential"], names, zero), hamiltonian(*start)
        holds &= _same((at.p * g.q + -(at.q * g.p) + g.t).c[0], leading.v.c[0])
    return bool(holds), abs(leading.v.c[0]) > TOLERANCE


def _known_far_enough(said: Data) -> bool:
    """A map that is known up to O(h**n) has to say so, with n beyond all that is said of it."""
    cut = [re.findall(r"O\(h\*\*(\d+)\)", said[name]) for name in ("p_next", "q_next")]
    if said["order"] is None:
        return cut == [[], []]
    return all(int(*n) > max(said["order"], said["convergence_order"]) for n in cut)


def _agrees(
    hamiltonian: Callable[[Dual, Dual, Dual], Dual],
    start: Sequence[Dual],
    found: tuple[Sequence[Any], Sequence[Any]],
    agreed: int,
) -> bool:
    """Whether the coefficients are those of the solution of p' = −H_q, q' = H_p from t on."""
    p, q, t = (_constant(x.v.c[0], agreed + 1) for x in start)
    one, none = p.like(1).v, p.like(0).v
    t = Dual(Series([*t.v.c[:1], MP.mpf(1), *t.v.c[2:]][: agreed + 1]), none, none, one)
    for _ in range(agreed):  # each iteration makes one more coefficient right
        at = hamiltonian(Dual(p.v, one, none, none), Dual(q.v, none, one, none), t)
        p, q = (
            _series(Series([x.v.c[0], *(c / (n + 1) for n, c in enumerate(slope.c[:-1]))]), p)
            for x, slope in zip(start, (-at.q, at.p), strict=False)
        )
    return all(
        _same(a, b)
        for flow, own in ((p, found[0]), (q, found[1]))
        for a, b in zip(flow.v.c[: agreed + 1], own, strict=False)
    )


def _stages_hold(said: Data, rng: random.Random) -> bool:
    """det J = 1 of the stages' solution as a series in h, for a random polynomial H."""
    length = 6
    h_of = Polynomial.drawn(rng, 5, separable=_separable(said), timed=_timed(said))
    zero = _constant(0, length)
    names: dict[str, Any] = {
        "p": _variable(_drawn(rng), "p", zero),
        "q": _variable(_drawn(rng), "q", zero),
        "t": zero.like(_drawn(rng)) if _timed(said) else zero,
        "h": _series(Series([MP.mpf(n == 1) for n in range(length)]), zero),
    }
    made: dict[Any, tuple[Dual, Any]] = {}  # with its point, which so keeps its identity

    def derivative(orders: Sequence[int], *point: Dual) -> Dual:
        key = orders, *map(id, point)
        if key not in made:
            made[key] = h_of.derivative(orders, *point), point
        return made[key][0]

    for name, orders in {"H_p": (1, 0, 0), "H_q": (0, 1, 0)}.items():
        names[name] = lambda p, q, t=names["t"], n=orders: derivative(n, p, q, t)
    for number in said["numbers"]:
        name, value = _number(number)
        names[name] = zero.like(value)
    p, q = _solved(said, names, zero)
    det = (p.p * q.q + -(p.q * q.p)).c
    return all(_same(x, MP.mpf(n == 0)) for n, x in enumerate(det))


def _solved(said: Data, names: dict[str, Any], zero: Dual) -> tuple[Dual, Dual]:
    """The last p and q of equations: of stages one pair after the other, of a tableau all."""
    formulas = [said[name].split("; ") for name in ("p_next", "q_next")]
    pairs = [[x.split(" = ", 1) for x in pair] for pair in zip(*formulas, strict=True)]
    together = said["p_next"].startswith("P1 = ")
    before = ("p", "q")
    for group in [pairs] if together else [[pair] for pair in pairs]:
        for pair in group:
            names |= {new: names[old] for (new, _), old in zip(pair, before, strict=True)}
        for _ in range(len(zero.v.c)):  # each iteration makes one more power of h right
            names |= {n: evaluate(formula, names, zero) for pair in group for n, formula in pair}
        before = tuple(name for name, _ in group[-1])
    return names[before[0]], names[before[1]]


def _number(said: str) -> tuple[str, Any]:
    """The name, and the root in the interval: by Newton's method, or halving where that leaves."""
    found = re.fullmatch(r"(\w+) = the root of (.+) in \[(.+), (.+)\]", said)
    assert found, said
    name, polynomial, *ends = found.groups()
    low, high = (MP.mpf(int(a)) / int(b or 1) for a, _, b in (x.partition("/") for x in ends))

    def at(x: Any) -> Dual:
        return evaluate(polynomial, {name: _variable(x, "p", _constant(0, 1))}, _constant(0, 1))

    rising, x = at(high).v.c[0] > 0, (low + high) / 2
    assert (at(low).v.c[0] < 0) is rising, "two signs at the ends"
    for _ in range(100_000):
        value = at(x)
        low, high = (x, high) if (value.v.c[0] < 0) is rising else (low, x)
        slope = value.p.c[0]
        new = x - value.v.c[0] / slope if slope else low
        new = new if low < new < high else (low + high) / 2
        if abs(new - x) <= MP.eps * 100 * (1 + abs(x)):
            return name, new
        x = new
    raise AssertionError(said)


def _names(said: Data) -> set[str]:
    formulas = [said[n] or "" for n in ("p_next", "q_next", "leading", "potential")]
    if not said["hamiltonian"].startswith("every"):
        formulas.append(said["hamiltonian"])
    found = set(re.findall(r"[A-Za-z_]\w*", " ".join(formulas)))
    return found - {"p", "q", "t", "h", "O", "sin", "cos", "exp"}


def _timed(said: Data) -> bool:
    """Whether t is a variable: of every H that is said, and of one H it stands there or not."""
    if said["hamiltonian"].startswith("every"):
        return "t)" in said["hamiltonian"]
    formulas = (said[n] or "" for n in ("hamiltonian", "p_next", "q_next", "leading", "potential"))
    return any(re.search(r"\bt\b", formula) for formula in formulas)


def _separable(said: Data) -> bool:
    return bool(re.search(r"T\(p(, t)?\) \+ V\(q(, t)?\)", said["hamiltonian"]))


def _drawn(rng: random.Random) -> Any:
    return MP.mpf(rng.randint(1, 10**30)) / 10**30 * rng.choice([-1, 1])


def _constant(x: Any, length: int) -> Dual:
    zero = Series([MP.mpf(0)] * length)
    return Dual(zero.like(x), zero, zero, zero)


def _series(x: Series, like: Dual) -> Dual:
    zero = like.v.like(0)
    return Dual(x, zero, zero, zero)


def _variable(x: Any, name: str, zero: Dual) -> Dual:
    one, none = zero.v.like(1), zero.v.like(0)
    return Dual(zero.v.like(x), *(one if by == name else none for by in "pqt"))


def _same(x: Any, y: Any) -> bool:
    return bool(abs(x - y) <= TOLERANCE * (1 + abs(x) + abs(y)))
