"""The modified Hamiltonian of a scheme for every H at once, in the derivatives of H.

Schemes with a series over the jets are treated as for one H (`verify.proof.modified.field`), and
as the derivatives are free, everything is decided. Two kinds are given by irrational coefficients:
- Runge–Kutta methods: z' = z + Σ_t h^|t| b·Φ(t) F(t)/σ(t), where the weights b·Φ(t) are rational,
  as those of Gauss methods are: their conjugates are the method with its stages swapped;
- splittings, whose terms are the logarithm of their product of exponentials
  (`verify.proof.modified.splitting_logarithm`).
"""

from collections.abc import Sequence

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.series.jets import Jets, Series, shown
from verify.errors import InputError
from verify.proof.by_conditions import nearby_order
from verify.proof.modified.equation import ModifiedEquation, Term, judged
from verify.proof.modified.field import Vector, divergence, modified_field
from verify.proof.modified.hamiltonian_of_field import hamiltonian_in_jets
from verify.proof.modified.splitting_logarithm import terms_of_splitting
from verify.schemes import get
from verify.schemes.coloured_trees import symmetry
from verify.schemes.conditions import ByConditions
from verify.schemes.elementary_differentials import Differentials
from verify.schemes.every_hamiltonian import BySeries
from verify.schemes.splitting_conditions import Splitting
from verify.schemes.step_map import SOLVABLE
from verify.schemes.tree_conditions import TreeConditions, trees

MOST_ORDER = 8  # the terms multiply with every order
_EVERY, _SEPARABLE = "every smooth H", "every smooth H = T(p) + V(q)"


def modified_for_every(name: str, order: int, separable: bool = False) -> ModifiedEquation:
    """The terms up to h^order, 1 … 8, of the scheme of that name, for every H that it takes.

    `separable`: for every H = T(p) + V(q) only. Raises InputError for a scheme that is known for
    one H at a time only.
    """
    scheme = get(name)
    every_h = scheme.every_h
    if every_h is None:
        problem = "is given for one H; its terms for every H are not known"
        raise InputError("scheme", name, problem)
    separable = separable or every_h.separable
    series = _series_of(every_h)
    if isinstance(every_h, Splitting) and series is None:
        terms = terms_of_splitting(every_h, order)
        area = all(c.holds is True for c in every_h.area_conditions())
        consistent = terms[0].hamiltonian == "H"
    else:
        jets = Jets(order + 3, separable=separable)
        p_next, q_next = _taylor(name, every_h, series, jets, order + 1)
        vectors = modified_field(jets, p_next, q_next)
        terms = [_term(jets, j, vector) for j, vector in enumerate(vectors)]
        consistent = vectors[0] == (-jets.h(0, 1), jets.h(1, 0))
        area = _area(jets, p_next, q_next, vectors)
    found = ModifiedEquation(
        scheme=scheme.name,
        hamiltonian=_SEPARABLE if separable else _EVERY,
        order=order,
        terms=tuple(terms),
        consistent=consistent,
        area=area,
        where=EVERYWHERE if scheme.explicit else Domain.of((), SOLVABLE),
    )
    return judged(found, scheme, nearby_order(every_h, scheme.order))


def _series_of(every_h: BySeries | ByConditions) -> BySeries | None:
    if isinstance(every_h, Splitting):
        # Of printed sizes the first term is H but for their digits: a T + b V, no function of H.
        return every_h.stages if every_h.nearby is None else None
    return every_h if isinstance(every_h, BySeries) else None


def _taylor(
    name: str, every_h: BySeries | ByConditions, series: BySeries | None, jets: Jets, most: int
) -> tuple[Series, ...]:
    if series is not None:
        return series.taylor(jets, most)
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
            share = weight.leading_coefficient() if not weight.is_zero() else 0
            for part, x in enumerate(differentials.of(tree)):
                total[part] += x * share / symmetry(tree)
        for own, x in zip(result, total, strict=True):
            own.append(x)
    return result


def _term(jets: Jets, power: int, vector: Vector) -> Term:
    turned = divergence(jets, vector)
    energy = "H" if vector == (-jets.h(0, 1), jets.h(1, 0)) else None
    if energy is None and turned.is_zero():
        found = hamiltonian_in_jets(jets, vector, power + 1)
        energy = None if found is None else shown(found)
    return Term(
        power=power,
        p=shown(vector[0]),
        q=shown(vector[1]),
        hamiltonian=energy,
        vanishes=all(x.is_zero() for x in vector),
        is_hamiltonian=turned.is_zero(),
        divergence=shown(turned),
    )


def _area(jets: Jets, p_next: Series, q_next: Series, vectors: Sequence[Vector]) -> bool:
    """Whether the first divergence that is not 0 is the leading coefficient of det J − 1."""
    for vector, coefficient in zip(vectors, jets.delta_j(p_next, q_next), strict=True):
        turned = divergence(jets, vector)
        if not (turned.is_zero() and coefficient.is_zero()):
            return bool(turned == coefficient)
    return True
