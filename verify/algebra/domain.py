"""Where a formula is defined: conditions on p, q, h and the parameters, in few and simple ones."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from itertools import groupby

from verify.algebra.embedding import embed
from verify.algebra.enclosure import Ball, enclose, points
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.requirement import Relation, Requirement
from verify.algebra.ring import Decision, Poly, Ring
from verify.algebra.zero_test import witness
from verify.effort import limited, unless_long
from verify.errors import InputError
from verify.late import sympy
from verify.prose import Formula, Prose, joined, prose

_SIGNS = {"!=": "≠", ">=": "≥", ">": ">", "<=": "≤", "<": "<"}
_REVERSED = {"!=": "!=", ">=": "<=", ">": "<"}
_PRECISION = 128


@dataclass(frozen=True)
class Domain:
    """All points at which every requirement holds, and every one of `words` is true.

    `words`: what is no inequality, such as that the equations of an implicit scheme have a
    solution.
    """

    requirements: tuple[Requirement, ...] = ()
    words: tuple[str, ...] = ()

    @classmethod
    def of(cls, requirements: Iterable[Requirement], *words: str) -> Domain:
        """The domain in its simplest terms; what always holds is left out."""
        simple = {r for each in requirements for r in _simplified_soon(each)}
        return cls(tuple(_merged(simple)), tuple(dict.fromkeys(words)))

    def __and__(self, other: Domain) -> Domain:
        if not other:
            return self
        return Domain.of((*self.requirements, *other.requirements), *self.words, *other.words)

    def __bool__(self) -> bool:
        """Whether there is any condition."""
        return bool(self.requirements or self.words)

    @cached_property
    def texts(self) -> tuple[str, ...]:
        """One text for each condition, such as `q >= 0`."""
        return (*(" ".join(_sides(r)) for r in self.requirements), *self.words)

    @property
    def shown(self) -> list[str]:
        """Each requirement in the signs of mathematics, such as q ≥ 0."""
        return [str(_shown(r)) for r in self.requirements]

    @property
    def prose(self) -> Prose:
        """The conditions in one line: q ≥ 0, δ ≠ 0."""
        shown = [_shown(r) for r in self.requirements]
        return joined(", ", [*shown, *self.words])

    @property
    def names(self) -> set[str]:
        """The variables that the requirements speak of."""
        return {s.name for r in self.requirements for s in r.expression.free_symbols}

    @cached_property
    def _elements(self) -> tuple[Ring, list[Poly]]:
        return embed([r.expression for r in self.requirements], sorted(self.names))

    def replaced(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> Domain:
        """The domain with these values put in; InputError where a requirement then fails."""
        if not values or not self.requirements:
            return self
        with limited("domain", ", ".join(self.texts), "to put a value in"):
            put = [r._replace(expression=r.expression.xreplace(values)) for r in self.requirements]
        for before, after in zip(self.requirements, put, strict=True):
            if after.expression.is_number and _holds_of_number(after) is False:
                shown = ", ".join(f"{name} = {value}" for name, value in values.items())
                raise InputError("parameter", shown, f"is outside of {' '.join(_sides(before))}")
        return Domain.of(put, *self.words)

    def contains(self, point: Mapping[str, Fraction]) -> bool | None:
        """Whether all requirements hold at the point; None where that is not decided.

        The point gives a value to each of `names`.
        """
        if not self.requirements:
            return True
        ring, elements = self._elements
        answers = [
            holds(enclose(ring, x, point, _PRECISION), r.relation)
            for x, r in zip(elements, self.requirements, strict=True)
        ]
        return False if False in answers else None if None in answers else True

    def signs(self, point: Mapping[str, Fraction]) -> list[int | None]:
        """Of each requirement's expression at the point, 1, 0 or −1; None where it is not known."""
        ring, elements = self._elements
        return [_sign(enclose(ring, x, point, _PRECISION)) for x in elements]

    def left_since(self, before: Sequence[int | None], point: Mapping[str, Fraction]) -> list[str]:
        """The conditions that do not hold all the way to the point from where the signs were those
        `before`: they fail there, or what is not to be 0 has the other sign."""
        return [
            str(_shown(r))
            for r, one, other in zip(self.requirements, before, self.signs(point), strict=True)
            if (other == -1 and r.relation != "!=") or (one and other == -one)
        ]

    def decide(self, ring: Ring, x: Poly) -> Decision:
        """Whether x is zero in this domain, shown by a point of it; None where none is found.

        A point outside refutes nothing that is said of the domain, and where it has no point
        nothing is said at all.
        """
        decision = ring.decide(x)
        if decision.zero is None or not self.requirements:
            return decision
        own = [g.name for g in ring.generators_in(x) if g.kind == "variable"]
        points = self._points(list(dict.fromkeys((*own, *sorted(self.names)))))
        if decision.zero:
            return Decision(None) if next(points, None) is None else decision
        return witness(partial(enclose, ring, x), points, _PRECISION) or Decision(None)

    def _points(self, names: Sequence[str]) -> Iterator[dict[str, Fraction]]:
        """Points of the domain: small ones, and such as lie about the ends of its conditions."""
        ends = {
            symbol.name: Fraction(int(root.p), int(root.q))
            for r in self.requirements
            for symbol in r.expression.free_symbols
            if r.expression.free_symbols == {symbol}
            for root in _root_of_linear(r.expression, symbol)
        }
        for about in ({}, ends) if ends else ({},):
            for point in points(names):
                moved = {name: x + about.get(name, 0) for name, x in point.items()}
                if moved.get("h", 1) > 0 and self.contains(moved):
                    yield moved


