"""Whether the leading coefficient of ΔJ is X·G, so that along an orbit it telescopes to [G]₀ᵀ.

For `lieη` the leading coefficient is L = −div(X^η f)/(η + 1)!, f = (−H_q, H_p), of h^(η+1).

Even η: it is X·G for every smooth H, with G = −1/(η+1)! Σ_{k=0}^{η} (−1)^k P_{η−k,k}, where
P_{a,b} = ∂(Xᵃp, X^b q)/∂(p, q). Proof: the two-forms [a, b] = d(Xᵃp)∧d(X^b q) + d(X^b p)∧d(Xᵃq)
are symmetric in a and b, and the Lie derivative along X commutes with d, so that
X[a, b] = [a+1, b] + [a, b+1]. In the alternating sum over a + b = η of X[a, b] all but the ends
cancel: X Σ (−1)^k [η−k, k] = [η+1, 0] + (−1)^η [0, η+1] = 2 [η+1, 0] for even η, and
[η+1, 0] = div(X^η f) dp∧dq. In the plane every two-form is F dp∧dq, and X(F dp∧dq) = (X F) dp∧dq
since the flow preserves dp∧dq. ∎

Odd η: it is not, for any smooth G, where H has an equilibrium with det Hess H ≠ 0. For X·G vanishes
where f does, and there div(X^η f) = tr A^(η+1) = 2 (−det Hess H)^((η+1)/2), A = f'. ∎
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import flint

from verify.algebra.generator import terms_of
from verify.algebra.linear_combination import combination
from verify.algebra.series.jets import Jets, Poly, shown
from verify.algebra.series.jets_in_degrees import Index
from verify.algebra.series.timed_jets import TimedJets
from verify.prose import Formula, Prose, prose, read_prose


class Derivation(Protocol):
    """p and q with their derivatives along the flow: `verify.hamiltonians.vector_field.VectorField`
    is one.
    """

    def lie_derivatives(self, name: str, most: int) -> Sequence[Poly]:
        """[y, X y, …, X^most y] of y = p or q."""

    def bracket(self, x: Poly, y: Poly) -> Poly:
        """∂(x, y)/∂(p, q)."""


def potential_of_lie(field: Derivation, eta: int) -> Poly:
    """G with X·G = L, the coefficient of h^(η+1) in ΔJ of `lieη`, for even η."""
    if eta % 2:
        raise ValueError("for odd η the leading coefficient does not telescope")
    p, q = field.lie_derivatives("p", eta), field.lie_derivatives("q", eta)
    signed = ((-1) ** k * field.bracket(p[eta - k], q[k]) for k in range(eta + 1))
    return sum(signed, p[0] * 0) / -math.factorial(eta + 1)


# -- for a leading coefficient in the jets --------------------------------------------------------

EveryJets = Jets | TimedJets


def along(jets: EveryJets) -> str:
    """What the derivative along the flow is called."""
    return "D" if isinstance(jets, TimedJets) else "X"


@dataclass(frozen=True)
class Telescoping:
    """`holds`: L = X·G for every H with `potential` G; False: not for every H, as `reason` says."""

    holds: bool
    reason: Prose
    potential: Poly | None = None


def telescopes(jets: EveryJets, leading: Poly) -> Telescoping:
    """Whether the polynomial L in the jets is X·G with a polynomial G in the jets.

    False is shown by a linear functional that vanishes on all X·G and not on L: to take the value
    at an equilibrium, which rules out every smooth G, or one that linear algebra finds.
    """
    if isinstance(jets, TimedJets):
        return _without_time()
    at_rest = leading.subs({"H_p": 0, "H_q": 0})
    if not at_rest.is_zero():
        return Telescoping(
            False,
            prose(
                read_prose("X·G vanishes where `H_p` = `H_q` = 0, for any smooth G; there L is "),
                Formula(shown(at_rest)),
            ),
        )
    graded: dict[tuple[int, int, int], dict[tuple[int, ...], flint.fmpq]] = {}
    for monomial, coefficient in terms_of(leading):
        grade = _grade(jets, monomial)
        graded.setdefault(grade, {})[tuple(map(int, monomial))] = coefficient
    total = jets.zero
    for grade, part in graded.items():
        found, rank, unknowns = _solve_for_potential(jets, grade, jets.context.from_dict(part))
        if found is None:
            return Telescoping(
                False,
                prose(
                    f"of the {unknowns} monomials that a G of that degree may have, X makes a "
                    f"space of dimension {rank}; with L it has dimension {rank + 1}"
                ),
            )
        total += found
    return Telescoping(True, prose("X·G = L, solved for G by linear algebra"), total)


def _without_time() -> Telescoping:
    reason = (
        "for an H without t, D·G would be X·G, and that is `L` for no smooth G: where such a "
        "motion rests, X·G = 0 and `L` is not"
    )
    return Telescoping(False, read_prose(reason))


def telescopes_of_lie(jets: EveryJets, leading: Poly, eta: int) -> Telescoping:
    """The same for `lieη`: by the formula for even η, where it gives this L."""
    if eta % 2 == 0:
        potential, by = potential_of_lie(jets, eta), along(jets)
        if jets.derive(potential) == leading:
            reason = (
                f"G = −1/{eta + 1}! `Σ_k` `(−1)^k` ∂(`{by}^({eta}−k)` p, `{by}^k` q)/∂(p, q), "
                f"k = 0 … {eta}"
            )
            return Telescoping(True, read_prose(reason), potential)
    return telescopes(jets, leading)


def _grade(jets: Jets, monomial: Sequence[int]) -> tuple[int, int, int]:
    """(factors H_ij, derivatives by p, by q), each of which X raises by one."""
    powers = [int(n) for n in monomial[2:]]
    return (
        sum(powers),
        sum(n * i for n, (i, _) in zip(powers, jets.indices, strict=True)),
        sum(n * j for n, (_, j) in zip(powers, jets.indices, strict=True)),
    )


def _solve_for_potential(
    jets: Jets, grade: tuple[int, int, int], x: Poly
) -> tuple[Poly | None, int, int]:
    """(G with X·G = x, the rank of X on such G, their number of monomials).

    x has all its monomials of one grade, and so may G have: X respects grades. G contains neither p
    nor q nor H itself, as X takes none of them away. And its derivatives have lower orders than
    those of x: with G_ij = ∂G/∂H_ij, i + j = k highest, the coefficient of H_ij, i + j = k + 1, in
    X·G is H_p G_i(j−1) − H_q G_(i−1)j, and were all of them 0, so were G_0k, G_1(k−1), … in turn.
    """
    factors, by_p, by_q = (n - 1 for n in grade)
    highest = max(i + j for (i, j), n in zip(jets.indices, x.degrees()[2:], strict=True) if n > 0)
    indices = [(i, j) for i, j in jets.indices if i + j < highest]
    candidates = [_monomial(jets, m) for m in multisets(indices, factors, by_p, by_q)]
    found, rank = combination([jets.derive(m) for m in candidates], x)
    if found is None:
        return None, rank, len(candidates)
    terms = (c * candidates[k] for k, c in found.items())
    return sum(terms, jets.zero), rank, len(candidates)


def _monomial(jets: Jets, factors: Sequence[tuple[int, int]]) -> Poly:
    return math.prod((jets.h(i, j) for i, j in factors), start=jets.one)


def multisets(
    indices: Sequence[Index], factors: int, by_p: int, by_q: int, first: int = 0
) -> Iterator[list[tuple[int, int]]]:
    """All products of so many H_ij, index from `first` on, with these numbers of derivatives."""
    if factors == 0:
        if by_p == by_q == 0:
            yield []
        return
    for at in range(first, len(indices)):
        i, j = indices[at]
        if i <= by_p and j <= by_q and i + j + factors - 1 <= by_p + by_q:
            for rest in multisets(indices, factors - 1, by_p - i, by_q - j, at):
                yield [(i, j), *rest]
