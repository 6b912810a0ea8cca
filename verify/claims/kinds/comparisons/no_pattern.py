"""The quantity goes up and down over the initial values without any pattern.

The pattern in question is visible in a plot: the same order of the initial values by |Λ| at every
step size. If there is one, the claim is refuted; two step sizes with different orders show that
there is none. Every computed number obeys some law: a growth law (see
`verify.proof.plane.growth_law`) is no pattern of this kind.
"""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Literal

from verify.algebra.enclosure import enclose_over
from verify.arithmetic.arb import Ball, rational_ball
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, middle, start_of, table_of
from verify.claims.run_claims import RunClaim
from verify.hamiltonians.canonical_field import energy_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Number, Prose, join_prose, prose
from verify.runs.run_start import Start
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult
from verify.verdict import Verdict

_QUANTITY = "abs_lambda"


class NoPatternClaim(RunClaim):
    """No one order of the initial values by |Λ|, or one."""

    compares = (_QUANTITY,)
    obstacle = "a pattern is over the initial values of its own scene"
    kind: Literal["no_pattern"]
    same_order: bool = False
    """True: there is one order, the same at every step size; else there is none."""

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        columns = list(zip(*rows, strict=True))
        orders = [_order([QUANTITIES[_QUANTITY](run) for run in column]) for column in columns]
        details = table_of(rows, _QUANTITY)
        certain = [(c, order) for c, order in zip(columns, orders, strict=True) if order]
        for (column, first_order), (other_column, other_order) in pairwise(certain):
            if first_order != other_order:
                disagreement = prose(
                    "by |Λ| the initial values, as they are numbered in the table, stand in the "
                    "order ", _format_order(first_order), " with h = ",
                    Number(column[0].step_size), " and in the order ", _format_order(other_order),
                    " with h = ", Number(other_column[0].step_size),
                    ": there is no one order for every step size",
                )  # fmt: skip
                verdict = Verdict.REFUTED if self.same_order else Verdict.MEASURED
                return self.result(verdict, disagreement, details)
        if len(rows) < 2 or len(certain) < len(columns):
            evidence = f"the order is known at {len(certain)} of {len(columns)} step sizes alone"
            return self.result(Verdict.UNDECIDED, evidence, details)
        order = certain[0][1]
        hamiltonian = findings.scene(self.scene).exact_hamiltonian()
        energies = [_energy(hamiltonian, row[0]) for row in rows]
        of_h = ", which is also their order by H" if order == _order(energies) else ""
        starts = join_prose(", ", [prose("(", start_of(rows[k][0]), ")") for k in order])
        evidence = prose(
            f"at all {len(columns)} step sizes the initial values stand in one order by |Λ|: ",
            starts, of_h,
        )  # fmt: skip
        return self.result(
            Verdict.MEASURED if self.same_order else Verdict.REFUTED, evidence, details
        )


def _order(values: Sequence[Ball]) -> tuple[int, ...]:
    """Return the indices of the values by size; empty if two enclosures overlap."""
    if any(not value.is_finite() for value in values):
        return ()
    # Midpoints order the values; the order counts only if neighbouring balls are disjoint.
    places = sorted(range(len(values)), key=lambda k: middle(values[k]))
    are_disjoint = all(bool(values[j] < values[k]) for j, k in pairwise(places))
    return tuple(places) if are_disjoint else ()


def _format_order(order: Sequence[int]) -> Prose:
    return prose(", ".join(str(k + 1) for k in order))


def _energy(hamiltonian: Hamiltonian, run: RunResult) -> Ball:
    ring, element = energy_of(hamiltonian)
    point = {**Start.from_result(run).point, "t": Fraction(run.t0)}
    value = enclose_over(ring, element, {name: rational_ball(x) for name, x in point.items()})
    return Ball("nan") if value is None else value


CLAIM = NoPatternClaim
