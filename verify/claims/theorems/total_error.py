"""“The total error of the mapping will keep increasing”: Λ of lieη, η even, need not grow."""

from fractions import Fraction
from itertools import pairwise

from verify.arithmetic.exact import decimal, text
from verify.claims.theorems.argument import Argument, Check, concluded, vanishes
from verify.claims.theorems.differential import flow_of_every_hamiltonian
from verify.claims.theorems.exact_maps import Areas, Point, areas
from verify.hamiltonians import systems
from verify.proof.telescoping import potential_of_lie
from verify.schemes.methods.taylor.lie import lie_map
from verify.verdict import Verdict

START = Point(p=Fraction(1), q=Fraction(-1, 20))


def increasing(start: Point = START, h: Fraction = Fraction(1, 10), steps: int = 3) -> Argument:
    """|Λ| after n steps falls: exact for the Duffing oscillator, and why for every even η."""
    duffing = systems.get("duffing").hamiltonian().with_values({"delta": 1})
    found = areas(lie_map(duffing, 2), start, h, steps).delta_j
    totals = [abs(Areas(found[:n]).lam) for n in range(1, steps + 1)]
    shown = ", ".join(f"`{decimal(x, 4)}`" for x in totals)
    flow = flow_of_every_hamiltonian(4)
    leading = flow.delta_j(*flow.lie(2))[3]
    checks = [
        Check(
            f"Duffing, δ = 1, lie2, h = {text(h)}, from (p, q) = {start}: |Λ| after n steps falls, "
            f"n = 1 … {steps}",
            any(later < earlier for earlier, later in pairwise(totals)),
            shown,
        ),
        vanishes(
            "the coefficient of h³ in ΔJ of lie2 is X·G for a generic H, with G = det Hess H/2",
            leading - flow.derive(potential_of_lie(flow, 2)),
            potential_of_lie(flow, 2) - flow.hessian_determinant / 2,
        ),
    ]
    return concluded(
        "total-error-increases",
        Verdict.REFUTED,
        f"for the Duffing oscillator (δ = 1, lie2, h = {text(h)}) from (p, q) = {start}, |Λ| after "
        f"1, 2, … steps is {shown}, exact but for the "
        "rounding of what is shown; the "
        "leading "
        "part of Λ is a boundary term that does not grow",
        """`ΔJ_k` has both signs, so its product need not grow: from (p, q) = (1, −1/20) the Duffing
        oscillator crosses q = 0, where pq changes its sign and with it 3h³δpq, and |Λ| falls within
        two steps. It is not a matter of a few steps. For lie2 and every smooth H the leading term
        of ΔJ is (h³/2) X(det Hess H), a derivative along the flow. On a fixed [0, T] its sum is
        therefore a boundary term, Λ = (h²/2) [det Hess H](z(T)) − (h²/2) [det Hess H](z(0)) +
        O(h³), which on a periodic orbit returns to O(h³) after every period. It is the next order
        that may grow with T. ∎""",
        checks,
    )


THEOREMS = {"total-error-increases": increasing}
