"""Formulas H(p, q) of a given kind and shape, as text: what `hamiltonians` and `scenes` draw.

What a shape says is seen from how the formula is made:

- elliptic, hyperbolic, parabolic: a quadratic form, and perhaps linear terms;
- confining: a p^2m + c q^2n with a, c > 0, and terms that this outgrows or that are ≥ 0 (p^i q^j
  with i/2m + j/2n < 1 is outgrown, by Young's inequality): H → ∞ in every direction;
- open: along one of the half-axes H stays bounded above or falls to −∞;
- free: any terms of its kind.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby
from operator import attrgetter
from typing import NamedTuple

from hypothesis import strategies as st

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.strategies.terms import Drawer, Limits, Sum, combination, monomial, power
from verify.strategies.user_terms import KINDS as KINDS
from verify.strategies.user_terms import TERMS_BY_KIND, TermRequest

NAMES = ("a", "b")
# How often a shape is drawn, the simplest first; whether H → ∞ in every direction (None: unknown).
_Tree = Sequence[Sequence[Sequence["Plan"]]]
_Shapes = dict[str, tuple[int, bool | None]]
_QUADRATIC: _Shapes = {"elliptic": (1, True), "hyperbolic": (1, False), "parabolic": (1, False)}
_SHAPES: _Shapes = {"confining": (2, True), "open": (2, False), "free": (2, None)}
_OPEN_FIRST: _Shapes = {"open": (2, False)} | _SHAPES  # p**2/2 + cos(q) is the simplest
_CHOICES = 16  # as many as the simplest formula of any plan takes


class Plan(NamedTuple):
    """What is drawn: H of this kind, which is separable or not, in this shape."""

    kind: str
    separable: bool
    shape: str

    @property
    def needs_term(self) -> bool:
        """Whether a term has to stand there that makes it of this kind, or mixes p and q."""
        return self.kind != "polynomial" or not self.separable


@dataclass(frozen=True)
class Formula:
    """The text of H, the values of its parameters, whether H = T + V, and whether t is in it."""

    text: str
    parameters: tuple[tuple[str, Fraction], ...]
    separable: bool
    timed: bool = False

    def hamiltonian(self) -> Hamiltonian:
        """H of that text, with its parameters' values."""
        return Hamiltonian.parse(self.text, dict(self.parameters))


def formulas(
    kinds: Sequence[str],
    limits: Limits,
    *,
    separable: bool | None = None,
    bounded: bool | None = None,
    with_parameters: bool = False,
) -> st.SearchStrategy[Formula]:
    """As `hamiltonians`, before they are parsed; parameters are names for some coefficients."""
    tree = _tree(_plans(kinds, limits, separable, bounded))
    return _formulas(tree, limits, with_parameters)


def _plans(
    kinds: Sequence[str], limits: Limits, separable: bool | None, bounded: bool | None
) -> list[Plan]:
    """All that is asked for, the simplest first; one that is drawn twice as often stands twice."""
    found = [
        Plan(kind, is_separable, shape)
        for kind in KINDS
        if kind in kinds
        for is_separable in (True, False)
        if separable in (None, is_separable)
        for shape, (often, is_bounded) in _shapes(kind).items()
        if bounded is None or bounded == is_bounded
        for _ in range(often)
    ]
    for name, most, least in (
        ("degree", limits.degree, _least_degree),
        ("terms", limits.terms, _least_terms),
    ):
        fitting = [plan for plan in found if least(plan) <= most]
        if not fitting:
            problem = f"must be {min(map(least, found))} or more for such an H"
            raise InputError(name, most, problem)
        found = fitting
    return found


def _shapes(kind: str) -> _Shapes:
    return _QUADRATIC | _SHAPES if kind == "polynomial" else _OPEN_FIRST


def _tree(choices: Sequence[Plan]) -> _Tree:
    """The plans by their kind, then by whether they are separable.

    Each is a choice of its own, and so shrinks by itself.
    """
    kinds = (list(plans) for _, plans in groupby(choices, attrgetter("kind")))
    found = [[list(plans) for _, plans in groupby(of, attrgetter("separable"))] for of in kinds]
    return [*found, *found[:1]] if choices[0].kind == "polynomial" else found  # quadratic forms


