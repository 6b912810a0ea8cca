"""The domain of a formula, as few and simple conditions on p, q, h and the parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from itertools import groupby

from verify.algebra.embedding import embed
from verify.algebra.enclosure import Ball, enclose, points
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.expressions.function_nodes import Relation, Requirement
from verify.algebra.ring import Decision, Poly, Ring
from verify.algebra.zero_test import witness
from verify.effort import answer_unless_long, limit_effort
from verify.errors import InputError
from verify.lazy_sympy import sympy
from verify.prose import Formula, Prose, join_prose, prose

_SIGNS = {"!=": "≠", ">=": "≥", ">": ">", "<=": "≤", "<": "<"}
_REVERSED = {"!=": "!=", ">=": "<=", ">": "<"}
_PRECISION = 128  # bits


@dataclass(frozen=True)
class FormulaDomain:
    """The set of all points at which every requirement and every condition in words holds.

    `words`: conditions that are no inequalities, as that an implicit scheme's equations have a
    solution.
    """

    requirements: tuple[Requirement, ...] = ()
    words: tuple[str, ...] = ()

    @classmethod
    def from_requirements(cls, requirements: Iterable[Requirement], *words: str) -> FormulaDomain:
        """Return the domain of simplified requirements; those that always hold are dropped."""
        simple = {r for requirement in requirements for r in _simplify_or_keep(requirement)}
        return cls(tuple(_merge(simple)), tuple(dict.fromkeys(words)))

    def __and__(self, other: FormulaDomain) -> FormulaDomain:
        if not other:
            return self
        return FormulaDomain.from_requirements(
            (*self.requirements, *other.requirements), *self.words, *other.words
        )

    def __bool__(self) -> bool:
        """Return True if there is any condition."""
        return bool(self.requirements or self.words)

    @cached_property
    def texts(self) -> tuple[str, ...]:
        """The conditions as texts, such as `q >= 0`."""
        return (*(" ".join(_sides(r)) for r in self.requirements), *self.words)

    @property
    def requirement_signs(self) -> list[str]:
        """The requirements in the signs of mathematics, such as q ≥ 0."""
        return [str(_format_requirement(r)) for r in self.requirements]

    @property
    def prose(self) -> Prose:
        """The conditions in one line: q ≥ 0, δ ≠ 0."""
        formulas = [_format_requirement(r) for r in self.requirements]
        return join_prose(", ", [*formulas, *self.words])

    @property
    def names(self) -> set[str]:
        """The names of the variables in the requirements."""
        return {s.name for r in self.requirements for s in r.expression.free_symbols}

    @cached_property
    def _elements(self) -> tuple[Ring, list[Poly]]:
        return embed([r.expression for r in self.requirements], sorted(self.names))

    def substitute(self, values: Mapping[sympy.Symbol, sympy.Expr]) -> FormulaDomain:
        """Substitute values in the domain. Raises InputError if a requirement then fails."""
        if not values or not self.requirements:
            return self
        with limit_effort("domain", ", ".join(self.texts), "to put a value in"):
            results = [
                r._replace(expression=r.expression.xreplace(values)) for r in self.requirements
            ]
        for before, after in zip(self.requirements, results, strict=True):
            if after.expression.is_number and _holds_of_number(after) is False:
                text = ", ".join(f"{name} = {value}" for name, value in values.items())
                raise InputError("parameter", text, f"is outside of {' '.join(_sides(before))}")
        return FormulaDomain.from_requirements(results, *self.words)

    def contains(self, point: Mapping[str, Fraction]) -> bool | None:
        """Return True if all requirements hold at the point, False if one fails, None if neither is
        decided. The point has a value for each of `names`."""
        if not self.requirements:
            return True
        ring, elements = self._elements
        answers = [
            holds(enclose(ring, x, point, _PRECISION), r.relation)
            for x, r in zip(elements, self.requirements, strict=True)
        ]
        return False if False in answers else None if None in answers else True

    def signs(self, point: Mapping[str, Fraction]) -> list[int | None]:
        """Return the sign of each requirement's expression at the point; None if not decided."""
        ring, elements = self._elements
        return [_sign(enclose(ring, x, point, _PRECISION)) for x in elements]

    def left_since(self, before: Sequence[int | None], point: Mapping[str, Fraction]) -> list[str]:
        """Return the conditions that fail between a point with the signs `before` and this point.

        A condition fails at this point; or an expression that must not be 0 has changed its sign.
        """
        return [
            str(_format_requirement(r))
            for r, sign_before, sign in zip(
                self.requirements, before, self.signs(point), strict=True
            )
            if (sign == -1 and r.relation != "!=") or (sign_before and sign == -sign_before)
        ]

    def decide(self, ring: Ring, x: Poly) -> Decision:
        """Decide whether x is zero in this domain; a witness lies in the domain.

        If no point of the domain is found, nothing is decided.
        """
        decision = ring.decide(x)
        if decision.zero is None or not self.requirements:
            return decision
        names = [g.name for g in ring.generators_in(x) if g.kind == "variable"]
        points = self._points(list(dict.fromkeys((*names, *sorted(self.names)))))
        # On an empty domain every identity would hold: so a point of the domain is required.
        if decision.zero:
            return Decision(None) if next(points, None) is None else decision
        return witness(partial(enclose, ring, x), points, _PRECISION) or Decision(None)

    def _points(self, names: Sequence[str]) -> Iterator[dict[str, Fraction]]:
        """Yield points of the domain: first near 0, then near the zeros of conditions that are
        linear in one variable."""
        boundaries = {
            symbol.name: Fraction(int(root.p), int(root.q))
            for r in self.requirements
            for symbol in r.expression.free_symbols
            if r.expression.free_symbols == {symbol}
            for root in _root_of_linear(r.expression, symbol)
        }
        for centre in ({}, boundaries) if boundaries else ({},):
            for point in points(names):
                moved_point = {name: x + centre.get(name, 0) for name, x in point.items()}
                if moved_point.get("h", 1) > 0 and self.contains(moved_point):
                    yield moved_point


