"""Claims that print formulas in p, q and h, held against the exact map of the scheme.

A parameter that a formula of the claim names is a symbol there, so that the claim is checked for
all its values; one that none of them names has the scene's value, where it has one.
The difference between the printed and the computed expression is decided to be zero or not in the
ring; where it is not, the evidence is the difference and a point at which it is enclosed away
from zero.
"""

import re
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import sympy

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import read, symbol
from verify.algebra.requirement import Requirement
from verify.algebra.ring import Decision, Poly, Ring
from verify.algebra.symbols import H_STEP
from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import Expansion
from verify.proof.order import prove
from verify.proof.proof import Proof
from verify.prose import Formula, Number, Prose, joined, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.schemes.maps.closed_form import h_inside
from verify.schemes.maps.step_map import StepMap, grouped
from verify.verdict import Verdict


class FormulaClaim(Claim):
    """The base of the kinds that print formulas of one H."""

    planar = True
    only_here = "a printed formula is that of its own Hamiltonian"

    @abstractmethod
    def formulas(self) -> dict[str, str]:
        """The claim's formulas by the keys under which they stand."""

    def check_scene(self, scene: Scene) -> None:
        self.read_formulas(_names(scene.exact_hamiltonian()))

    def read_formulas(
        self, others: Sequence[str]
    ) -> tuple[dict[str, sympy.Expr], list[Requirement]]:
        """The formulas as expressions in p, q, h and these names, and what they ask for.

        InputError names which is none.
        """
        found, asked = {}, list[Requirement]()
        for key, written in self.formulas().items():
            more = ["p_next"] if key == "q_next" else []
            names = ("p", "q", "h", *others, *more)
            found[key], required = read(written, names, source=f"claim {self.id}: {key}")
            asked += required
        return found, asked

    def read(self, findings: Findings) -> "Printed":
        """The scheme's exact map, and the formulas with the same parameters as symbols."""
        given = findings.scene_of(self).exact_hamiltonian()
        formulas, asked = self.read_formulas(_names(given))
        named = set(re.findall(r"[A-Za-z]\w*", " ".join(self.formulas().values())))
        values = tuple((name, value) for name, value in given.values if name not in named)
        try:
            step_map = step_map_of(replace(given, values=values), self.scheme)
        except InputError:  # a scheme may take H for the given values only
            step_map = step_map_of(given, self.scheme)
        h = step_map.hamiltonian
        first = {symbol("p_next"): formulas["p_next"]} if "p_next" in formulas else {}
        domain = Domain.of(asked).replaced(first).replaced(h.put)
        put = {key: h.put_in(expression) for key, expression in formulas.items()}
        return Printed(step_map, put, step_map.domain & domain)

    def from_gaps(self, gaps: Sequence["Gap"], holds: str, domain: Domain) -> ClaimResult:
        """PROVED where all differences vanish, else what the first one that does not is."""
        wrong = [gap for gap in gaps if gap.decision.zero is not True]
        wrong.sort(key=lambda gap: gap.decision.zero is None)  # a refutation before a doubt
        if not wrong:
            return self.result(Verdict.PROVED, holds, domain=domain)
        what, ring, x, decision = wrong[0]
        shown = ring.factored(x) if h_inside(ring, x) else grouped(ring, x)
        return self._refuted_or_not(what, to_text(shown), decision, domain)

    def differs_below(
        self, what: str, ring: Ring, x: Poly, power: int, domain: Domain = EVERYWHERE
    ) -> ClaimResult | None:
        """The claim's result where printed − computed = x is not shown to be O(h^power)."""
        expansion = Expansion(ring, x)
        for n in range(power):
            own, coefficient = expansion.coefficient(n)
            decision = domain.decide(own, coefficient)
            if decision.zero is not True:
                term = H_STEP**n * own.factored(coefficient)
                return self._refuted_or_not(what, to_text(term), decision, domain)
        return None

    def _refuted_or_not(
        self, what: str, difference: str, decision: Decision, domain: Domain
    ) -> ClaimResult:
        begun = prose(what, ": printed − computed = ", Formula(difference))
        if decision.zero is None and difference == "0":
            nowhere = begun + ", but no point is found with " + domain.prose
            return self.result(Verdict.UNDECIDED, nowhere, domain=domain)
        if decision.zero is None:
            doubt = begun + ", neither shown to vanish nor not to" + within(domain)
            return self.result(Verdict.UNDECIDED, doubt, domain=domain)
        refuted = begun + ", not zero" + witness_of(decision, "it is")
        return self.result(Verdict.REFUTED, refuted, domain=domain)


def _names(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """What its formulas may name beside p, q and h."""
    return (*hamiltonian.parameters, *(("t",) if hamiltonian.time_dependent else ()))


class Printed(NamedTuple):
    """The formulas of a claim by their keys, beside the exact map, and where all are defined."""

    step_map: StepMap
    formulas: dict[str, sympy.Expr]
    domain: Domain


class Gap(NamedTuple):
    """printed − computed of `what`, an element of the ring, with the decision on it."""

    what: str
    ring: Ring
    difference: Poly
    decision: Decision


def gaps(
    step_map: StepMap, pairs: Sequence[tuple[str, sympy.Expr, sympy.Expr]], domain: Domain
) -> list[Gap]:
    """printed − computed for each (what, printed, computed), decided in one ring, in the domain."""
    differences = [printed - computed for _, printed, computed in pairs]
    field, elements = canonical_field(step_map.hamiltonian, *differences)
    ring = field.ring
    return [
        Gap(what, ring, x, domain.decide(ring, x))
        for (what, _, _), x in zip(pairs, elements, strict=True)
    ]


def within(domain: Domain) -> Prose:
    """`, where q ≥ 0`; nothing where that is everywhere."""
    return prose(", where ", domain.prose) if domain else prose("")


@lru_cache(maxsize=64)
def proof_of(hamiltonian: Hamiltonian, scheme: str) -> Proof:
    """The proof for one H; several claims speak of one."""
    return prove(step_map_of(hamiltonian, scheme), get(scheme))


@lru_cache(maxsize=64)
def step_map_of(hamiltonian: Hamiltonian, scheme: str) -> StepMap:
    """The scheme's exact map; several claims speak of one."""
    return get(scheme).step_map(hamiltonian)


def witness_of(decision: Decision, what: str) -> Prose:
    """`; at q = 1 it is [2 +/- 1e-9]`, or nothing where the decision names no point."""
    if not decision.witness:
        return prose("")
    at = [prose(Formula(name), " = ", Number(str(x))) for name, x in decision.witness.items()]
    return prose("; at ", joined(", ", at), f" {what} ", Formula(decision.enclosure))