EVERYWHERE = Domain()


def holds(value: Ball | None, relation: Relation) -> bool | None:
    """Whether all numbers of a ball are ≠ 0, ≥ 0 or > 0; None where that is not decided."""
    if value is None or not value.is_finite():
        return None
    if relation == "!=":
        return True if not value.contains(0) else False if value.is_zero() else None
    if value > 0 or (relation == ">=" and value >= 0):
        return True
    return False if value < 0 or (relation == ">" and value <= 0) else None


def _sign(value: Ball | None) -> int | None:
    if value is None or not value.is_finite():
        return None
    return 1 if value > 0 else -1 if value < 0 else 0 if value.is_zero() else None


def _holds_of_number(r: Requirement) -> bool | None:
    ring, (x,) = embed([r.expression], ())
    return holds(enclose(ring, x, {}, _PRECISION), r.relation)


@lru_cache(maxsize=512)
def _simplified_soon(written: Requirement) -> Iterable[Requirement]:
    """As it is written where sympy does not end."""
    return unless_long(lambda: list(_simplified(*written)), [Requirement(*written)])


def _simplified(u: sympy.Expr, relation: Relation) -> Iterable[Requirement]:
    """The same condition on simpler expressions; nothing where it always holds."""
    if u.is_number:
        return ()
    return _unequal(u) if relation == "!=" else _signed(u, relation)


def _unequal(u: sympy.Expr) -> Iterable[Requirement]:
    for factor in sympy.Mul.make_args(u):
        base = factor.base if factor.is_Pow and factor.exp.is_Rational else factor
        if base.is_Mul:
            yield from _unequal(base)
        elif not base.is_number and not _always(base, "!="):
            rest = base.primitive()[1] if base.is_Add else base
            yield Requirement(-rest if rest.could_extract_minus_sign() else rest, "!=")


def _signed(u: sympy.Expr, relation: Relation) -> Iterable[Requirement]:
    """That a product is ≥ 0 or > 0, of factors which are defined: a root is ≥ 0."""
    positive = [f for f in sympy.Mul.make_args(u) if f.is_positive]
    rest = sympy.Mul(*(f for f in sympy.Mul.make_args(u) if f not in positive))
    number, rest = rest.as_coeff_Mul()
    rest = (rest.primitive()[1] if rest.is_Add else rest) * sympy.sign(number)
    base, exponent = (rest * sympy.sign(number)).as_base_exp()
    if exponent.is_Integer and exponent.p % 2 and exponent != 1:
        yield from _signed(sympy.sign(number) * base, relation)
    elif exponent.is_Rational and exponent != 1 and number > 0:
        if relation == ">":
            yield from _simplified(base, "!=" if exponent.is_Integer else ">")
    elif not _always(rest, relation):
        yield Requirement(rest, relation)


def _always(u: sympy.Expr, relation: Relation) -> bool:
    """Whether the condition is seen to hold everywhere."""
    from verify.algebra.identities.absolute_values import sign_of  # few formulas have conditions

    if relation == "!=":
        return bool(u.is_nonzero) or sign_of(u, strict=True) is not None
    seen = u.is_positive if relation == ">" else u.is_nonnegative
    return bool(seen) or sign_of(u, strict=relation == ">") == 1


def _root_of_linear(u: sympy.Expr, symbol: sympy.Symbol) -> list[sympy.Rational]:
    slope = u.diff(symbol)
    root = -u.subs(symbol, 0) / slope if slope.is_Rational and slope else None
    return [root] if root is not None and root.is_Rational else []


def _merged(requirements: Iterable[Requirement]) -> Iterable[Requirement]:
    """One for each expression, the strictest; ordered by their texts."""
    ordered = sorted(requirements, key=lambda r: (to_text(_unsigned(r)), to_text(r.expression)))
    for _, same in groupby(ordered, key=_unsigned):
        group = list(same)
        signed = [r for r in group if r.relation != "!="]
        unequal = len(signed) < len(group)
        for expression in dict.fromkeys(r.expression for r in signed or group):
            relations = {r.relation for r in signed if r.expression == expression}
            strict = ">" in relations or (unequal and ">=" in relations)
            yield Requirement(expression, ">" if strict else ">=" if relations else "!=")


def _unsigned(r: Requirement) -> sympy.Expr:
    return -r.expression if r.expression.could_extract_minus_sign() else r.expression


def _sides(r: Requirement) -> tuple[str, str, str]:
    """Left side, relation, right side: q <= 0 in place of −q ≥ 0."""
    if r.expression.could_extract_minus_sign() and not r.expression.is_Add:
        return to_text(-r.expression), _REVERSED[r.relation], "0"
    return to_text(r.expression), r.relation, "0"


def _shown(r: Requirement) -> Prose:
    left, relation, right = _sides(r)
    return prose(Formula(left), f" {_SIGNS[relation]} ", right)
