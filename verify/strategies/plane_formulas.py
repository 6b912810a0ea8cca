"""Formulas H(p, q) of a given kind and shape, as text, which `hamiltonians` and `scenes` draw.

The shape of a formula follows from its construction:

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
from verify.strategies.terms import (
    KINDS,
    TERMS_BY_KIND,
    Drawer,
    FormulaLimits,
    TermRequest,
    TermSum,
    draw_definite,
    draw_quadratic,
    monomial,
    power,
)

NAMES = ("a", "b")
_Tree = Sequence[Sequence[Sequence["FormulaPlan"]]]
# Each shape with its weight in drawing, the simplest first, and whether H → ∞ in every direction
# (None: unknown). hypothesis shrinks towards the first choice.
_Shapes = dict[str, tuple[int, bool | None]]
_QUADRATIC: _Shapes = {"elliptic": (1, True), "hyperbolic": (1, False), "parabolic": (1, False)}
_SHAPES: _Shapes = {"confining": (2, True), "open": (2, False), "free": (2, None)}
_OPEN_FIRST: _Shapes = {"open": (2, False)} | _SHAPES  # p**2/2 + cos(q) is the simplest
_CHOICES = 16  # as many as the simplest formula of any plan takes; see Drawer.pad


class FormulaPlan(NamedTuple):
    """A kind of H, whether it is separable, and its shape."""

    kind: str
    separable: bool
    shape: str

    @property
    def needs_term(self) -> bool:
        """True if H needs a term that makes it of this kind, or that mixes q and p."""
        return self.kind != "polynomial" or not self.separable


@dataclass(frozen=True)
class DrawnFormula:
    """The text of H, its parameters' values, whether H = T + V, and whether it depends on t."""

    text: str
    parameters: tuple[tuple[str, Fraction], ...]
    separable: bool
    timed: bool = False

    def hamiltonian(self) -> Hamiltonian:
        """Return the Hamiltonian of the text, with its parameters' values."""
        return Hamiltonian.parse(self.text, dict(self.parameters))


def formulas(
    kinds: Sequence[str],
    limits: FormulaLimits,
    *,
    separable: bool | None = None,
    bounded: bool | None = None,
    with_parameters: bool = False,
) -> st.SearchStrategy[DrawnFormula]:
    """Return a strategy as `hamiltonians`, of texts; parameters name some of the coefficients."""
    tree = _group_plans(_plans(kinds, limits, separable, bounded))
    return _formulas(tree, limits, with_parameters)


