"""Checks a certificate (see `verify.proof.certificates.every`) with dicts and fractions alone."""

import re
from fractions import Fraction
from math import factorial
from typing import Any

Poly = dict[tuple[str, ...], Fraction]  # sorted names → coefficient
Ball = tuple[Fraction, Fraction]  # middle, radius
NOUGHT, ONE = Fraction(0), Fraction(1)
SIGNS = {"sin": (0, 1, 0, -1), "cos": (1, 0, -1, 0), "exp": (1,)}  # of their Taylor series


def need(holds: object, what: str) -> None:
    if not holds:
        raise ValueError(what)


def single(*names: str) -> Poly:
    return {names: ONE}


def collected(terms: Any) -> Poly:
    total: Poly = {}
    for monomial, c in terms:
        key = tuple(sorted(monomial))
        total[key] = total.get(key, NOUGHT) + c
    return {m: c for m, c in total.items() if c}


def poly(data: Any) -> Poly:
    need(not any("h" in names for _, *names in data), "coefficients are free of h")
    return collected((tuple(names), Fraction(c)) for c, *names in data)


def add(x: Poly, y: Poly, scale: Fraction | int = 1) -> Poly:
    return collected([*x.items(), *((m, scale * c) for m, c in y.items())])


def mul(x: Poly, y: Poly) -> Poly:
    return collected((m + n, c * d) for m, c in x.items() for n, d in y.items())


class Algebra:
    """∂/∂p and ∂/∂q of every name: the free derivatives of H, or functions of given arguments."""

    def __init__(self, data: Any) -> None:
        self.free, self.separable = data["hamiltonian"] == "every", data.get("separable")
        self.images = {"p": {"p": single()}, "q": {"q": single()}}
        self.relations: dict[str, Poly] = {}
        self.made: dict[str, tuple[str, Poly]] = {}
        for name, kind, argument in data.get("functions", []):
            need(name not in ("p", "q", "h", *self.made) and not self.free, f"{name} is a new name")
            self.made[name] = kind, poly(argument)
        for name, (kind, u) in self.made.items():
            slope = self.slope(single(name), name, kind, u)
            for by in "pq":
                self.images[by][name] = mul(slope, self.diff(u, by))
        h = single("H_") if self.free else poly(data["hamiltonian"])
        self.h_p, self.h_q = self.diff(h, "p"), self.diff(h, "q")

    def slope(self, own: Poly, name: str, kind: str, u: Poly) -> Poly:
        if kind == "exp":
            return own
        if kind == "inverse":
            self.relations[name] = add(mul(own, u), single(), -1)
            return add({}, mul(own, own), -1)
        partner = {"sin": "cos", "cos": "sin"}[kind]
        side = next(single(n) for n, g in self.made.items() if g == (partner, u))
        self.relations[name] = add(add(mul(own, own), mul(side, side)), single(), -1)
        return add({}, side, 1 if kind == "sin" else -1)

    def image(self, name: str, by: str) -> Poly:
        if not (self.free and name.startswith("H_")):
            return self.images[by][name] if name in self.made else self.images[by].get(name, {})
        i, j = name.count("p") + (by == "p"), name.count("q") + (by == "q")
        return {} if self.separable and i and j else single("H_" + "p" * i + "q" * j)

    def diff(self, x: Poly, by: str) -> Poly:
        return collected(
            (monomial[:k] + monomial[k + 1 :] + m, c * d)
            for monomial, c in x.items()
            for k, name in enumerate(monomial)
            for m, d in self.image(name, by).items()
        )

    def lie_derivatives(self, x: Poly) -> Poly:
        return add(mul(self.h_p, self.diff(x, "q")), mul(self.h_q, self.diff(x, "p")), -1)

    def zero(self, x: Poly, cofactors: Any, what: str) -> None:
        for name, cofactor in cofactors.get(what, {}).items():
            x = add(x, mul(poly(cofactor), self.relations[name]), -1)
        need(not x, f"{what} is not zero")

    def value(self, x: Poly, at: dict[str, Ball]) -> Ball:
        total = NOUGHT, NOUGHT
        for monomial, c in x.items():
            term = c, NOUGHT
            for name in monomial:
                if name not in at:
                    at[name] = function(self.made[name][0], self.value(self.made[name][1], at))
                term = times(term, at[name])
            total = total[0] + term[0], total[1] + term[1]
        return total


def times(x: Ball, y: Ball) -> Ball:
    return x[0] * y[0], abs(x[0]) * y[1] + abs(y[0]) * x[1] + x[1] * y[1]


def function(kind: str, x: Ball) -> Ball:
    """By its Taylor series, with a bound of what is left out; 1/x with one of its slope."""
    if kind == "inverse":
        need(abs(x[0]) > x[1], "a denominator may be zero")
        return 1 / x[0], x[1] / (abs(x[0]) * (abs(x[0]) - x[1]))
    size, signs = abs(x[0]) + x[1] + 1, SIGNS[kind]
    last = int(4 * size) + 40
    terms = (signs[n % len(signs)] * x[0] ** n / factorial(n) for n in range(last))
    return sum(terms, NOUGHT), x[1] * 3 ** int(size + 1) + 2 * size**last / factorial(last)


def check(data: Any) -> None:
    """An exception unless every identity holds: a ValueError that names the one that does not."""
    if "stages" in data:  # (k, d, s, t): p' = p − h k H_q, q' = q + h d H_p at the shares s, t
        for k, d, s, t in (map(Fraction, row) for row in data["stages"]):
            # A J = B; both are I + h E D of det 1 + h b (d D₂ − k D₁) + h² k d D₁ D₂ (a c − b²)
            need((k == d or data["separable"]) and k * d * (1 - s - t) == 0, "det A is not det B")
        return
    a, order, leading = Algebra(data), data["order"], poly(data["leading"])
    zeros = data.get("cofactors", {})
    need(not leading if order is None else leading and order > 0, "the leading coefficient is zero")
    names = {n for m in leading for n in m} if a.free else set()
    need(all(re.fullmatch("[pq]|H_p*q*", n) for n in names), "a derivative has another name")
    agreed, last = data["convergence_order"], order or 2 * len(data["p_next"] + data["q_next"])
    series = {by: [poly(c) for c in data[f"{by}_next"] + [[]] * (last + agreed)] for by in "pq"}
    for by, flow in (("p", single("p")), ("q", single("q"))):
        for n in range(agreed + 1):
            a.zero(add(series[by][n], flow, Fraction(-1, factorial(n))), zeros, f"{by} {n}")
            flow = a.lie_derivatives(flow)
    slopes = {by: [(a.diff(c, "p"), a.diff(c, "q")) for c in series[by][: last + 1]] for by in "pq"}
    for n in range(1, last + 1):
        det = add({}, leading if n == order else {}, -1)
        for (p_p, p_q), (q_p, q_q) in zip(slopes["p"][: n + 1], slopes["q"][n::-1], strict=True):
            det = add(add(det, mul(p_p, q_q)), mul(p_q, q_p), -1)
        a.zero(det, zeros, f"det {n}")
    if order and not a.free:
        value = a.value(leading, {n: (Fraction(x), NOUGHT) for n, x in data["witness"].items()})
        need(abs(value[0]) > value[1], "the leading coefficient may be zero at the witness")
    if data.get("potential") is not None:
        a.zero(add(a.lie_derivatives(poly(data["potential"])), leading, -1), zeros, "potential")