def _least_degree(plan: Plan) -> int:
    mixed = plan.kind == "polynomial" and not plan.separable
    return 2 if mixed or plan.shape in (*_QUADRATIC, "confining") else 1


def _least_terms(plan: Plan) -> int:
    """How many terms it has at least."""
    if plan.shape in ("elliptic", "confining"):
        return 2 + plan.needs_term
    return 2 if plan.shape == "hyperbolic" and plan.separable else 1


@st.composite
def _formulas(draw: st.DrawFn, tree: _Tree, limits: Limits, with_parameters: bool) -> Formula:
    d = Drawer(draw, limits)
    plan = d.pick(d.pick(d.pick(tree)))
    if plan.shape in _QUADRATIC:
        made = _quadratic(d, plan)
    else:
        made = {"confining": _confining, "open": _open, "free": _free}[plan.shape](d, plan)
    d.pad(_CHOICES)
    named: dict[int, str] = {}
    if with_parameters:
        chosen = {d.whole(0, len(made) - 1) for _ in range(d.whole(1, len(NAMES)))}
        d.pad(_CHOICES + 3)
        named = dict(zip(sorted(chosen), NAMES, strict=False))
    values = list(made.terms.values())
    parameters = tuple((name, values[index]) for index, name in named.items())
    return Formula(made.written(named), parameters, plan.separable)


def _quadratic(d: Drawer, plan: Plan) -> Sum:
    """A form with the discriminant 4ac − b² of its name, and perhaps linear terms."""
    made, a, c = Sum(), d.leading(), d.leading()
    match plan.shape, plan.separable:
        case "elliptic", _:
            made.add(a, "p**2")
            made.add(c, "q**2")
            if not plan.separable:
                made.add(_definite(d, a, c), "p*q")
        case "hyperbolic", True:
            first, second = d.pick((("p", "q"), ("q", "p")))
            made.add(a, f"{first}**2")
            made.add(-c, f"{second}**2")
        case "hyperbolic", False:  # b pq, or a p² + b pq, whose discriminant is −b²
            if d.limits.terms > 1 and d.whole(0, 1):
                made.add(a, f"{d.pick(('p', 'q'))}**2")
            made.add(d.signed(), "p*q")
        case _, True:
            made.add(a, f"{d.pick(('p', 'q'))}**2")
        case _:
            k = d.whole(1, 3) * d.pick((1, -1))
            made.add(a, f"({combination(1, k)})**2")
    if len(made) < d.limits.terms and d.whole(0, 3) == 3:
        made.add(d.signed(), d.pick(("q", "p")))
    return made


def _definite(d: Drawer, a: Fraction, c: Fraction) -> Fraction:
    """b with b² < 4ac: no greater than the smaller of them."""
    return min(a, c) * d.pick((1, -1))


def _confining(d: Drawer, plan: Plan) -> Sum:
    made = Sum()
    powers = d.even(), d.even()
    leading = [d.leading() for _ in powers]
    for name, coefficient, n in zip("pq", leading, powers, strict=True):
        if plan.kind == "exponential" and d.whole(0, 3) == 3:
            made.add(coefficient, f"cosh({name})")  # outgrows what the power outgrows
        else:
            made.add(coefficient, power(name, n))
    extra = d.whole(0, d.limits.terms - _least_terms(plan))
    for _ in range(extra):
        _outgrown(d, made, powers, mixed=not plan.separable)
    if plan.kind != "polynomial":
        _add_term_of_kind(d, made, plan, TermRequest("confining", not plan.separable))
    elif not plan.separable:
        _add_mixed(d, made, powers, leading)
    return made


