"""The test whether the leading coefficient of ΔJ, or of S, is a derivative along the flow.

Such a coefficient telescopes. In the plane it is X·G: h times its sum along an orbit is G at the
end minus G at the start, up to a higher power of h. In n degrees of freedom it is the Lie
derivative of a 2-form. With C_k the coefficient at z_k and M_k the product of the Jacobians of the
first k steps, h Σ M_kᵀ C_k M_k is the difference of that form between the ends, up to a higher
power of h.

Let [a, b] = Σ_i d(Xᵃp_i)∧d(X^b q_i). The Lie derivative L commutes with d, so that L[a, b] =
[a+1, b] + [a, b+1], and L[0, 0] = LΩ = 0. S of `lieη` begins with −h^(η+1)/(η+1)! ([η+1, 0] +
[0, η+1]), which in the plane is −div(X^η f)/(η + 1)! dp∧dq, f = (−H_q, H_p).

Even η: the coefficient is Lβ for every smooth H, with β = −1/(η+1)! Σ_k (−1)^k [η−k, k], k = 0 … η:
all terms of the alternating sum Lβ cancel but the first and the last. In the plane β = G dp∧dq, and
L(G dp∧dq) = (X G) dp∧dq, since the flow preserves dp∧dq. ∎

Odd η: if H has an equilibrium at which the divergence Σ c_(p_i q_i) of the coefficient is not 0,
the coefficient is the Lie derivative of no smooth form. Where f vanishes, L of a form B is AᵀB +
BA, A = f'. From AᵀΩ = −ΩA, tr Ω⁻¹(AᵀB + BA) = 0, for any B. For a coefficient of S that trace is
twice its divergence. In the plane X·G vanishes where f does, and there div(X^η f) = tr A^(η+1) = 2
(−det Hess H)^((η+1)/2). ∎
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import flint
import sympy

from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.algebra.identities.polynomials import terms_of
from verify.algebra.jets import Index, Jets, Poly
from verify.algebra.limits import substitute
from verify.algebra.linear_algebra import solve_combination
from verify.errors import InputError
from verify.hamiltonians.canonical_field import JetField, PlainField, VectorField
from verify.prose import Formula, Prose, prose, read_prose
from verify.schemes.steps.two_form import TwoForm, lie_derivative, wedge


def potential_of_lie(flow: VectorField, eta: int) -> TwoForm:
    """Return the potential β of lieη's leading coefficient; ValueError for odd η."""
    if eta % 2:
        raise ValueError("for odd η the leading coefficient does not telescope")
    n, ring = flow.degrees, flow.ring
    gradients = [[flow.gradient(x) for x in flow.power(k)] for k in range(eta + 1)]
    factor = ring.constant(Fraction(-1, math.factorial(eta + 1)))

    def entry(a: int, b: int) -> Poly:
        total = ring.zero
        for k in range(eta + 1):
            wedges = (wedge(gradients[eta - k][i], gradients[k][n + i], a, b) for i in range(n))
            total += (-1) ** k * sum(wedges, ring.zero)
        return factor * total

    return TwoForm.from_entries(ring, flow.names, entry)


def telescopes_of_lie(flow: PlainField, eta: int, leading: TwoForm) -> tuple[bool | None, str]:
    """Decide whether the leading coefficient of lieη's S is a Lie derivative, with β as a formula.

    The decision is None if neither answer is proved. The formula is empty unless it is True.
    """
    if eta % 2 == 0:
        potential = potential_of_lie(flow, eta)
        decision, _ = (lie_derivative(flow, potential) - leading).decide()
        return (True, potential.text) if decision.zero is True else (None, "")
    return (False if _has_divergence_at_rest(flow, leading) else None), ""


def _has_divergence_at_rest(flow: PlainField, leading: TwoForm) -> bool:
    """Return True if the origin is shown to be an equilibrium with a divergence other than 0."""
    ring = flow.ring
    if flow.timed:  # the argument is about equilibria of an H without t
        return False
    origin = {symbol(name): sympy.S.Zero for name in flow.names}
    elements = [*flow.slopes, leading.divergence]
    try:
        values = [substitute(ring.expression(x), origin, "z0") for x in elements]
        constants, numbers = embed(values, [n for n in ring.variables if n not in flow.names])
    except (InputError, ArithmeticError, KeyError):
        return False
    # All slopes 0 means an equilibrium; there a Lie derivative of a smooth form has no divergence.
    *slopes, divergence = (constants.vanishes(x) for x in numbers)
    return all(x is True for x in slopes) and divergence is False


