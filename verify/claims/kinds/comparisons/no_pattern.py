"""Over the initial values the quantity goes up and down without any pattern.

The pattern that is looked for is plain to see in a plot: one order of the initial values by |Λ|
that is the same at every step size. Where there is one, the claim is refuted; where two step sizes
have different orders, there is none. Any computed number has a law: that one is known (see
`verify.proof.plane.growth_law`) is no pattern of this kind.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Literal

from verify.algebra.enclosure import enclose_over
from verify.arithmetic.arb import Ball, rational_ball
from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import QUANTITIES, middle, start_of, table_of
from verify.hamiltonians.canonical_field import energy_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Number, Prose, joined, prose
from verify.runs.start import Start
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.verdict import Verdict

_QUANTITY = "abs_lambda"


class NoPatternClaim(RunClaim):
    """No one order of the initial values by |Λ|."""

    compares = (_QUANTITY,)
    only_here = "a pattern is over the initial values of its own scene"
    kind: Literal["no_pattern"]

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        columns = list(zip(*rows, strict=True))
        orders = [_order([QUANTITIES[_QUANTITY](run) for run in column]) for column in columns]
        details = table_of(rows, _QUANTITY)
        certain = [(c, order) for c, order in zip(columns, orders, strict=True) if order]
        for (column, one), (other, two) in pairwise(certain):
            if one != two:
                told = prose(
                    "by |Λ| the initial values stand in the order ", _told(one), " with h = ",
                    Number(column[0].step_size), " and ", _told(two), " with h = ",
                    Number(other[0].step_size), ", as they are counted in the table: none is that "
                    "of every step size",
                )  # fmt: skip
                return self.result(Verdict.MEASURED, told, details)
        if len(rows) < 2 or len(certain) < len(columns):
            evidence = f"the order is known at {len(certain)} of {len(columns)} step sizes alone"
            return self.result(Verdict.UNDECIDED, evidence, details)
        order = certain[0][1]
        exact = findings.scene(self.scene).exact_hamiltonian()
        energies = [_energy(exact, row[0]) for row in rows]
        of_h = ", which is that of H" if order == _order(energies) else ""
        first = joined(", ", [prose("(", start_of(rows[k][0]), ")") for k in order])
        evidence = prose(
            f"at all {len(columns)} step sizes the initial values stand in one order by |Λ|: ",
            first, of_h,
        )  # fmt: skip
        return self.result(Verdict.REFUTED, evidence, details)


def _order(values: Sequence[Ball]) -> tuple[int, ...]:
    """The places of the values by their size; none where two of them are not told apart."""
    if any(not value.is_finite() for value in values):
        return ()
    places = sorted(range(len(values)), key=lambda k: middle(values[k]))
    apart = all(bool(values[j] < values[k]) for j, k in pairwise(places))
    return tuple(places) if apart else ()


def _told(order: Sequence[int]) -> Prose:
    return prose(", ".join(str(k + 1) for k in order))


def _energy(hamiltonian: Hamiltonian, run: RunResult) -> Ball:
    ring, element = energy_of(hamiltonian)
    at = {**Start.of(run).point, "t": Fraction(run.t0)}
    value = enclose_over(ring, element, {name: rational_ball(x) for name, x in at.items()})
    return Ball("nan") if value is None else value


CLAIM = NoPatternClaim
