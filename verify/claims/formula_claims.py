"""Claims that print formulas in p, q and h, compared with the exact map of the scheme.

A parameter named in one of the claim's formulas is a symbol, so that the claim is checked for all
its values; any other parameter has the scene's value, if there is one.
The ring decides whether the difference between the printed and the computed expression is zero.
If it is not, the evidence is the difference and a point at which its enclosure excludes zero.
"""

import re
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import sympy

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.expressions.function_nodes import Requirement
from verify.algebra.formula import read, symbol
from verify.algebra.ring import Decision, Poly, Ring
from verify.algebra.symbols import H_STEP
from verify.claims.base_claim import Claim, Findings
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import TaylorExpansion
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.prose import Formula, Number, Prose, join_prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.schemes.maps.closed_form import group_by_powers, h_inside
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict


class FormulaClaim(Claim):
    """The base of the kinds that print formulas of one H."""

    planar = True
    obstacle = "a printed formula is that of its own Hamiltonian"

    @abstractmethod
    def formulas(self) -> dict[str, str]:
        """Return the claim's formulas by the keys under which they stand."""

    def check_scene(self, scene: Scene) -> None:
        self.read_formulas(_names(scene.exact_hamiltonian()))

    def read_formulas(
        self, parameters: Sequence[str]
    ) -> tuple[dict[str, sympy.Expr], list[Requirement]]:
        """Parse the formulas in p, q, h and these names; return them with their requirements.

        InputError names the formula that cannot be parsed.
        """
        expressions, requirements = {}, list[Requirement]()
        for key, text in self.formulas().items():
            extra_names = ["p_next"] if key == "q_next" else []
            names = ("p", "q", "h", *parameters, *extra_names)
            expressions[key], required = read(text, names, source=f"claim {self.id}: {key}")
            requirements += required
        return expressions, requirements

    def read(self, findings: Findings) -> "PrintedFormulas":
        """Return the scheme's exact map, and the formulas with the same parameters as symbols."""
        hamiltonian = findings.scene_of(self).exact_hamiltonian()
        formulas, requirements = self.read_formulas(_names(hamiltonian))
        # A parameter that the formula names must stay a symbol; the others get the scene's values.
        used_names = set(re.findall(r"[A-Za-z]\w*", " ".join(self.formulas().values())))
        values = tuple(
            (name, value) for name, value in hamiltonian.values if name not in used_names
        )
        try:
            step_map = step_map_of(replace(hamiltonian, values=values), self.scheme)
        except InputError:  # a scheme may take H for the given values only
            step_map = step_map_of(hamiltonian, self.scheme)
        h = step_map.hamiltonian
        # The printed q′ may use p_next, whose formula is put into the requirements.
        first_images = {symbol("p_next"): formulas["p_next"]} if "p_next" in formulas else {}
        domain = (
            FormulaDomain.from_requirements(requirements)
            .substitute(first_images)
            .substitute(h.value_substitutions)
        )
        expressions = {key: h.substitute_values(expression) for key, expression in formulas.items()}
        return PrintedFormulas(step_map, expressions, step_map.domain & domain)

    def from_gaps(self, gaps: Sequence["Gap"], holds: str, domain: FormulaDomain) -> ClaimResult:
        """Return PROVED if all differences vanish, else a result with the first that does not."""
        wrong = [gap for gap in gaps if gap.decision.zero is not True]
        wrong.sort(key=lambda gap: gap.decision.zero is None)  # a refutation before a doubt
        if not wrong:
            return self.result(Verdict.PROVED, holds, domain=domain)
        label, ring, x, decision = wrong[0]
        difference = ring.as_product(x) if h_inside(ring, x) else group_by_powers(ring, x)
        return self._refuted_or_not(label, to_text(difference), decision, domain)

    def differs_below(
        self, label: str, ring: Ring, x: Poly, power: int, domain: FormulaDomain = EVERYWHERE
    ) -> ClaimResult | None:
        """Return the claim's result if printed − computed = x is not proved to be O(h^power)."""
        expansion = TaylorExpansion(ring, x)
        for n in range(power):
            coefficient_ring, coefficient = expansion.coefficient(n)
            # A point with a nonzero difference outside the domain would refute nothing, so that the
            # decision is made within it.
            decision = domain.decide(coefficient_ring, coefficient)
            if decision.zero is not True:
                term = H_STEP**n * coefficient_ring.as_product(coefficient)
                return self._refuted_or_not(label, to_text(term), decision, domain)
        return None

    def _refuted_or_not(
        self, label: str, difference: str, decision: Decision, domain: FormulaDomain
    ) -> ClaimResult:
        start = prose(label, ": printed − computed = ", Formula(difference))
        # "0" can be undecided if no point of the domain is found: the claim may then be void.
        if decision.zero is None and difference == "0":
            no_point = start + ", but no point is found with " + domain.prose
            return self.result(Verdict.UNDECIDED, no_point, domain=domain)
        if decision.zero is None:
            doubt = start + ", neither shown to vanish nor not to" + condition_text(domain)
            return self.result(Verdict.UNDECIDED, doubt, domain=domain)
        refutation = start + ", not zero" + witness_of(decision, "it is")
        return self.result(Verdict.REFUTED, refutation, domain=domain)


def _names(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """Return the names that its formulas may use in addition to p, q and h."""
    return (*hamiltonian.parameters, *(("t",) if hamiltonian.time_dependent else ()))


class PrintedFormulas(NamedTuple):
    """The formulas of a claim by their keys, beside the exact map, and where all are defined."""

    step_map: StepMap
    formulas: dict[str, sympy.Expr]
    domain: FormulaDomain


class Gap(NamedTuple):
    """printed − computed of the formula named by `label`, in the ring, with the decision on it."""

    label: str
    ring: Ring
    difference: Poly
    decision: Decision


def gaps(
    step_map: StepMap, pairs: Sequence[tuple[str, sympy.Expr, sympy.Expr]], domain: FormulaDomain
) -> list[Gap]:
    """Return printed − computed for each (label, printed, computed), decided in one ring."""
    # The formulas and the map must be in one ring: in it equal expressions have equal normal forms.
    differences = [printed - computed for _, printed, computed in pairs]
    field, elements = canonical_field(step_map.hamiltonian, *differences)
    ring = field.ring
    return [
        Gap(label, ring, x, domain.decide(ring, x))
        for (label, _, _), x in zip(pairs, elements, strict=True)
    ]


def condition_text(domain: FormulaDomain) -> Prose:
    """Return the domain as `, where q ≥ 0`; empty if it is the whole plane."""
    return prose(", where ", domain.prose) if domain else prose("")


@lru_cache(maxsize=64)
def proof_of(hamiltonian: Hamiltonian, scheme: str) -> Proof:
    """Return the proof for one H; it is cached because several claims use it."""
    return prove(step_map_of(hamiltonian, scheme), get(scheme))


@lru_cache(maxsize=64)
def step_map_of(hamiltonian: Hamiltonian, scheme: str) -> StepMap:
    """Return the scheme's exact map; it is cached because several claims use it."""
    return get(scheme).step_map(hamiltonian)


def witness_of(decision: Decision, phrase: str) -> Prose:
    """Return `; at q = 1 it is [2 +/- 1e-9]`, or nothing if the decision names no point."""
    if not decision.witness:
        return prose("")
    coordinates = [
        prose(Formula(name), " = ", Number(str(x))) for name, x in decision.witness.items()
    ]
    return prose("; at ", join_prose(", ", coordinates), f" {phrase} ", Formula(decision.enclosure))