def _outgrown(d: Drawer, made: Sum, powers: tuple[int, int], mixed: bool) -> None:
    """A term p^i q^j that p^m and q^n outgrow: i/m + j/n < 1."""
    m, n = powers
    if mixed:
        i = d.whole(0, m - 1)
        j = d.whole(0, (n * (m - i) - 1) // m)
    else:
        first = d.whole(0, 1)
        i, j = (d.whole(1, m - 1), 0) if first else (0, d.whole(1, n - 1))
    if i or j:
        made.add(d.signed(), monomial(i, j))


def _add_mixed(d: Drawer, made: Sum, powers: tuple[int, int], leading: Sequence[Fraction]) -> None:
    """A term of both variables that leaves H confining."""
    m, n = powers
    room = d.limits.degree // 2
    if room > 1 and d.whole(0, 1):  # p^2i q^2j ≥ 0
        i = d.whole(1, room - 1)
        made.add(d.positive(), monomial(2 * i, 2 * d.whole(1, room - i)))
    elif (m, n) == (2, 2):
        made.add(_definite(d, leading[0], leading[1]), "p*q")
    else:  # outgrown: 1/m + 1/n < 1
        made.add(d.signed(), "p*q")


def _open(d: Drawer, plan: Plan) -> Sum:
    """H(x, y) = X(x) + Y(y) + …, where X stays bounded above as x → direction·∞, and y = 0."""
    made, degree = Sum(), d.limits.degree
    x, y = d.pick((("q", "p"), ("p", "q")))
    direction = d.pick((-1, 1))
    left = d.limits.terms - plan.needs_term
    if left or not plan.needs_term:
        made.add(d.leading(), power(y, min(d.pick((2, 1, 3, 4)), degree)))
        left -= 1
    grows = d.pick((0, 1, 2)) if left > 0 else 0
    if grows == 1:  # an odd power, which falls in the direction
        exponent = 1 + 2 * d.whole(0, (degree - 1) // 2)
        made.add(-direction * d.positive(), power(x, exponent))
    elif grows == 2 and degree > 1:
        exponent = d.even()
        made.add(-d.positive(), power(x, exponent))
    else:
        exponent = 0
    for _ in range(d.whole(0, max(0, left - (exponent > 0)))):
        _beside(d, made, plan, (x, y), exponent)
    _add_needed(d, made, plan, TermRequest("open", not plan.separable, x, y, direction))
    return made


def _beside(d: Drawer, made: Sum, plan: Plan, axes: tuple[str, str], exponent: int) -> None:
    """A term that leaves H open along x: of y alone, of both, or of a lower power of x."""
    x, y = axes
    kinds = ["across", *(["lower"] if exponent > 1 else [])]
    kinds += ["mixed"] if not plan.separable and d.limits.degree > 1 else []
    match d.pick(kinds):
        case "across":
            made.add(d.signed(), power(y, d.whole(1, d.limits.degree)))
        case "lower":
            made.add(d.signed(), power(x, d.whole(1, exponent - 1)))
        case _:
            made.add(d.signed(), _mixed_monomial(d))


def _mixed_monomial(d: Drawer) -> str:
    i = d.whole(1, d.limits.degree - 1)
    return monomial(i, d.whole(1, d.limits.degree - i))


def _free(d: Drawer, plan: Plan) -> Sum:
    made, degree = Sum(), d.limits.degree
    for _ in range(d.whole(1 - plan.needs_term, d.limits.terms - plan.needs_term)):
        if not plan.separable and degree > 1 and d.whole(0, 1):
            made.add(d.signed(), _mixed_monomial(d))
        else:
            made.add(d.signed(), power(d.pick(("p", "q")), d.whole(1, degree)))
    _add_needed(d, made, plan, TermRequest("free", not plan.separable))
    return made


def _add_needed(d: Drawer, made: Sum, plan: Plan, want: TermRequest) -> None:
    """What makes it of the plan's kind, or mixes p and q."""
    if plan.kind != "polynomial":
        _add_term_of_kind(d, made, plan, want)
    elif not plan.separable:
        made.add(d.signed(), _mixed_monomial(d))


def _add_term_of_kind(d: Drawer, made: Sum, plan: Plan, want: TermRequest) -> None:
    """The term of the plan's kind, and one or two where there is room."""
    for _ in range(1 + (len(made) + 1 < d.limits.terms and d.whole(0, 3) == 3)):
        numerator, denominator, positive = TERMS_BY_KIND[plan.kind](d, want)
        made.add(d.positive() if positive else d.signed(), numerator, denominator)
