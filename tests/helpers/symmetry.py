"""Whether a scheme is symmetric, by its coefficients for every H, or by its series for one.

A stage takes H at P = p + a (p' − p) and Q = q + b (q' − q). With −h, and the two ends exchanged,
its equations are the same but for 1 − a and 1 − b; so stages in reverse, with these, undo a step.
"""

from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.map_symmetry import Symmetry, judge_symmetry
from verify.prose import prose
from verify.schemes.conditions.condition import Condition, condition_of
from verify.schemes.conditions.every_hamiltonian import StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

# Neither even nor odd in p or q, so that no symmetry of H hides one that the scheme has not.
WITNESS = "p**2/2 + p**3/3 + q**3/5 - q**2/2 + q**4/7"
_MORE = 3  # powers of h beyond the scheme's order that are looked at
_DIGITS = 12  # of a residue


def prove_symmetry(scheme: Scheme) -> Symmetry:
    """By the scheme's coefficients; where they do not say that it is, by the series for one H."""
    every_h = scheme.every_h
    conditions = symmetry_conditions(every_h)
    if conditions and all(c.holds for c in conditions):
        return Symmetry(Verdict.PROVED, prose("its coefficients are a palindrome"))
    if isinstance(every_h, StageEquations) and palindromic(every_h):
        return Symmetry(Verdict.PROVED, prose("its stages, in reverse, undo its step"))
    try:
        step_map = scheme.step_map(Hamiltonian.parse(WITNESS))
    except InputError:
        return Symmetry(Verdict.UNDECIDED, prose("it does not take this H"))
    return judge_symmetry(step_map, scheme.order + _MORE)


def palindromic(stages: StageEquations) -> bool:
    """Whether the stages in reverse, each with its ends exchanged, are the stages."""
    rows = [(s.kick, s.drift, s.at_p, s.at_q) for s in stages.stages]
    undoing = [(kick, drift, 1 - p, 1 - q) for kick, drift, p, q in reversed(rows)]
    return rows == undoing


def symmetry_conditions(every_h: object) -> tuple[Condition, ...]:
    """All that make the step of −h undo that of h, for every H; they suffice. Of a splitting and of
    a tableau; of others none."""
    if isinstance(every_h, Splitting):
        return _of_splitting(every_h)
    return _of_tableau(every_h.tableau) if isinstance(every_h, TreeConditions) else ()


def _of_splitting(splitting: Splitting) -> tuple[Condition, ...]:
    """That it is a palindrome; neighbours of one kind are one part, and none is 0.

    Then the step of −h undoes that of h: its parts are those of h, in reverse and negative.
    Conversely, parts that alternate and are not 0 are determined by the product of their
    exponentials.
    """
    ring, parts = splitting.numbers
    merged = _alternating(ring, [(letter, size) for letter, size, _ in parts])
    found = []
    if merged and merged[0][0] != merged[-1][0]:
        name = f"the first and the last part are of one kind, not {merged[0][0]}, {merged[-1][0]}"
        found.append(Condition(name, 0, "1", False))
    for k in range(len(merged) // 2):
        residue = merged[k][1] - merged[-1 - k][1]
        name = f"part {k + 1} = part {len(merged) - k}"
        found.append(condition_of(ring, name, 0, residue, _DIGITS))
    return tuple(found)


def _alternating(ring: Ring, parts: list[tuple[str, Poly]]) -> list[tuple[str, Poly]]:
    """The same product with no part 0, and no two neighbours of one letter."""
    found: list[tuple[str, Poly]] = []
    for letter, size in parts:
        if found and found[-1][0] == letter:
            size = ring.reduce(found.pop()[1] + size)
        if ring.decide(size).zero is not True:
            found.append((letter, size))
    return found


def _of_tableau(tableau: ImplicitTableau) -> tuple[Condition, ...]:
    """a_(s+1−i, s+1−j) + a_ij = b_j (Hairer, Lubich, Wanner, theorem V.2.3)."""
    a, b, last = tableau.numbers.a, tableau.numbers.b, tableau.stages - 1
    return tuple(
        tableau.numbers.condition(
            f"a_{i + 1}{j + 1} + a_{last - i + 1}{last - j + 1} = b_{j + 1}",
            0,
            a[i][j] + a[last - i][last - j] - b[j],
        )
        for i in range(tableau.stages)
        for j in range(tableau.stages)
    )
