"""ΔJ is `formula`: exactly, or up to O(h^up_to).

`delta_j`: printed as ΔJ itself. `mse_summand`: printed inside the square of Eq. 15.
`lambda_factor`: printed as the factor det J of Eq. 16. Of every H, with the derivatives of H as
names, up to the first term.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, Self

import sympy

from verify.algebra.domain import Domain
from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.symbols import H_STEP
from verify.claims import every_formula
from verify.claims.checked import of_hamiltonian
from verify.claims.findings import Findings
from verify.claims.formulas import FormulaClaim, gaps, within
from verify.claims.orders import OF_DELTA_J, Order
from verify.claims.quantified import QuantifiedClaim
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order import leading_of
from verify.prose import Formula, Prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes.maps.step_map import grouped
from verify.verdict import Verdict

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof

_PRINTED_AS = {
    "delta_j": "ΔJ",
    "mse_summand": "the bracket that is squared in the mean (ΔJ by Eq. 15)",
    "lambda_factor": "the factor of the product (det J by Eq. 16)",
}


class DeltaJClaim(QuantifiedClaim, FormulaClaim):
    """ΔJ as printed."""

    about = OF_DELTA_J

    kind: Literal["delta_j", "mse_summand", "lambda_factor"]
    formula: str
    """ΔJ in p, q, h and parameters; for every H in `H_p`, `H_pq`, … and h."""
    up_to: Order | None = None
    """Up to which power of h, + O(h^up_to); exactly, where it is left out."""

    def formulas(self) -> dict[str, str]:
        return {"formula": self.formula}

    @property
    def _what(self) -> str:
        return _PRINTED_AS[self.kind]

    @property
    def _against(self) -> str:
        """What the formula is held against, as it is printed."""
        return "det J" if self.kind == "lambda_factor" else "det J − 1"

    def _delta_j(self, formula: sympy.Expr) -> sympy.Expr:
        """ΔJ as the claim's formula prints it."""
        return formula - 1 if self.kind == "lambda_factor" else formula

    # -- who checked it ---------------------------------------------------------------------------

    def checked_by(self, found: ClaimResult, findings: Findings) -> Sequence[Prose]:
        """A certificate tells the first term alone: it says nothing of what is printed beyond."""
        if self.up_to is None:
            return ()
        if self.every is not None:
            return super().checked_by(found, findings)
        step_map = self.read(findings).step_map  # with the formula's own symbols
        power = leading_of(step_map).power
        if power is None or self.up_to > power + 1:
            return ()
        return of_hamiltonian(step_map.hamiltonian, self.scheme, self.about)

    # -- of one H ---------------------------------------------------------------------------------

    def judge_one(self, findings: Findings) -> ClaimResult:
        step_map, formulas, domain = self.read(findings)
        printed = self._delta_j(formulas["formula"])
        gap = gaps(step_map, [(self._what, printed, step_map.delta_j)], domain)[0]
        if self.up_to is None:
            holds = f"agrees with {self._against} exactly, for all p, q, h and parameters"
            evidence = f"{self._what}, as printed, {holds}" + within(domain)
            return self.from_gaps([gap], evidence, domain)
        wrong = self.differs_below(self._what, gap.ring, gap.difference, self.up_to, domain)
        difference = to_text(-grouped(gap.ring, gap.difference))
        evidence = prose(
            f"{self._what} as printed differs from {self._against} by O(",
            Formula(f"h^{self.up_to}"), "): the difference is ", Formula(difference),
            within(domain),
        )  # fmt: skip
        return wrong or self.result(Verdict.PROVED, evidence, domain=domain)

    # -- of every H -------------------------------------------------------------------------------

    def check_every(self) -> None:
        if self.in_time:
            problem = "is of orders and areas; a printed ΔJ has no derivatives by t"
            raise InputError("every", self.every, problem)
        super().check_every()
        if self.up_to is None:
            raise InputError(
                "up_to", NOT_GIVEN, "is missing: of every H only the first term is known"
            )
        every_formula.read(self.formula, self.id)

    def judge_every(self, proof: "EveryProof") -> ClaimResult:
        """Up to the first term, which is what is known of ΔJ for every H."""
        if proof.area_preserving is not True and (proof.order is None or not proof.leading):
            return self.result(Verdict.UNDECIDED, proof.reason)
        up_to = self.up_to or 0
        computed, beyond = sympy.S.Zero, up_to
        if proof.area_preserving is not True and proof.order is not None:
            leading, _ = self._every(proof.leading)
            computed, beyond = H_STEP**proof.order * leading, proof.order + 1
        formula, domain = self._every(self.formula)
        difference, domain = self._delta_j(formula) - computed, proof.domain & domain
        names = {s.name for s in difference.free_symbols} | {"p", "q", "h"}
        ring, (x,) = embed([difference], sorted(names))
        wrong = self.differs_below(self._what, ring, x, min(up_to, beyond), domain)
        if wrong is not None:
            return wrong
        if up_to > beyond:
            evidence = prose(
                f"{self._what}: for every H it is known up to O(", Formula(f"h^{beyond}"),
                "), and so far is as printed",
            )  # fmt: skip
            return self.result(Verdict.UNDECIDED, evidence, domain=domain)
        holds = prose(f"{self._what} is as printed for every H: ", proof.reason, within(domain))
        return self.result(Verdict.PROVED, holds, domain=domain)

    def _every(self, formula: str) -> tuple[sympy.Expr, Domain]:
        read = every_formula.read(formula, self.id)
        return every_formula.normal(*read, separable=self.of_separable)

    def of_one(self, hamiltonian: Hamiltonian) -> Self:
        if self.every is None:
            return self
        read, _ = every_formula.read(self.formula, self.id)
        own = every_formula.of_hamiltonian(read, hamiltonian)
        return self.model_copy(update={"every": None, "formula": own})


CLAIM = DeltaJClaim
