"""The modified Hamiltonian of a scheme for every H at once, in the derivatives of H.

Schemes with a series over the jets, the derivatives of H as free variables, are treated as for one
H (`verify.proof.plane.modified_terms`); as the jets are free, everything is decided. Two kinds of
schemes have irrational coefficients:
- Runge–Kutta methods: z' = z + Σ_t h^|t| b·Φ(t) F(t)/σ(t), if the weights b·Φ(t) are rational.
Those
  of Gauss methods are, as conjugation of the coefficients only permutes the stages;
- splittings, whose terms come from the logarithm of the product of exponentials.

A splitting may have any coefficients. Its step is exp(a_1 h X_1) exp(a_2 h X_2) …, where the
letters X_i are the Lie derivatives K and D of V(q) and T(p); its logarithm Σ_w c_w w h^|w| over
words w is a Lie series. A homogeneous Lie polynomial of n letters does not change if each word is
replaced by 1/n times its letters bracketed from the left (Dynkin, Specht, Wever; Reutenauer, Free
Lie Algebras, 1993, theorem 1.4), so that log = Σ_w c_w/n [[…[w_1, w_2], …], w_n] (Baker, Campbell,
Hausdorff). The Lie derivative of G is X_G = G_p ∂_q − G_q ∂_p, and [X_F, X_G] = X_{F, G} with {F,
G} = F_p G_q − F_q G_p: every bracket of letters is the Lie derivative of a function, and H̃ is the
same sum of Poisson brackets of V and T. Each of these terms is Hamiltonian by construction, so that
no divergence is needed.
"""

from collections.abc import Iterable, Sequence
from itertools import product

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.identities.polynomials import terms_of
from verify.algebra.jets import Jets, Series
from verify.algebra.jets import Poly as JetPoly
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import JetField
from verify.proof.expansion import VANISHES, Leading
from verify.proof.order_conditions import nearby_order
from verify.proof.plane.modified_equation import ModifiedEquation, Term, judge_equation
from verify.proof.plane.modified_for_one_h import hamiltonian_in_jets
from verify.proof.plane.modified_terms import TermEnergy, Vector, build_equation, field_of
from verify.schemes import get
from verify.schemes.conditions.coloured_trees import symmetry
from verify.schemes.conditions.condition import ByConditions
from verify.schemes.conditions.every_hamiltonian import BySeries
from verify.schemes.conditions.splitting_conditions import LETTERS, Splitting
from verify.schemes.conditions.tree_conditions import Differentials, TreeConditions, trees
from verify.schemes.conditions.words.words import words
from verify.schemes.maps.step_map import solvable
from verify.schemes.steps.defect import defect_series_of
from verify.structures import AREA

MOST_ORDER = 8  # the number of terms multiplies with every order
_EVERY, _SEPARABLE = "every smooth H", "every smooth H = T(p) + V(q)"
_KICK, _DRIFT = LETTERS["kick"], LETTERS["drift"]
Sum = dict[tuple[int, ...], Poly]  # algebraic numbers, by monomials of the jets


def modified_for_every_h(name: str, order: int, separable: bool = False) -> ModifiedEquation:
    """Compute the modified equation up to h^order, 1 … 8, of a scheme for every H that it takes.

    `name`: the scheme's name. `separable`: True for H = T(p) + V(q) only. Raises InputError for a
    scheme that is defined for one H at a time, or by a method with irrational weights.
    """
    scheme = get(name)
    every_h = scheme.every_h
    if every_h is None:
        problem = "is given for one H; its terms for every H are not known"
        raise InputError("scheme", name, problem)
    separable = separable or every_h.separable
    series, hamiltonians = _series_of(every_h), _SEPARABLE if separable else _EVERY
    domain = EVERYWHERE if scheme.explicit else FormulaDomain.from_requirements((), solvable(AREA))
    if isinstance(every_h, Splitting) and series is None:
        terms = tuple(terms_of_splitting(every_h, order))
        area = all(c.holds is True for c in every_h.area_conditions())
        consistent = terms[0].hamiltonian == "H"
        equation = ModifiedEquation(
            scheme.name, hamiltonians, order, terms, consistent, area, domain
        )
    else:
        jets = Jets(order + 3, separable=separable)
        flow, after = JetField.from_jets(jets), _taylor(name, every_h, series, jets, order + 1)

        def energy_of(vector: Vector, factors: int) -> TermEnergy | None:
            if vector == flow.slopes:
                return TermEnergy("H", None)
            function = hamiltonian_in_jets(jets, vector, factors)
            return None if function is None else TermEnergy(jets.text(function), None)

        equation = build_equation(
            flow,
            after,
            _leading(flow, after),
            energy_of,
            scheme=scheme.name,
            hamiltonian=hamiltonians,
            domain=domain,
        )
    return judge_equation(equation, scheme, nearby_order(every_h, scheme.order))


def _leading(flow: JetField, after: tuple[Series, Series]) -> Leading:
    """Return the first coefficient of ΔJ that is not 0, as far as the series reach."""
    series, most = defect_series_of(flow, after), len(after[0]) - 1
    forms = ((m, series.form(m)) for m in range(1, most + 1))
    return next((Leading.of_form(m, x, x.ring) for m, x in forms if x.entries), VANISHES)


def _series_of(every_h: BySeries | ByConditions) -> BySeries | None:
    if isinstance(every_h, Splitting):
        # With printed sizes the first term is a T + b V, which is no function of H.
        return every_h.stages if every_h.nearby is None else None
    return every_h if isinstance(every_h, BySeries) else None


