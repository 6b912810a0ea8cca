"""Order and symplecticity of a Runge–Kutta method from its coefficients, for every vector field.

There are two proofs of an order p. Butcher's simplifying assumptions B(p), C(η), D(ζ) imply it if
p ≤ η + ζ + 1 and p ≤ 2η + 2 (Butcher 1964; Hairer, Nørsett, Wanner, theorem II.7.4). Otherwise the
conditions of all rooted trees of at most p vertices prove it. The first tree whose condition fails
refutes it, since each condition is necessary for some vector field.

A B-series map is symplectic for every H if and only if b(u∘v) + b(v∘u) = b(u) b(v) for all pairs of
trees, where u∘v is u with v as one more branch of its root (Calvo, Sanz-Serna, Numer. Math. 67
(1994) 153; Hairer, Lubich, Wanner, theorem VI.7.6). b_i a_ij + b_j a_ji = b_i b_j is sufficient; if
it fails, a pair of trees that fails shows that the method is not symplectic.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, takewhile

import sympy

from verify.algebra.ring import Poly
from verify.audits.methods.integrator import NOT_CLAIMED
from verify.prose import Formula, Number, Prose, prose, read_prose
from verify.schemes.conditions.coloured_trees import (
    Tree,
    condition_text,
    equation_text,
    graft,
    vertices,
)
from verify.schemes.conditions.implicit_tableau import ImplicitTableau, TableauNumbers
from verify.schemes.conditions.tree_conditions import MOST_ORDER, gaps_of, trees
from verify.schemes.printed.sentences import Ruling
from verify.verdict import Verdict

ROUNDING = Fraction(1, 10**13)  # a smaller residual comes from the rounding of coefficients
WRONG = Fraction(1, 10**9)  # a larger residual does not, if coefficients have 15 digits
_MAX_PAIR_VERTICES = 8  # of both trees of a pair together


@dataclass(frozen=True)
class TableauOrder:
    """The order of a method, with the condition that fails.

    `order`: the highest that holds, of those examined. `next`: the condition that fails, "" if none
    does, with its residual `residue`. `largest`: the largest residual that counts as rounding.
    `by`: the conditions that prove the order.
    """

    order: int
    next: str
    residue: float
    largest: float
    by: str


def order_of(tableau: ImplicitTableau, most: int, rounded: bool = False) -> TableauOrder:
    """Return the order, examined up to `most` + 1, by the simplifying assumptions if they suffice.

    `rounded`: True if the coefficients are floats.
    """
    if not rounded:
        simple = _order_by_assumptions(tableau.numbers)
        if simple is not None:
            return simple
    # One order beyond the claimed one is examined, so that the report can name the condition that
    # fails.
    largest, reach, by = 0.0, min(most + 1, MOST_ORDER), "the conditions of all rooted trees"
    for n in range(1, reach + 1):
        for tree, gap in gaps_of(tableau, n).items():
            size = abs(value(tableau.numbers, gap))
            # Coefficients that are floats satisfy a true condition up to their rounding only.
            if size == 0 or (rounded and size < float(ROUNDING)):
                largest = max(largest, size)
                continue
            return TableauOrder(n - 1, equation_text(tree), size, largest, by)
    return TableauOrder(reach, "", 0.0, largest, by)


def value(numbers: TableauNumbers, x: Poly) -> float:
    """Return a number of the ring as a float; 0 only where it is exactly 0."""
    return float(numbers.condition("", 0, x).residue)


def _order_by_assumptions(numbers: TableauNumbers) -> TableauOrder | None:
    """Return the order by B(p), C(η) and D(ζ); None if they do not imply it."""
    b, a, ring = numbers.b, numbers.a, numbers.ring
    one, s = ring.one, range(len(numbers.b))
    powers = [[one] * len(b)]
    c = [ring.reduce(sum(row, ring.zero)) for row in a]

    def power(k: int) -> list[Poly]:
        while len(powers) <= k:
            powers.append([ring.multiply(x, y) for x, y in zip(powers[-1], c, strict=True)])
        return powers[k]

    def dot(x: Sequence[Poly], y: Sequence[Poly]) -> Poly:
        return sum((u * v for u, v in zip(x, y, strict=True)), ring.zero)

    def gap_b(k: int, _: int) -> Poly:
        return dot(b, power(k - 1)) - one / k

    def gap_c(k: int, i: int) -> Poly:
        return dot(a[i], power(k - 1)) - power(k)[i] / k

    def gap_d(k: int, j: int) -> Poly:
        column = [ring.multiply(x, row[j]) for x, row in zip(power(k - 1), a, strict=True)]
        return dot(b, column) - (b[j] - b[j] * power(k)[j]) / k

    def count(gap: Callable[[int, int], Poly], parts: Sequence[int], most: int) -> int:
        """Return the largest k up to which all the parts of the assumption hold."""

        def holds(k: int) -> bool:
            return all(ring.decide(ring.reduce(gap(k, i))).zero is True for i in parts)

        return sum(1 for _ in takewhile(holds, range(1, most + 1)))

    p = count(gap_b, [0], 2 * len(b) + 1)
    eta, zeta = count(gap_c, s, p), count(gap_d, s, p)
    # Beyond these bounds B(p) alone implies no order p (Butcher 1964): the trees have to decide.
    if p > min(eta + zeta + 1, 2 * eta + 2):
        return None
    gap = gap_b(p + 1, 0)
    by = f"B({p}), C({eta}) and D({zeta})"
    return TableauOrder(p, f"b·c^{p} = 1/{p + 1}", abs(value(numbers, ring.reduce(gap))), 0.0, by)


@dataclass(frozen=True)
class Symplecticity:
    """The answer to whether a method is symplectic for every H; None if that is not decided."""

    holds: bool | None
    evidence: Prose


def symplecticity(tableau: ImplicitTableau, rounded: bool = False) -> Symplecticity:
    """Decide if the method is symplectic for every H in any dimension."""
    if all(c.holds for c in tableau.area_conditions()):
        evidence = read_prose("`b_i a_ij + b_j a_ji = b_i b_j` holds exactly for all i, j")
        return Symplecticity(True, evidence)
    # Of floats a failing pair counts only where it fails by far more than rounding, so that a
    # symplectic method is never refuted.
    threshold = float(WRONG) if rounded else 0.0
    weights = tableau.numbers.tree_weights
    for u, v in _pairs():
        gap = (
            weights.weight(graft(u, v)) + weights.weight(graft(v, u))
            - tableau.numbers.ring.multiply(weights.weight(u), weights.weight(v))
        )  # fmt: skip
        size = abs(value(tableau.numbers, tableau.numbers.ring.reduce(gap)))
        if size > threshold:
            left_side = f"{condition_text(graft(u, v))} + {condition_text(graft(v, u))}"
            right = f"({condition_text(u)})({condition_text(v)})"
            evidence = prose(Formula(f"{left_side} = {right}"), " fails by ", Number(f"{size:.3g}"))
            return Symplecticity(False, evidence)
    return Symplecticity(None, prose("no pair of trees that was looked at fails"))


def _pairs() -> Iterator[tuple[Tree, Tree]]:
    for n in range(2, _MAX_PAIR_VERTICES + 1):
        for k in range(1, n // 2 + 1):
            for u in trees(k):
                for v in trees(n - k):
                    if vertices(u) + vertices(v) == n:
                        yield u, v


def repair(tableau: ImplicitTableau, order: int) -> Prose:
    """Name in a sentence the two entries, their sum kept, and the values that they would have to
    have.

    Empty where no such pair makes it that order, or several do. Of rational coefficients.
    """
    numbers = [x for row in (*tableau.rows, tableau.weights) for x in row]
    if not all(x.is_Rational for x in numbers):
        return Prose()
    repairs = []
    for i in range(tableau.stages):
        for j, k in combinations(range(i), 2):
            changed = _change_entries(tableau, i, j, k)
            if changed is not None and order_of(changed, order).order >= order:
                repairs.append((i, j, k, changed))
    if len(repairs) != 1:
        return Prose()
    # A single repair is likely to be the misprint; of several none is preferred.
    ((i, j, k, changed),) = repairs
    before, after = tableau.rows[i], changed.rows[i]
    return read_prose(
        f"With `a_{i + 1}{j + 1}`, `a_{i + 1}{k + 1}` = `{after[j]}`, `{after[k]}` in place of "
        f"`{before[j]}`, `{before[k]}` its order is {order}"
    )


def _change_entries(tableau: ImplicitTableau, i: int, j: int, k: int) -> ImplicitTableau | None:
    """Return the tableau with a_ij + t and a_ik − t, t such that b·A(c) = 1/6; c stays as it is."""
    c = [sum(row, sympy.S.Zero) for row in tableau.rows]
    ac = [sum((a * x for a, x in zip(row, c, strict=True)), sympy.S.Zero) for row in tableau.rows]
    gap = sum((b * x for b, x in zip(tableau.weights, ac, strict=True)), sympy.S.Zero)
    # b·A(c) is linear in t, with this slope: the row sums and so c do not change.
    slope = tableau.weights[i] * (c[j] - c[k])
    if slope == 0:
        return None
    t = (sympy.Rational(1, 6) - gap) / slope
    if t == 0:
        return None
    rows = [list(row) for row in tableau.rows]
    rows[i][j], rows[i][k] = rows[i][j] + t, rows[i][k] - t
    return ImplicitTableau.from_numbers(rows, tableau.weights)


def judge_exact_order(
    claimed: int,
    tableau_order: TableauOrder,
    area: Symplecticity,
    rounded: bool,
    repaired: Prose,
) -> Ruling:
    """Judge the order of exact coefficients by proof; of floats up to their rounding."""
    of_next = prose(
        "; of ", Formula(f"h^{tableau_order.order + 1}"), ", ", Formula(tableau_order.next)
    )
    by = prose(" fails by ", Number(f"{tableau_order.residue:.3g}"))
    ends = prose(of_next, by) if tableau_order.next else Prose()
    symplectic = {True: "it is symplectic", False: "it is not symplectic", None: ""}[area.holds]
    remark = prose(f". {NOT_CLAIMED}")
    if symplectic:
        remark = prose(remark, f"; {symplectic}: ", area.evidence)
    if tableau_order.order >= claimed:
        more = f", and even order {tableau_order.order}" if tableau_order.order > claimed else ""
        text = f"order {claimed}{more} by {tableau_order.by}"
        if rounded:
            largest = f"`{tableau_order.largest:.1e}`"
            text += f", with residues up to {largest}, as its floats' rounding leaves them"
        verdict = Verdict.MEASURED if rounded else Verdict.PROVED
        return verdict, prose(read_prose(text), ends, remark), ()
    if rounded and tableau_order.residue < float(WRONG):
        reason = read_prose(
            f"its floats satisfy `{tableau_order.next}` but for `{tableau_order.residue:.2e}`, "
            "more than rounding and less than a wrong method: digits are missing"
        )
        return Verdict.UNDECIDED, reason, ()
    fails = f"`{tableau_order.next}` fails by `{tableau_order.residue:.5g}`"
    reason = read_prose(
        f"its order is {tableau_order.order}: of `h^{tableau_order.order + 1}`, {fails}"
    )
    mend = prose(". ", repaired) if repaired else Prose()
    return Verdict.REFUTED, prose(reason, mend, remark), ()