def _plans(
    kinds: Sequence[str], limits: FormulaLimits, separable: bool | None, bounded: bool | None
) -> list[FormulaPlan]:
    """Return all requested plans, the simplest first; one of weight two stands there twice."""
    plans = [
        FormulaPlan(kind, is_separable, shape)
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
        # Plans beyond a limit are left out. Where none remains the error names the least limit
        # that would do, so that nothing is refused only when it is drawn.
        fitting = [plan for plan in plans if least(plan) <= most]
        if not fitting:
            problem = f"must be {min(map(least, plans))} or more for such an H"
            raise InputError(name, most, problem)
        plans = fitting
    return plans


def _shapes(kind: str) -> _Shapes:
    return _QUADRATIC | _SHAPES if kind == "polynomial" else _OPEN_FIRST


def _group_plans(choices: Sequence[FormulaPlan]) -> _Tree:
    """Group the plans by their kind, then by whether they are separable.

    Each level is a choice of its own, and so shrinks by itself.
    """
    kinds = (list(plans) for _, plans in groupby(choices, attrgetter("kind")))
    branches = [
        [list(plans) for _, plans in groupby(group, attrgetter("separable"))] for group in kinds
    ]
    # Polynomials stand twice, as they have quadratic forms too.
    return [*branches, *branches[:1]] if choices[0].kind == "polynomial" else branches


def _least_degree(plan: FormulaPlan) -> int:
    mixed = plan.kind == "polynomial" and not plan.separable
    return 2 if mixed or plan.shape in (*_QUADRATIC, "confining") else 1


def _least_terms(plan: FormulaPlan) -> int:
    """Return the least number of terms of a formula of the plan."""
    if plan.shape in ("elliptic", "confining"):
        return 2 + plan.needs_term
    return 2 if plan.shape == "hyperbolic" and plan.separable else 1


@st.composite
def _formulas(
    draw: st.DrawFn, tree: _Tree, limits: FormulaLimits, with_parameters: bool
) -> DrawnFormula:
    d = Drawer(draw, limits)
    plan = d.pick(d.pick(d.pick(tree)))
    if plan.shape in _QUADRATIC:
        total = draw_quadratic(d, plan.shape, plan.separable)
    else:
        total = {"confining": _draw_confining, "open": _draw_open, "free": _draw_free}[plan.shape](
            d, plan
        )
    d.pad(_CHOICES)
    names: dict[int, str] = {}
    if with_parameters:
        indices = {d.whole(0, len(total) - 1) for _ in range(d.whole(1, len(NAMES)))}
        # Three choices more: the number of parameters, and the indices of two coefficients.
        d.pad(_CHOICES + 3)
        # Two drawn indices may coincide, which leaves one parameter.
        names = dict(zip(sorted(indices), NAMES, strict=False))
    values = list(total.terms.values())
    parameters = tuple((name, values[index]) for index, name in names.items())
    return DrawnFormula(total.to_text(names), parameters, plan.separable)


def _draw_confining(d: Drawer, plan: FormulaPlan) -> TermSum:
    total = TermSum()
    powers = d.even(), d.even()
    leading = [d.leading() for _ in powers]
    for name, coefficient, n in zip("pq", leading, powers, strict=True):
        if plan.kind == "exponential" and d.whole(0, 3) == 3:
            total.add(coefficient, f"cosh({name})")  # outgrows what the power outgrows
        else:
            total.add(coefficient, power(name, n))
    extra = d.whole(0, d.limits.terms - _least_terms(plan))
    for _ in range(extra):
        _add_outgrown(d, total, powers, mixed=not plan.separable)
    if plan.kind != "polynomial":
        _add_term_of_kind(d, total, plan, TermRequest("confining", not plan.separable))
    elif not plan.separable:
        _add_mixed(d, total, powers, leading)
    return total


def _add_outgrown(d: Drawer, total: TermSum, powers: tuple[int, int], mixed: bool) -> None:
    """Add a term p^i q^j that p^m and q^n outgrow: i/m + j/n < 1."""
    # By Young's inequality |p^i q^j| ≤ ε(|p|^m + |q|^n) + C(ε) for each ε > 0, so that a term with
    # any coefficient leaves H → ∞ in every direction.
    m, n = powers
    if mixed:
        i = d.whole(0, m - 1)
        j = d.whole(0, (n * (m - i) - 1) // m)
    else:
        first = d.whole(0, 1)
        i, j = (d.whole(1, m - 1), 0) if first else (0, d.whole(1, n - 1))
    if i or j:
        total.add(d.nonzero(), monomial(i, j))


def _add_mixed(
    d: Drawer, total: TermSum, powers: tuple[int, int], leading: Sequence[Fraction]
) -> None:
    """Add a term of both variables that leaves H confining."""
    m, n = powers
    room = d.limits.degree // 2
    if room > 1 and d.whole(0, 1):  # p^2i q^2j ≥ 0
        i = d.whole(1, room - 1)
        total.add(d.positive(), monomial(2 * i, 2 * d.whole(1, room - i)))
    # With both powers 2 the term p·q is of the same weight: b² < 4ac keeps the form definite.
    elif (m, n) == (2, 2):
        total.add(draw_definite(d, leading[0], leading[1]), "p*q")
    else:  # outgrown: 1/m + 1/n < 1
        total.add(d.nonzero(), "p*q")


def _draw_open(d: Drawer, plan: FormulaPlan) -> TermSum:
    """Draw H(x, y) = X(x) + Y(y) + …, where X stays bounded above along x → direction·∞, y = 0."""
    total, degree = TermSum(), d.limits.degree
    x, y = d.pick((("q", "p"), ("p", "q")))
    direction = d.pick((-1, 1))
    # A place among the terms is reserved for that which makes H of its kind.
    room = d.limits.terms - plan.needs_term
    if room or not plan.needs_term:
        total.add(d.leading(), power(y, min(d.pick((2, 1, 3, 4)), degree)))
        room -= 1
    grows = d.pick((0, 1, 2)) if room > 0 else 0
    # An odd power of x falls along the direction with the sign −direction; an even one with a
    # negative coefficient, and then along both half-axes.
    if grows == 1:  # an odd power, which falls in the direction
        exponent = 1 + 2 * d.whole(0, (degree - 1) // 2)
        total.add(-direction * d.positive(), power(x, exponent))
    elif grows == 2 and degree > 1:
        exponent = d.even()
        total.add(-d.positive(), power(x, exponent))
    else:
        exponent = 0
    for _ in range(d.whole(0, max(0, room - (exponent > 0)))):
        _add_open_term(d, total, plan, (x, y), exponent)
    _add_needed(d, total, plan, TermRequest("open", not plan.separable, x, y, direction))
    return total


def _add_open_term(
    d: Drawer, total: TermSum, plan: FormulaPlan, axes: tuple[str, str], exponent: int
) -> None:
    """Add a term that leaves H open along x: of y alone, of both, or of a lower power of x."""
    x, y = axes
    kinds = ["across", *(["lower"] if exponent > 1 else [])]
    kinds += ["mixed"] if not plan.separable and d.limits.degree > 1 else []
    match d.pick(kinds):
        case "across":
            total.add(d.nonzero(), power(y, d.whole(1, d.limits.degree)))
        case "lower":
            total.add(d.nonzero(), power(x, d.whole(1, exponent - 1)))
        case _:
            total.add(d.nonzero(), _draw_mixed_monomial(d))


def _draw_mixed_monomial(d: Drawer) -> str:
    i = d.whole(1, d.limits.degree - 1)
    return monomial(i, d.whole(1, d.limits.degree - i))


def _draw_free(d: Drawer, plan: FormulaPlan) -> TermSum:
    total, degree = TermSum(), d.limits.degree
    for _ in range(d.whole(1 - plan.needs_term, d.limits.terms - plan.needs_term)):
        if not plan.separable and degree > 1 and d.whole(0, 1):
            total.add(d.nonzero(), _draw_mixed_monomial(d))
        else:
            total.add(d.nonzero(), power(d.pick(("p", "q")), d.whole(1, degree)))
    _add_needed(d, total, plan, TermRequest("free", not plan.separable))
    return total


def _add_needed(d: Drawer, total: TermSum, plan: FormulaPlan, request: TermRequest) -> None:
    """Add the terms that make H of the plan's kind, or that mix q and p."""
    if plan.kind != "polynomial":
        _add_term_of_kind(d, total, plan, request)
    elif not plan.separable:
        total.add(d.nonzero(), _draw_mixed_monomial(d))


def _add_term_of_kind(d: Drawer, total: TermSum, plan: FormulaPlan, request: TermRequest) -> None:
    """Add one term of the plan's kind, or two where there is room."""
    for _ in range(1 + (len(total) + 1 < d.limits.terms and d.whole(0, 3) == 3)):
        numerator, denominator, positive = TERMS_BY_KIND[plan.kind](d, request)
        total.add(d.positive() if positive else d.nonzero(), numerator, denominator)
