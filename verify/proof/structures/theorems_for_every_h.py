"""Theorems on what a scheme keeps for every H whose flow keeps it, from its coefficients alone.

Those for one H hold (`verify.proof.structures.structure_theorems`), and of a splitting more, for
H = T(p) + V(q) and I = pᵀDq + a·p + b·q. The flow keeps I if (Dᵀp + b)·T_p = (Dq + a)·V_q: one side
depends on p alone and the other on q alone, so that both are a constant c. A kick of size k changes
I by −khc, a drift by khc: if the kicks' sizes add up to the drifts', I is kept. If H depends on t,
c may too; for I = pᵀDq it is 0 if T is smooth at p = 0, or V at q = 0. If I is of p alone and
quadratic, I_p·V_q = 0 for all p and q, so that each kick keeps it, and each drift leaves p as it
is.

If a map of order r is φ_h + h^(r+1) d + …, then Φ_(−h)Φ_h(z) = z + h^(r+1)(1 − (−1)^r) d + …, so
that for even r the defect of symmetry begins with h^(r+2) at the least. All else that the flow
keeps, the map keeps up to h^r.
"""

from dataclasses import dataclass

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.proof.structures.structure_theorems import (
    Products,
    commutes,
    keeps_products,
    places_apart,
    products_of,
)
from verify.schemes import get
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.symmetric_coefficients import is_symmetric
from verify.schemes.maps import kind_of
from verify.structures import CanonicalForm, Structure
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric
from verify.structures.volume import Volume

_PARTS_APART = "T is smooth at p = 0, or V at q = 0"


@dataclass(frozen=True)
class Theorem:
    """The reason why a structure is kept, a clause, and where it holds."""

    reason: str
    domain: FormulaDomain = EVERYWHERE


def theorem_for_every_h(
    blank: ProofForEveryH, structure: Structure, names: tuple[str, ...]
) -> Theorem | None:
    """Return a theorem by which the scheme keeps the structure for every H of a class.

    `blank`: the scheme, and the class of H. None if no theorem shows it, which decides nothing.
    """
    scheme = get(blank.scheme)
    every_h, half = scheme.every_h, len(names) // 2
    if isinstance(structure, CanonicalForm | Volume):
        conditions = kind_of(every_h, scheme.name).conditions(every_h, blank.degrees)
        if conditions and all(condition.holds for condition in conditions):
            return Theorem("the conditions on the coefficients for a symplectic map hold exactly")
    if isinstance(structure, Symmetric) and is_symmetric(every_h, blank.timed):
        return Theorem("the coefficients are those of the adjoint scheme")
    if is_symmetry_by(blank, structure, names) and is_symmetric(every_h, blank.timed):
        return Theorem("the scheme commutes with ρ, and its coefficients are those of its adjoint")
    products = products_of(structure, names)
    if isinstance(structure, CanonicalForm | Volume) or products is None:
        return None
    if keeps_products(every_h, products, half):
        quadratic = any(len(x) == 2 for x in products)
        return Theorem(
            "the conditions on the coefficients for quadratic integrals hold exactly"
            if quadratic
            else "a linear integral does not change along any slope"
        )
    return _theorem_on_parts(every_h, products, half, blank.timed)


def is_symmetry_by(blank: ProofForEveryH, structure: Structure, names: tuple[str, ...]) -> bool:
    """Return True if the structure is reversibility by a ρ with which the scheme commutes.

    Its defect is then that of symmetry.
    """
    return isinstance(structure, Reversible) and commutes(get(blank.scheme), structure, names)


def least_power(
    blank: ProofForEveryH, structure: Structure, names: tuple[str, ...], order: int
) -> int:
    """Return the power of h below which the defect of a map of that order has no term."""
    symmetry = isinstance(structure, Symmetric) or is_symmetry_by(blank, structure, names)
    return order + 2 if symmetry and order % 2 == 0 and order else order + 1


def _theorem_on_parts(
    every_h: object, products: Products, half: int, timed: bool
) -> Theorem | None:
    """Return a theorem on the kicks and drifts of a splitting; see the module's text."""
    if not isinstance(every_h, Splitting):
        return None
    if len({k < half for x in products for k in x}) == 1:
        return Theorem("each kick and each drift keeps it, as it is of p or of q alone")
    pairs = [x for x in products if len(x) == 2]
    if not all(places_apart(pair, half) for pair in pairs):
        return None
    if timed:
        domain = FormulaDomain.from_requirements((), _PARTS_APART)
        alone = len(pairs) == len(products)
        return Theorem("each kick and each drift keeps it", domain) if alone else None
    ring, parts = every_h.numbers
    gap = sum((x if letter == "K" else -x for letter, x, _ in parts), ring.zero)
    if ring.vanishes(ring.reduce(gap)) is not True:
        return None
    return Theorem("what the kicks change the drifts change back: their sizes have the same sum")
