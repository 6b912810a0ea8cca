"""Proofs of what a scheme keeps for every H whose flow keeps it.

A theorem on the coefficients shows that the structure is kept; the map's order shows below which
power of h its defect has no term; an example, one H, shows that the defect is not 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from verify.algebra.formula import symbol
from verify.algebra.ring import Decision
from verify.errors import InputError
from verify.hamiltonians.coordinates import check_degrees, coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.proof.expansion import VANISHES, Leading
from verify.proof.order_conditions import agreed_order, describe_nearby, nearby_order
from verify.proof.order_for_every_h import conditions_of_class
from verify.proof.proof_for_every_h import NONE, ProofForEveryH
from verify.proof.structures.examples_for_every_h import Example, find_example
from verify.proof.structures.printed_coefficients import judge_printed, prints_decimals
from verify.proof.structures.structure_order import StructureProof
from verify.proof.structures.structure_theorems import products_of
from verify.proof.structures.structures_proof import StructuresProof, judge_all
from verify.proof.structures.theorems_for_every_h import least_power, theorem_for_every_h
from verify.prose import Formula, Prose, prose, read_prose
from verify.schemes import get
from verify.schemes.conditions.condition import ByConditions, NearbyOrder
from verify.schemes.conditions.every_hamiltonian import BySeries, TaylorSeries
from verify.schemes.conditions.tree_conditions import TreeConditions, holds_for_all_trees
from verify.structures.first_integral import FirstIntegral
from verify.structures.reading import ClaimedStructure, KeepsRequest, read_structures
from verify.structures.reversible import Reversible
from verify.structures.structure import Structure
from verify.verdict import Verdict

_OF_ONE_SYSTEM = ("form", "density", "poisson", "casimirs", "factor")
_ALLOWED = (
    "area, symplectic, volume, energy, momentum, angular-momentum, reversible, symmetric, linear"
    " and quadratic integrals"
)


@dataclass(frozen=True)
class _EveryHamiltonian:
    """Every H as the system of which a request is read."""

    coordinates: tuple[str, ...]
    time_dependent: bool
    parameters: tuple[str, ...] = ()

    @property
    def energy(self) -> sympy.Expr:
        return sympy.Function("H")(*map(symbol, self.coordinates))


@dataclass(frozen=True)
class _Agreement:
    """The order of the map for every H of a class; `near`: if it is that near printed decimals."""

    order: int
    decided: bool
    near: NearbyOrder | None = None


def prove_structures_for_every_h(
    name: str,
    request: KeepsRequest,
    separable: bool = False,
    *,
    timed: bool = False,
    degrees: int = 1,
) -> StructuresProof:
    """Prove what a scheme keeps for every H of a class whose exact flow keeps it.

    The class is as in `verify.proof.order_for_every_h.prove_for_every_h`. Raises InputError for a
    scheme that is given for one H at a time, and for a structure of one system alone.
    """
    check_degrees(degrees)
    scheme = get(name)
    if scheme.every_h is None:
        problem = "is given for one H; it cannot be proved for every H"
        raise InputError("scheme", name, problem)
    separable = separable or scheme.every_h.separable
    blank = ProofForEveryH(
        scheme.name, separable, Verdict.UNDECIDED, NONE, timed=timed, degrees=degrees
    )
    claims = read_for_every_h(request, degrees, timed)
    agreement = _agreement(blank, scheme.every_h)
    keeps = tuple(_prove(blank, agreement, request, k, x) for k, x in enumerate(claims))
    verdict, reason = judge_all(keeps, agreement.order)
    quantifier = f"{blank.quantifier} whose flow keeps it"
    return StructuresProof(
        verdict, reason, keeps, agreement.order, agreement.decided, quantifier=quantifier
    )


def read_for_every_h(
    request: KeepsRequest, degrees: int, timed: bool
) -> Sequence[ClaimedStructure]:
    """Return the structures of a request that have a meaning for every H; else InputError."""
    for key in _OF_ONE_SYSTEM:
        if value := getattr(request, key):
            text = value if isinstance(value, str) else value[0]
            option = "--casimir" if key == "casimirs" else f"--{key}"
            raise InputError(option, text, f"is of one system; of every H allowed: {_ALLOWED}")
    for text in request.keeps:
        if text.partition(":")[0].strip().lower() in ("conformal", "poisson"):
            raise InputError("--keeps", text, f"is of one system; of every H allowed: {_ALLOWED}")
    names = coordinates_in(degrees)
    claims = read_structures(request, _EveryHamiltonian(names, timed))
    for claim in claims:
        _check(claim.structure, names)
    return claims


def _check(structure: Structure, names: tuple[str, ...]) -> None:
    if structure.name == "energy":
        return
    if mistake := structure.mistake(names):
        raise InputError("--keeps", structure.label, mistake)
    if isinstance(structure, FirstIntegral) and products_of(structure, names) is None:
        problem = f"is no integral that theorems on every H know; allowed: {_ALLOWED}"
        raise InputError("--keeps", structure.label, problem)
    if isinstance(structure, Reversible):
        symbols = list(map(symbol, names))
        for x in structure.reflection:
            if not x.is_polynomial(*symbols) or x.as_poly(*symbols).total_degree() > 1:
                raise InputError("--reverses", str(x), "is not affine; allowed: a + Σ c_i z_i")


def _agreement(blank: ProofForEveryH, every_h: BySeries | ByConditions) -> _Agreement:
    """Return the order of the map, as far as it is proved for every H of the class."""
    scheme = get(blank.scheme)
    if isinstance(every_h, TaylorSeries):
        return _Agreement(every_h.eta, True)  # all terms up to h^η are the flow's
    conditions = conditions_of_class(blank, every_h)
    order, wrong = agreed_order(conditions, scheme.order)
    decided = wrong is not None and wrong.holds is False
    near = nearby_order(conditions, scheme.order)
    if near is not None and near.order > order:
        return _Agreement(near.order, False, near)
    if blank.degrees > 1 and isinstance(conditions, TreeConditions):
        tableau = conditions.tableau
        for n in range(order, 1, -1):
            if tableau.numbers.right and holds_for_all_trees(tableau, n):
                return _Agreement(n, decided and n == order)
        return _Agreement(min(order, 1), decided and order < 2)
    return _Agreement(order, decided)


# -- one structure ---------------------------------------------------------------------------------


def _prove(
    blank: ProofForEveryH,
    agreement: _Agreement,
    request: KeepsRequest,
    place: int,
    claim: ClaimedStructure,
) -> StructureProof:
    """Prove the claim at that place of the request."""
    structure, names = claim.structure, coordinates_in(blank.degrees)
    formula = structure.defect_formula
    theorem = theorem_for_every_h(blank, structure, names)
    if theorem is not None:
        reason = prose(read_prose(f"`{formula}` is 0 at every step: "), theorem.reason)
        domain = blank.domain & theorem.domain
        return StructureProof(
            structure, Verdict.PROVED, reason, VANISHES, claimed=claim.order, domain=domain
        )
    least = least_power(blank, structure, names, agreement.order)

    def read(hamiltonian: Hamiltonian) -> Structure:
        return read_structures(request, hamiltonian)[place].structure

    example = find_example(blank, structure, read, least)
    verdict, reason, leading = _judge(blank, agreement, claim, least, example)
    return StructureProof(
        structure,
        verdict,
        reason,
        leading,
        example.component if example else "",
        claim.order,
        domain=blank.domain,
        example=example.hamiltonian.formula if example else "",
    )


def _judge(
    blank: ProofForEveryH,
    agreement: _Agreement,
    claim: ClaimedStructure,
    least: int,
    example: Example | None,
) -> tuple[Verdict, Prose, Leading]:
    """Return the verdict with its reason, and the leading coefficient for the example."""
    structure, order, near = claim.structure, claim.order, agreement.near
    formula = structure.defect_formula
    agrees = f"as the map agrees with the flow up to `h^{agreement.order}`"
    below = read_prose(f"`{formula}` is `O(h^{least})`, {agrees}")
    is_below = order is not None and order <= least
    undecided = prose(below, "; whether it has a term beyond is not decided")
    nothing_seen = Leading(least, Decision(None))
    if near is not None and is_below:
        return near.verdict, prose(below, ": ", describe_nearby(near)), nothing_seen
    if example is None:
        return (Verdict.PROVED if is_below else Verdict.UNDECIDED), undecided, nothing_seen
    leading, of_example = example.leading, prose(" for H = ", Formula(example.hamiltonian.formula))
    begins = prose(read_prose(f"begins with `h^{leading.power}`"), of_example)
    if is_below:
        return Verdict.PROVED, prose(below, "; it ", begins), leading
    scheme = get(blank.scheme)
    if prints_decimals(scheme, example.hamiltonian):
        printed = judge_printed(
            scheme, example.hamiltonian, example.structure, order, near, leading
        )
        if printed is None:
            return Verdict.UNDECIDED, undecided, nothing_seen
        return printed.verdict, prose(printed.reason, of_example), printed.leading
    if order is not None and (leading.power or 0) >= order:
        return Verdict.UNDECIDED, undecided, leading
    return Verdict.REFUTED, prose(read_prose(f"`{formula}` "), begins), leading
