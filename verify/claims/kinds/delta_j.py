"""ΔJ is `formula`: exactly, or up to O(h^up_to).

`delta_j`: printed as ΔJ itself. `mse_summand`: printed inside the square of Eq. 15.
`lambda_factor`: printed as the factor det J of Eq. 16. Of every H, with the derivatives of H as
names, up to the first term.
"""

import re
from collections.abc import Sequence
from typing import Literal, Self

import sympy

from verify.algebra.domain import Domain
from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import read, symbol
from verify.algebra.symbols import H_STEP
from verify.claims.findings import Findings
from verify.claims.formulas import FormulaClaim, gaps, within
from verify.claims.orders import Order
from verify.claims.quantified import OF_DELTA_J, QuantifiedClaim, marks_for_hamiltonian
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.every_proof import EveryProof
from verify.proof.order import leading_of
from verify.prose import Formula, Prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes.maps.step_map import grouped
from verify.verdict import Verdict

_NAME = re.compile(r"[A-Za-z]\w*")
_DERIVATIVE = re.compile(r"H_([pq]+|\d\d)")  # ∂²H/∂p∂q is H_pq, H_qp or H_11
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
        return marks_for_hamiltonian(step_map.hamiltonian, self.scheme, self.about)

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
        _read_every(self.formula, self.id)

    def judge_every(self, proof: EveryProof) -> ClaimResult:
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
        return _normal(*_read_every(formula, self.id), separable=self.of_separable)

    def of_one(self, hamiltonian: Hamiltonian) -> Self:
        if self.every is None:
            return self
        written, _ = _read_every(self.formula, self.id)
        own = _put_in(written, hamiltonian)
        return self.model_copy(update={"every": None, "formula": own})


# -- formulas made of every H: in h, p, q and its derivatives, such as H_pq or H_11 ----------------


def _read_every(formula: str, claim: str) -> tuple[sympy.Expr, Domain]:
    """The formula of that claim as an expression, and where it is defined.

    InputError where it names more than derivatives of H.
    """
    derivatives = {name for name in _NAME.findall(formula) if _DERIVATIVE.fullmatch(name)}
    key = f"claim {claim}: formula"
    try:
        found, asked = read(formula, ("p", "q", "h", *derivatives), source=key)
        return found, Domain.of(asked)
    except InputError as error:
        if "unknown name" not in error.problem:
            raise
        problem = f"{error.problem.partition(';')[0]}; allowed: h and derivatives such as H_pq"
        raise InputError(key, formula, problem) from None


def _normal(formula: sympy.Expr, domain: Domain, *, separable: bool) -> tuple[sympy.Expr, Domain]:
    """The same with one name for each derivative; of a separable H the mixed ones are zero."""
    put = {}
    for s, (p_times, q_times) in _derivatives(formula).items():
        zero = separable and p_times and q_times
        put[s] = sympy.S.Zero if zero else symbol("H_" + "p" * p_times + "q" * q_times)
    return formula.xreplace(put), domain.replaced(put)


def _put_in(formula: sympy.Expr, hamiltonian: Hamiltonian) -> str:
    """The formula's text with the derivatives of this H put in. InputError where it is too long."""
    p, q = symbol("p"), symbol("q")
    put = {
        s: hamiltonian.exact.diff((p, p_times), (q, q_times))
        for s, (p_times, q_times) in _derivatives(formula).items()
    }
    return to_text(formula.xreplace(put))


def _derivatives(formula: sympy.Expr) -> dict[sympy.Symbol, tuple[int, int]]:
    """The derivatives of H in it, with how often each is taken by p, and by q."""
    found = {}
    for s in formula.free_symbols:
        if match := _DERIVATIVE.fullmatch(s.name):
            by = match[1]
            digits = (int(by[0]), int(by[1])) if by.isdecimal() else None
            found[s] = digits or (by.count("p"), by.count("q"))
    return found


CLAIM = DeltaJClaim