def _taylor(
    name: str, every_h: BySeries | ByConditions, series: BySeries | None, jets: Jets, most: int
) -> tuple[Series, Series]:
    if series is not None:
        p_next, q_next = series.taylor(jets, most)
        return p_next, q_next
    if isinstance(every_h, TreeConditions):
        return _by_trees(name, every_h, jets, most)
    raise InputError("scheme", name, "has no series for every H; give one H")


def _by_trees(name: str, every_h: TreeConditions, jets: Jets, most: int) -> tuple[Series, Series]:
    weights, differentials = every_h.tableau.numbers.tree_weights, Differentials(jets)
    result: tuple[Series, Series] = [jets.p], [jets.q]
    for n in range(1, most + 1):
        total = [jets.zero, jets.zero]
        for tree in trees(n):
            weight = weights.weight(tree)
            if not weight.is_constant():
                raise InputError("scheme", name, "has irrational weights; give one H")
            # z' = z + Σ_t h^|t| b·Φ(t) F(t)/σ(t), the B-series of the method.
            share = weight.leading_coefficient() if not weight.is_zero() else 0
            for part, x in enumerate(differentials.differential(tree)):
                total[part] += x * share / symmetry(tree)
        for coefficients, x in zip(result, total, strict=True):
            coefficients.append(x)
    return result


# -- splittings, by the logarithm of their product ------------------------------------------------


class Logarithm:
    """The coefficients c_w, in `ring`, of the logarithm of a splitting's step.

    w is a word of at most `most` letters.
    """

    def __init__(self, splitting: Splitting, most: int) -> None:
        self.ring, _ = splitting.numbers
        self._words = splitting.words
        self._words.prepare(word for n in range(most + 1) for word in words("", n))

    def coefficient_of(self, word: str) -> Poly:
        """Return c_w."""
        coefficient: Poly = self._words.logarithm(tuple((letter, 0) for letter in word))
        return coefficient

    def energy(self, jets: Jets, n: int) -> Sum:
        """Return H_n, the coefficient of h^(n−1) in H̃, for n ≥ 2."""
        total: Sum = {}
        for letters in product((_KICK, _DRIFT), repeat=n):
            # The theorem of Dynkin, Specht and Wever: see the module's text.
            number = self.coefficient_of("".join(letters)) / n
            if not number.is_zero():
                _add(self.ring, total, _poisson_bracket(jets, letters), number)
        return {m: x for m, x in total.items() if self.ring.vanishes(x) is not True}


def terms_of_splitting(splitting: Splitting, order: int) -> list[Term]:
    """Return the terms up to h^order of a splitting, for every H = T(p) + V(q)."""
    jets = Jets(order + 2, separable=True)
    logarithm = Logarithm(splitting, order + 1)
    return [_first(logarithm), *(_term_of(logarithm, jets, n) for n in range(2, order + 2))]


def _first(logarithm: Logarithm) -> Term:
    ring, kicks, drifts = (
        logarithm.ring,
        logarithm.coefficient_of(_KICK),
        logarithm.coefficient_of(_DRIFT),
    )
    p, q = _times(ring, -kicks, "H_q"), _times(ring, drifts, "H_p")
    energy = f"{_times(ring, drifts, 'T')} + {_times(ring, kicks, 'V')}"
    is_exact = all(ring.vanishes(x - ring.one) for x in (kicks, drifts))
    if is_exact:
        return Term(0, "-H_q", "H_p", "H", False, True, "0")
    return Term(0, p, q, energy, False, True, "0")


def _term_of(logarithm: Logarithm, jets: Jets, n: int) -> Term:
    ring, total = logarithm.ring, logarithm.energy(jets, n)
    vector: list[Sum] = [{}, {}]
    for monomial, number in total.items():
        for part, x in enumerate(field_of(jets, jets.context.from_dict({monomial: 1}))):
            _add(ring, vector[part], x, number)
    p, q, energy = (_text(ring, jets, x) for x in (*vector, total))
    zero = _vanishes(ring, total.values())
    return Term(n - 1, p, q, energy, zero, True, "0")


def _vanishes(ring: Ring, numbers: Iterable[Poly]) -> bool | None:
    """Return True if there are no numbers, False if one is not 0; zeros must be left out."""
    answers = {ring.vanishes(x) for x in numbers}
    return False if False in answers else None if answers else True


def _poisson_bracket(jets: Jets, word: Sequence[str]) -> JetPoly:
    """Return the Poisson bracket {{…{w_1, w_2}, …}, w_n} of V(q) and T(p), the word's letters."""
    # Only the derivatives of a function are used, not the function itself.
    by_p, by_q = _gradient(jets, word[0])
    bracket = jets.zero
    for letter in word[1:]:
        other_p, other_q = _gradient(jets, letter)
        bracket = by_p * other_q - by_q * other_p
        by_p, by_q = jets.diff(bracket, "p"), jets.diff(bracket, "q")
    return bracket


def _gradient(jets: Jets, letter: str) -> tuple[JetPoly, JetPoly]:
    return (jets.zero, jets.h(0, 1)) if letter == _KICK else (jets.h(1, 0), jets.zero)


def _add(ring: Ring, total: Sum, x: JetPoly, number: Poly) -> None:
    # The numbers are elements of a ring of algebraic numbers, the monomials those of the jets.
    for monomial, share in terms_of(x):
        total[monomial] = ring.reduce(total.get(monomial, ring.zero) + number * share)


def _times(ring: Ring, number: Poly, name: str) -> str:
    text = ring.text(number)
    return {"1": name, "-1": f"-{name}"}.get(text, f"({text})*{name}")


def _text(ring: Ring, jets: Jets, total: Sum) -> str:
    parts = [
        _times(ring, number, jets.text(jets.context.from_dict({monomial: 1})))
        for monomial, number in total.items()
    ]
    return " + ".join(parts) or "0"