EVERYWHERE = FormulaDomain()


def holds(value: Ball | None, relation: Relation) -> bool | None:
    """Return True if the relation to 0 holds for all numbers of a ball, False if it holds for none;
    None if neither is certain."""
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
def _simplify_or_keep(requirement: Requirement) -> Iterable[Requirement]:
    """Return the simplified requirements; the requirement itself if sympy takes too long."""
    return answer_unless_long(lambda: list(_simplify(*requirement)), [Requirement(*requirement)])


def _simplify(u: sympy.Expr, relation: Relation) -> Iterable[Requirement]:
    """Return conditions on simpler expressions that are equivalent; none if u is a number, or the
    condition always holds."""
    if u.is_number:
        return ()
    return _simplify_unequal(u) if relation == "!=" else _simplify_signed(u, relation)


def _simplify_unequal(u: sympy.Expr) -> Iterable[Requirement]:
    for factor in sympy.Mul.make_args(u):
        base = factor.base if factor.is_Pow and factor.exp.is_Rational else factor
        # A product is ≠ 0 if each factor is, and a rational power if its base is.
        if base.is_Mul:
            yield from _simplify_unequal(base)
        elif not base.is_number and not _always(base, "!="):
            expression = base.primitive()[1] if base.is_Add else base
            yield Requirement(
                -expression if expression.could_extract_minus_sign() else expression, "!="
            )


def _simplify_signed(u: sympy.Expr, relation: Relation) -> Iterable[Requirement]:
    """Simplify the condition that a product is ≥ 0 or > 0, where its factors are defined. A root is
    ≥ 0 there."""
    # Positive factors do not change the sign of a product.
    positive = [f for f in sympy.Mul.make_args(u) if f.is_positive]
    product = sympy.Mul(*(f for f in sympy.Mul.make_args(u) if f not in positive))
    number, product = product.as_coeff_Mul()
    product = (product.primitive()[1] if product.is_Add else product) * sympy.sign(number)
    base, exponent = (product * sympy.sign(number)).as_base_exp()
    if exponent.is_Integer and exponent.p % 2 and exponent != 1:
        yield from _simplify_signed(sympy.sign(number) * base, relation)
    elif exponent.is_Rational and exponent != 1 and number > 0:
        if relation == ">":
            yield from _simplify(base, "!=" if exponent.is_Integer else ">")
    elif not _always(product, relation):
        yield Requirement(product, relation)


def _always(u: sympy.Expr, relation: Relation) -> bool:
    """Return True if the condition is shown to hold everywhere."""
    from verify.algebra.identities.signs import sign_of  # few formulas have conditions

    if relation == "!=":
        return bool(u.is_nonzero) or sign_of(u, strict=True) is not None
    answer = u.is_positive if relation == ">" else u.is_nonnegative
    return bool(answer) or sign_of(u, strict=relation == ">") == 1


def _root_of_linear(u: sympy.Expr, symbol: sympy.Symbol) -> list[sympy.Rational]:
    slope = u.diff(symbol)
    root = -u.subs(symbol, 0) / slope if slope.is_Rational and slope else None
    return [root] if root is not None and root.is_Rational else []


def _merge(requirements: Iterable[Requirement]) -> Iterable[Requirement]:
    """Merge the requirements on one expression to the strictest one; order all by their texts."""
    ordered = sorted(requirements, key=lambda r: (to_text(_without_sign(r)), to_text(r.expression)))
    for _, same in groupby(ordered, key=_without_sign):
        group = list(same)
        signed = [r for r in group if r.relation != "!="]
        unequal = len(signed) < len(group)
        # u ≠ 0 together with u ≥ 0 is u > 0; u ≠ 0 beside u > 0 adds nothing.
        for expression in dict.fromkeys(r.expression for r in signed or group):
            relations = {r.relation for r in signed if r.expression == expression}
            strict = ">" in relations or (unequal and ">=" in relations)
            yield Requirement(expression, ">" if strict else ">=" if relations else "!=")


def _without_sign(r: Requirement) -> sympy.Expr:
    return -r.expression if r.expression.could_extract_minus_sign() else r.expression


def _sides(r: Requirement) -> tuple[str, str, str]:
    """Return (left side, relation, right side) of the requirement; q <= 0 for −q >= 0."""
    if r.expression.could_extract_minus_sign() and not r.expression.is_Add:
        return to_text(-r.expression), _REVERSED[r.relation], "0"
    return to_text(r.expression), r.relation, "0"


def _format_requirement(r: Requirement) -> Prose:
    left_side, relation, right_side = _sides(r)
    return prose(Formula(left_side), f" {_SIGNS[relation]} ", right_side)
