"""The modified equation of a scheme, with its verdict; see `verify.proof.plane.modified_terms`."""

from dataclasses import dataclass, field, replace
from fractions import Fraction

import sympy

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.ring import Poly, Ring
from verify.algebra.symbols import H_STEP
from verify.errors import InputError
from verify.notebook import aligned_latex, cut, html_table, short_latex
from verify.proof.order_conditions import describe_nearby
from verify.prose import Prose, prose, read_prose
from verify.schemes.conditions.condition import NearbyOrder
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

NOTHING = Prose()


@dataclass(frozen=True)
class Term:
    """The term of h^`power` in the modified field f̃.

    - `p`, `q`: its components in p' and q', as formulas.
    - `vanishes`: True if it is the zero field; `is_hamiltonian`: True if its `divergence` is the
    zero
      function. Each is None if undecided.
    - `witness`: a point where the divergence is not 0, and `enclosure` its value there; `domain`:
    the
      parameters for which the divergence is not the zero function.
    - `hamiltonian`: G with p' = −∂G/∂q, q' = ∂G/∂p; None if the term is not Hamiltonian, or if no G
    is
      found in closed form.
    - `energy`, `divergence_element`: G and the divergence in their rings, for one H.
    """

    power: int
    p: str
    q: str
    hamiltonian: str | None
    vanishes: bool | None
    is_hamiltonian: bool | None
    divergence: str
    witness: dict[str, Fraction] = field(default_factory=dict)
    enclosure: str = ""
    domain: FormulaDomain = EVERYWHERE
    energy: tuple[Ring, Poly] | None = field(default=None, repr=False, compare=False)
    divergence_element: tuple[Ring, Poly] | None = field(default=None, repr=False, compare=False)


@dataclass(frozen=True)
class ModifiedEquation:
    """The terms up to h^order of f̃ = f_1 + h f_2 + …, whose exact flow is the scheme's map.

    - `hamiltonian`: H as a formula, or the class of H.
    - `consistent`: True if the first term is the field of H.
    - `area`: True if the first divergence that is not 0 is the leading coefficient of ΔJ, which is
      computed independently; None if one of them is undecided.
    - `where`: the domain of the map.
    - `verdict`: REFUTED if the scheme claims a higher order, or claims det J ≡ 1 and a term is not
      Hamiltonian; `reason` gives it in one line.
    """

    scheme: str
    hamiltonian: str
    order: int
    terms: tuple[Term, ...]
    consistent: bool | None
    area: bool | None
    where: FormulaDomain
    verdict: Verdict = Verdict.UNDECIDED
    reason: Prose = NOTHING

    @property
    def first_not_hamiltonian(self) -> Term | None:
        """The first term whose divergence is shown not to vanish."""
        return next((x for x in self.terms if x.is_hamiltonian is False), None)

    @property
    def agreed(self) -> int:
        """The power of h up to which the map is shown to be the exact flow."""
        if not self.consistent:
            return 0
        return next((x.power for x in self.terms[1:] if not x.vanishes), len(self.terms))

    @property
    def known(self) -> tuple[Term, ...]:
        """The terms before the first without a Hamiltonian: H̃ is the sum of their energies."""
        terms = []
        for term in self.terms:
            if term.is_hamiltonian is not True or term.hamiltonian is None:
                break
            terms.append(term)
        return tuple(terms)

    @property
    def reach(self) -> int:
        """The power of h up to which H̃ is known in closed form; −1 for none."""
        return len(self.known) - 1

    @property
    def text(self) -> str:
        """H̃ = H + h H_2 + … as a formula, as far as it is known."""
        parts = [(x.power, x.hamiltonian) for x in self.known if x.hamiltonian != "0"]
        return " + ".join(_times_power(n, str(x)) for n, x in parts) or "0"

    @property
    def expression(self) -> sympy.Expr:
        """H̃ as an expression in p, q, h and the parameters; InputError for every H at once."""
        total = []
        for term in self.known:
            if term.energy is None:
                raise InputError("hamiltonian", self.hamiltonian, "is no single H; see `text`")
            ring, x = term.energy
            total.append(H_STEP**term.power * ring.as_product(x))
        return sympy.Add(*total)

    @property
    def domain(self) -> FormulaDomain:
        """The domain where the map is defined and the first divergence is not the zero function."""
        first = self.first_not_hamiltonian
        return self.where & first.domain if first else self.where

    def __repr__(self) -> str:
        return f"ModifiedEquation({self.verdict}: {cut(str(self.reason))})"

    def _repr_html_(self) -> str:
        heads = ("power of h", "Hamiltonian", "divergence", "p'", "q'")
        rows = [
            (str(x.power), cut(x.hamiltonian or "none"), cut(x.divergence), cut(x.p), cut(x.q))
            for x in self.terms
        ]
        caption = f"Modified equation of {self.scheme}: {self.verdict}"
        return html_table(caption, heads, rows, str(self.reason))

    def _repr_latex_(self) -> str:
        """Return H̃ for one H in LaTeX, as far as it is known in closed form."""
        if not all(x.energy for x in self.known):
            return ""
        formula = short_latex(sympy.latex(self.expression))
        return aligned_latex([rf"\tilde H &= {formula} + O(h^{{{self.reach + 1}}})"])


