"""ΔJ is `formula`: exactly, or up to O(h^up_to).

`delta_j`: printed as ΔJ itself. `mse_summand`: printed inside the square of Eq. 15.
`lambda_factor`: printed as the factor det J of Eq. 16. A formula for every H has the derivatives of
H as names, and is checked up to the leading term.
"""

import re
from collections.abc import Sequence
from typing import Literal, Self

import sympy

from verify.algebra.domain import FormulaDomain
from verify.algebra.embedding import embed
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import read, symbol
from verify.algebra.symbols import H_STEP
from verify.claims.base_claim import Findings
from verify.claims.formula_claims import FormulaClaim, condition_text, gaps
from verify.claims.orders import Order
from verify.claims.quantified_claims import OF_DELTA_J, QuantifiedClaim, marks_for_hamiltonian
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import leading_of
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.prose import Formula, Prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes.maps.closed_form import group_by_powers
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
    """Up to which power of h, + O(h^up_to); exactly, if it is left out."""

    def formulas(self) -> dict[str, str]:
        return {"formula": self.formula}

    @property
    def _what(self) -> str:
        return _PRINTED_AS[self.kind]

    @property
    def _reference(self) -> str:
        """The name of the expression with which the printed formula is compared."""
        return "det J" if self.kind == "lambda_factor" else "det J − 1"

    def _delta_j(self, formula: sympy.Expr) -> sympy.Expr:
        """Return the ΔJ that the claim's formula states."""
        return formula - 1 if self.kind == "lambda_factor" else formula

    # -- who checked it ---------------------------------------------------------------------------

    def checked_by(self, result: ClaimResult, findings: Findings) -> Sequence[Prose]:
        """Return the marks of the certificate, if the claim goes no further than it does."""
        # A certificate covers the leading term alone. It does not check a formula that is claimed
        # to be exact, or to agree beyond that term.
        if self.up_to is None:
            return ()
        if self.every is not None:
            return super().checked_by(result, findings)
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
            holds = f"agrees with {self._reference} exactly, for all p, q, h and parameters"
            evidence = f"{self._what}, as printed, {holds}" + condition_text(domain)
            return self.from_gaps([gap], evidence, domain)
        wrong = self.differs_below(self._what, gap.ring, gap.difference, self.up_to, domain)
        difference = to_text(-group_by_powers(gap.ring, gap.difference))
        evidence = prose(
            f"{self._what} as printed differs from {self._reference} by O(",
            Formula(f"h^{self.up_to}"), "): the difference is ", Formula(difference),
            condition_text(domain),
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

    def judge_every(self, proof: ProofForEveryH) -> ClaimResult:
        """Judge up to the leading term, beyond which ΔJ is not known for every H."""
        if proof.area_preserving is not True and (proof.order is None or not proof.leading):
            return self.result(Verdict.UNDECIDED, proof.reason)
        up_to = self.up_to or 0
        leading_term, known_power = sympy.S.Zero, up_to
        if proof.area_preserving is not True and proof.order is not None:
            leading, _ = self._every(proof.leading)
            leading_term, known_power = H_STEP**proof.order * leading, proof.order + 1
        formula, domain = self._every(self.formula)
        difference, domain = self._delta_j(formula) - leading_term, proof.domain & domain
        names = {s.name for s in difference.free_symbols} | {"p", "q", "h"}
        ring, (x,) = embed([difference], sorted(names))
        wrong = self.differs_below(self._what, ring, x, min(up_to, known_power), domain)
        if wrong is not None:
            return wrong
        # Beyond the leading term the printed formula can neither be confirmed nor refuted.
        if up_to > known_power:
            evidence = prose(
                f"{self._what}: for every H it is known up to O(", Formula(f"h^{known_power}"),
                "), and so far is as printed",
            )  # fmt: skip
            return self.result(Verdict.UNDECIDED, evidence, domain=domain)
        holds = prose(
            f"{self._what} is as printed for every H: ", proof.reason, condition_text(domain)
        )
        return self.result(Verdict.PROVED, holds, domain=domain)

    def _every(self, formula: str) -> tuple[sympy.Expr, FormulaDomain]:
        return _normal(*_read_every(formula, self.id), separable=self.of_separable)

    def for_hamiltonian(self, hamiltonian: Hamiltonian) -> Self:
        if self.every is None:
            return self
        expression, _ = _read_every(self.formula, self.id)
        formula = _substitute(expression, hamiltonian)
        return self.model_copy(update={"every": None, "formula": formula})


# -- formulas made of every H: in h, p, q and its derivatives, such as H_pq or H_11 ----------------


def _read_every(formula: str, claim: str) -> tuple[sympy.Expr, FormulaDomain]:
    """Parse the claim's formula for every H; return it with the domain where it is defined.

    Raises InputError if it names anything but h, p, q and derivatives of H.
    """
    derivatives = {name for name in _NAME.findall(formula) if _DERIVATIVE.fullmatch(name)}
    key = f"claim {claim}: formula"
    try:
        expression, requirements = read(formula, ("p", "q", "h", *derivatives), source=key)
        return expression, FormulaDomain.from_requirements(requirements)
    except InputError as error:
        if "unknown name" not in error.problem:
            raise
        problem = f"{error.problem.partition(';')[0]}; allowed: h and derivatives such as H_pq"
        raise InputError(key, formula, problem) from None


def _normal(
    formula: sympy.Expr, domain: FormulaDomain, *, separable: bool
) -> tuple[sympy.Expr, FormulaDomain]:
    """Give each derivative of H a single name; of a separable H the mixed ones are zero."""
    # ∂²H/∂p∂q has several names; with one name for each, equal formulas have equal normal forms.
    substitution = {}
    for s, (p_times, q_times) in _derivatives(formula).items():
        zero = separable and p_times and q_times
        substitution[s] = sympy.S.Zero if zero else symbol("H_" + "p" * p_times + "q" * q_times)
    return formula.xreplace(substitution), domain.substitute(substitution)


def _substitute(formula: sympy.Expr, hamiltonian: Hamiltonian) -> str:
    """Substitute the derivatives of this H into the formula. InputError if it gets too long."""
    p, q = symbol("p"), symbol("q")
    substitution = {
        s: hamiltonian.exact.diff((p, p_times), (q, q_times))
        for s, (p_times, q_times) in _derivatives(formula).items()
    }
    return to_text(formula.xreplace(substitution))


def _derivatives(formula: sympy.Expr) -> dict[sympy.Symbol, tuple[int, int]]:
    """Return the derivatives of H in the formula, with their orders in p and in q."""
    derivatives = {}
    for s in formula.free_symbols:
        if match := _DERIVATIVE.fullmatch(s.name):
            suffix = match[1]
            digits = (int(suffix[0]), int(suffix[1])) if suffix.isdecimal() else None
            derivatives[s] = digits or (suffix.count("p"), suffix.count("q"))
    return derivatives


CLAIM = DeltaJClaim
