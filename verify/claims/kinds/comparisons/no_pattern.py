"""At one step size the quantity goes up and down over the initial values without any pattern.

Refuted by one pattern: that at every step size the quantity increases with the energy of the
initial value, so that all step sizes order the initial values alike. That this pattern is not there
shows nothing of others: the claim is UNDECIDED then.
"""

from itertools import pairwise
from typing import Literal

import sympy

from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import QUANTITIES, Quantity, sign, start_of, table_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import joined, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.schemes.step_map import P, Q
from verify.verdict import Verdict


class NoPatternClaim(RunClaim):
    """No order in the values over the initial values."""

    only_here = "a pattern is over the initial values of its own scene"
    kind: Literal["no_pattern"]
    quantity: Quantity

    def quantities(self) -> tuple[str, ...]:
        return (self.quantity,)

    def compare(self, findings: Findings) -> ClaimResult:
        rows, quantity = self.run_rows(findings), QUANTITIES[self.quantity]
        exact = findings.scene(self.scene).exact_hamiltonian()
        ordered = sorted(rows, key=lambda row: _energy(exact, row[0]))
        energies = [_energy(exact, row[0]) for row in ordered]
        rising = [
            sign(quantity(upper) - quantity(lower)) is True
            for one, two in pairwise(ordered)
            for lower, upper in zip(one, two, strict=True)
        ]
        details = table_of(ordered, self.quantity)
        if len(rows) < 3 or not all(rising) or any(a == b for a, b in pairwise(energies)):
            evidence = (
                f"{quantity.label} does not increase with the energy of the initial value between "
                f"{rising.count(False)} of {len(rising)} neighbours; another pattern was not "
                "looked for"
            )
            return self.result(Verdict.UNDECIDED, evidence, details)
        evidence = prose(
            f"{quantity.label} increases with the energy of the initial value at each of "
            f"{len(rows[0])} step sizes, in the order ",
            joined("; ", (prose("(", start_of(row[0]), ")") for row in ordered)),
        )
        return self.result(Verdict.REFUTED, evidence, details)


def _energy(exact: Hamiltonian, run: RunResult) -> sympy.Expr:
    """H at the run's initial value, exactly; sympy compares such numbers exactly."""
    put = {P: sympy.Rational(run.p), Q: sympy.Rational(run.q)}
    return exact.put_in(exact.expression).subs(put)


CLAIM = NoPatternClaim