def _times_power(n: int, text: str) -> str:
    if n == 0:
        return text
    return f"h*({text})" if n == 1 else f"h**{n}*({text})"


# -- the verdict ----------------------------------------------------------------------------------


def judge_equation(
    equation: ModifiedEquation, scheme: Scheme | None, near: NearbyOrder | None = None
) -> ModifiedEquation:
    """Return the equation with its verdict on the scheme's claims.

    `near`: the order of exact coefficients near printed ones, if the scheme has such.
    """
    if near is None or near.order <= equation.agreed:
        verdict, reason = _verdict(equation, scheme, equation.agreed)
        return replace(equation, verdict=verdict, reason=reason)
    verdict, reason = _verdict(equation, scheme, near.order)
    if verdict is Verdict.PROVED:
        verdict = near.verdict
    sentence = prose(reason, "; the terms are of the printed coefficients; ", describe_nearby(near))
    return replace(equation, verdict=verdict, reason=sentence)


def _verdict(
    equation: ModifiedEquation, scheme: Scheme | None, agreed: int
) -> tuple[Verdict, Prose]:
    """Return the verdict and its reason.

    `agreed`: the power of h up to which the map is the exact flow, apart from the rounding of
    printed digits.
    """
    first, order = equation.first_not_hamiltonian, equation.order
    # Both are computed from the same map by different code: a contradiction is an error of ours,
    # and no verdict may rest on either.
    if equation.area is False:
        return Verdict.UNDECIDED, prose(
            "the terms and the leading term of ΔJ contradict each other: an error of ours"
        )
    if equation.consistent is None and agreed < 1:
        return Verdict.UNDECIDED, prose("whether the first term is that of H is not decided")
    if not equation.consistent and agreed < 1:
        return Verdict.REFUTED, prose("not a scheme for this H: the first term is not that of H")
    if scheme is not None:
        # A term of h^k with k below the scheme's order contradicts that order, since f̃ − f =
        # O(h^order).
        later = equation.terms[max(agreed, 1) : scheme.order]
        missed = next((x for x in later if not x.vanishes), None)
        if missed is not None and missed.vanishes is None:
            sentence = f"whether the term of `h^{missed.power}` is 0 is not decided"
            return Verdict.UNDECIDED, read_prose(sentence)
        if missed is not None:
            claims = f"{scheme.name} claims order {scheme.order}; "
            return Verdict.REFUTED, read_prose(f"{claims}the term of `h^{missed.power}` is not 0")
        if scheme.area_preserving and first is not None:
            claims = f"{scheme.name} claims det J ≡ 1; "
            sentence = f"the term of `h^{first.power}` has a divergence that is not 0"
            return Verdict.REFUTED, read_prose(claims + sentence)
    undecided = next((x for x in equation.terms if x.is_hamiltonian is None), None)
    if undecided is not None and (first is None or undecided.power < first.power):
        sentence = f"whether the term of `h^{undecided.power}` is Hamiltonian is not decided"
        return Verdict.UNDECIDED, read_prose(sentence)
    if first is not None:
        return Verdict.PROVED, prose(read_prose(_until(first)), _format_domain(first.domain))
    if equation.reach < order:
        sentence = f"every term up to `h^{order}` has divergence 0; of `h^{equation.reach + 1}` no "
        return Verdict.PROVED, read_prose(sentence + "function is found in closed form")
    return Verdict.PROVED, read_prose(f"every term up to `h^{order}` is Hamiltonian")


def _until(first: Term) -> str:
    sentence = f"that of `h^{first.power}` is not: its divergence does not vanish"
    return f"the terms below `h^{first.power}` are Hamiltonian, {sentence}"


def _format_domain(domain: FormulaDomain) -> Prose:
    return prose(", where ", domain.prose) if domain else NOTHING
