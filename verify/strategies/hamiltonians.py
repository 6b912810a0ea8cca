"""The strategy of Hamiltonians: formulas of the plane, one for each degree of freedom, coupled.

The formulas have no variable in common, and a coupling has variables of two degrees, so that no
term cancels another. H → ∞ in every direction where each part does and the couplings are bounded
below; H is open along an axis of the first degree where its part is.

An H that depends on time has one term in t more. Its forms are those of a driven oscillator, from a
force that grows with t to a mass that changes; each is smooth for all real t, and is a function of
q and t alone or of p and t alone, so that a separable H = T + V stays separable.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

from hypothesis import strategies as st

from verify.algebra.limits import MAX_EXPONENT
from verify.arithmetic.exact import whole
from verify.errors import InputError, unknown_name
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.strategies.arguments import MOST_DEGREES, yes_no, yes_no_either
from verify.strategies.couplings import Coupling, couplings, number_variables, with_sign
from verify.strategies.plane_formulas import DrawnFormula, formulas
from verify.strategies.terms import KINDS, Drawer, FormulaLimits, TermSum

_MOST_TERMS, _MOST_SIZE = 50, 10**9
_Form = Sequence[str]  # one is drawn, with the numbers in it
# For the braces see `Drawer.fill_braces`.
_FORCES: Sequence[_Form] = (
    ("q*t", "q*t**2", "q*t**3"),
    ("q*cos({3}t)", "q*sin({3}t)"),
    ("q*sin({3}t + t**2{/})",),  # its frequency grows
)


def hamiltonians(
    kinds: Sequence[str] = KINDS,
    *,
    degree: int = 6,
    terms: int = 4,
    size: int = 9,
    separable: bool | None = None,
    bounded: bool | None = None,
    with_parameters: bool = False,
    time_dependent: bool = False,
    degrees: int = 1,
    coupled: bool | None = None,
) -> st.SearchStrategy[Hamiltonian]:
    """Return a strategy of Hamiltonians H(p, q) with rational coefficients, short, never constant.

    `kinds`: `polynomial`, `trigonometric` (sin and cos), `exponential` (exp, cosh, sinh),
    `rational` (quotients such as q/(1 + q**2), whose denominators vanish for no real p, q); one of
    those given is drawn. `degree` (1 … 64) is that of the polynomial part; `terms` (1 … 50) how
    many are added up at most; `size` (1 … 10^9) bounds the coefficients' numerators and
    denominators.

    `separable`: True for H = T(p) + V(q), False where H_pq is not the zero function, None for
    either. `bounded`: True where H → ∞ in every direction, so that H is bounded below and every
    orbit stays in a compact set; False where some ray from the origin is known along which H stays
    bounded above or falls to −∞; None for either, and for those of which neither is known. About
    one in seven of all is a quadratic form, elliptic, hyperbolic or parabolic.

    `with_parameters`: some coefficients are parameters `a` and `b`, with their values.

    `time_dependent`: H(p, q, t), by one term in t more: a force that grows, comes and goes or has a
    chirp, a stiffness or a mass that changes. `kinds` and `degree` are of H as a function of p and
    q, at each t; so is `bounded`, which must not be False: H → ∞ in every direction at each t, but
    a force in resonance drives an orbit to infinity.

    `degrees`: of freedom, 1 … 8; for more than one H(p1 … pn, q1 … qn), the sum of an H of the
    plane for each of them, of which `terms` are told, the first of the kind that is drawn, and of
    up to n − 1 terms of two degrees. `coupled`: True for one such term at least, False for a sum of
    planes, None for either. `bounded=False` is known along an axis of the first degree.

    >>> from hypothesis import Phase, find, settings
    >>> quietly = settings(database=None, phases=[Phase.generate, Phase.shrink])
    >>> find(hamiltonians(), lambda h: True, settings=quietly).formula
    'p**2/2 + q**2/2'
    >>> find(hamiltonians(time_dependent=True), lambda h: True, settings=quietly).formula
    'p**2/2 + q**2/2 + q*t'
    >>> find(hamiltonians(degrees=2, coupled=True), lambda h: True, settings=quietly).coordinates
    ('p1', 'p2', 'q1', 'q2')

    Shrinks towards p**2/2 + q**2/2. Raises InputError for a bad argument, and where no such H
    exists, when it is called and not when it draws.
    """
    if isinstance(kinds, str) or not isinstance(kinds, Sequence) or not kinds:
        raise InputError("kinds", kinds, f"is not a list of some of: {', '.join(KINDS)}")
    for kind in kinds:
        if kind not in KINDS:
            raise unknown_name("kinds", kind, KINDS)
    limits = FormulaLimits(
        whole("degree", degree, 1, MAX_EXPONENT),
        whole("terms", terms, 1, _MOST_TERMS),
        whole("size", size, 1, _MOST_SIZE),
    )
    yes_no_either("separable", separable)
    yes_no_either("bounded", bounded)
    yes_no("with_parameters", with_parameters)
    yes_no("time_dependent", time_dependent)
    if time_dependent and bounded is False:
        raise InputError("bounded", bounded, "is not known of an H in time; allowed: True, None")
    whole("degrees", degrees, 1, MOST_DEGREES)
    if yes_no_either("coupled", coupled) and degrees == 1:
        raise InputError("coupled", coupled, "wants two degrees of freedom or more")
    request = HamiltonianRequest(
        degrees, limits, tuple(kinds), separable, bounded, coupled, with_parameters, time_dependent
    )
    return request.formulas().map(DrawnFormula.hamiltonian)


@dataclass(frozen=True)
class HamiltonianRequest:
    """The requested properties of an H; the fields are the arguments of `hamiltonians`."""

    degrees: int
    limits: FormulaLimits
    kinds: tuple[str, ...] = KINDS
    separable: bool | None = None
    bounded: bool | None = None
    coupled: bool | None = None
    with_parameters: bool = False
    time_dependent: bool = False

    def formulas(self) -> st.SearchStrategy[DrawnFormula]:
        """Return a strategy of all such formulas; InputError where no such H exists."""
        if self.degrees == 1:
            return self._first_formulas(self.kinds, self.separable)
        choices = (True, False) if self.separable is None else (self.separable,)
        strategies, errors = [], []
        for kind, separable in product(self.kinds, choices):
            try:
                strategies.append(self._formulas_of_kind(kind, separable))
            except InputError as error:
                errors.append(error)
        if not strategies:
            # All kinds failed; the first error is that of the simplest kind.
            raise errors[0]
        return st.one_of(strategies)

    def _first_formulas(
        self, kinds: Sequence[str], separable: bool | None
    ) -> st.SearchStrategy[DrawnFormula]:
        """Return formulas for the first degree of freedom, which fixes the kind of the whole H."""
        still = formulas(
            kinds,
            self.limits,
            separable=separable,
            bounded=self.bounded,
            with_parameters=self.with_parameters,
        )
        if not self.time_dependent:
            return still
        return _driven_formulas(still, kinds, self.limits, linear=self.bounded is True)

    def _formulas_of_kind(self, kind: str, separable: bool) -> st.SearchStrategy[DrawnFormula]:
        """Return formulas whose first part is of the kind; the others may be polynomials."""
        kinds = dict.fromkeys(("polynomial", kind) if "polynomial" in self.kinds else (kind,))
        others = [
            # Only what must hold of every part is passed on: for `separable` False or `bounded`
            # False the first part, or a coupling, suffices.
            formulas([name], self.limits, separable=separable or None, bounded=self.bounded or None)
            for name in kinds
        ]
        first = self._first_formulas([kind], separable)
        return _draw_formula(
            self, first, st.one_of(others), self._couplings(kind, separable), separable
        )

    def _couplings(self, kind: str, separable: bool) -> list[Coupling]:
        """Return the couplings that such an H may have; InputError where it needs one in vain."""
        if self.coupled is False:
            return []
        degree = self.limits.degree
        candidates = list(couplings(kind, degree, separable=separable, bounded=self.bounded))
        if not candidates and self.coupled:
            raise InputError("degree", degree, "must be 2 or more for a coupling of such an H")
        return candidates


@st.composite
def _draw_formula(
    draw: st.DrawFn,
    request: HamiltonianRequest,
    first: st.SearchStrategy[DrawnFormula],
    others: st.SearchStrategy[DrawnFormula],
    candidates: list[Coupling],
    separable: bool,
) -> DrawnFormula:
    n = request.degrees
    parts = [draw(first), *(draw(others) for _ in range(n - 1))]
    texts = [number_variables(part.text, k, k) for k, part in enumerate(parts, start=1)]
    d = Drawer(draw, request.limits)
    # Keyed without their signs: a coupling and its opposite would cancel.
    terms: dict[str, str] = {}
    for _ in range(d.whole(int(bool(request.coupled)), n - 1) if candidates else 0):
        i = d.whole(1, n - 1)
        term = d.pick(candidates).draw_term(d, i, d.whole(i + 1, n))
        terms.setdefault(term.lstrip("+- "), term)
    text = "".join([texts[0], *map(with_sign, texts[1:]), *terms.values()])
    return replace(parts[0], text=text, separable=separable)


@st.composite
def _driven_formulas(
    draw: st.DrawFn,
    still: st.SearchStrategy[DrawnFormula],
    kinds: Sequence[str],
    limits: FormulaLimits,
    *,
    linear: bool = False,
) -> DrawnFormula:
    """Draw formulas with one term in t more, of one of the kinds in q and p.

    Its degree is within the limits. `linear`: the term is linear in q, so that an H which grows
    faster than that stays confining at each t.
    """
    formula, d, term = draw(still), Drawer(draw, limits), TermSum()
    # A confining H outgrows a force that is linear in q, but not a stiffness that changes its
    # sign.
    forms = _FORCES if linear else [*_FORCES, *_forms_of_kinds(kinds, limits)]
    sign, size = d.pick(("+", "-")), d.positive()
    term.add(size, d.fill_braces(d.pick(d.pick(forms))))
    return replace(formula, text=f"{formula.text} {sign} {term.to_text({})}", timed=True)


def _forms_of_kinds(kinds: Sequence[str], limits: FormulaLimits) -> Iterator[_Form]:
    if limits.degree > 1:
        # A stiffness that comes and goes; a kinetic energy that dies out in both directions.
        yield [f"q**{n}*cos({{3}}t)" for n in range(2, min(4, limits.degree) + 1)]
        yield ["p**2/(1 + t**2{/})"]
    if "trigonometric" in kinds:  # a pendulum whose point of support moves
        yield ["cos({3}t)*cos(q)"]