# -- a leading coefficient in the jets of the plane -----------------------------------------------


@dataclass(frozen=True)
class Telescoping:
    """The answer whether L = X·G for every H.

    If it `holds`, `potential` is G; otherwise some H has no such G. `reason` says why.
    """

    holds: bool
    reason: Prose
    potential: Poly | None = None


def telescopes(jets: Jets, leading: Poly) -> Telescoping:
    """Decide whether the polynomial L in the jets is X·G with a polynomial G in the jets.

    False is shown by a linear functional that vanishes on all X·G and not on L: the value at an
    equilibrium, which rules out every smooth G, or a functional found by linear algebra.
    """
    if jets.timed:
        reason = (
            "for an H without t, D·G would be X·G, and that is `L` for no smooth G: where such a "
            "motion rests, X·G = 0 and `L` is not"
        )
        return Telescoping(False, read_prose(reason))
    at_rest = leading.subs({"H_p": 0, "H_q": 0})
    if not at_rest.is_zero():
        return Telescoping(
            False,
            prose(
                read_prose("X·G vanishes where `H_p` = `H_q` = 0, for any smooth G; there L is "),
                Formula(jets.text(at_rest)),
            ),
        )
    graded: dict[tuple[int, int, int], dict[tuple[int, ...], flint.fmpq]] = {}
    for monomial, coefficient in terms_of(leading):
        grade = _grade(jets, monomial)
        graded.setdefault(grade, {})[tuple(map(int, monomial))] = coefficient
    total = jets.zero
    # X maps each grade into one grade, so that L is X·G if and only if each graded part is.
    for grade, part in graded.items():
        solution, rank, unknowns = _solve_for_potential(jets, grade, jets.context.from_dict(part))
        if solution is None:
            return Telescoping(
                False,
                prose(
                    f"of the {unknowns} monomials that a G of that degree may have, X makes a "
                    f"space of dimension {rank}; with L it has dimension {rank + 1}"
                ),
            )
        total += solution
    return Telescoping(True, prose("X·G = L, solved for G by linear algebra"), total)


def _grade(jets: Jets, monomial: Sequence[int]) -> tuple[int, int, int]:
    """Return (number of factors H_ij, total of i, total of j); X raises each by one."""
    powers = [int(n) for n in monomial[2:]]
    return (
        sum(powers),
        sum(n * i for n, (i, _) in zip(powers, jets.indices, strict=True)),
        sum(n * j for n, (_, j) in zip(powers, jets.indices, strict=True)),
    )


def _solve_for_potential(
    jets: Jets, grade: tuple[int, int, int], x: Poly
) -> tuple[Poly | None, int, int]:
    """Return (G with X·G = x, or None; the rank of X on such G; their number of monomials).

    All monomials of x have one grade, and so may those of G, as X maps grades to grades. G contains
    neither p nor q nor H itself, as X removes none of them. G has only derivatives of lower orders
    than x: with G_ij = ∂G/∂H_ij and k the highest i + j in G, the coefficient of H_ij, i + j = k +
    1, in X·G is H_p G_i(j−1) − H_q G_(i−1)j; if all of these were 0, so would be G_0k, G_1(k−1), …
    in turn.
    """
    factors, by_p, by_q = (n - 1 for n in grade)
    highest = max(i + j for (i, j), n in zip(jets.indices, x.degrees()[2:], strict=True) if n > 0)
    indices = [(i, j) for i, j in jets.indices if i + j < highest]
    candidates = list(map(jets.product, multisets(indices, factors, by_p, by_q)))
    coefficients, rank = solve_combination(
        list(map(JetField.from_jets(jets).derive, candidates)), x
    )
    if coefficients is None:
        return None, rank, len(candidates)
    terms = (c * candidates[k] for k, c in coefficients.items())
    return sum(terms, jets.zero), rank, len(candidates)


def multisets(
    indices: Sequence[Index], factors: int, by_p: int, by_q: int, first: int = 0
) -> Iterator[list[tuple[int, int]]]:
    """Yield all products of `factors` derivatives H_ij with these totals of i and of j.

    Only indices from `first` on are used, so that each product occurs once.
    """
    if factors == 0:
        if by_p == by_q == 0:
            yield []
        return
    for k in range(first, len(indices)):
        i, j = indices[k]
        # Each remaining factor needs at least one derivative; otherwise the branch yields nothing.
        if i <= by_p and j <= by_q and i + j + factors - 1 <= by_p + by_q:
            for remaining in multisets(indices, factors - 1, by_p - i, by_q - j, k):
                yield [(i, j), *remaining]
