"""“The total error of the mapping will keep increasing”: Λ of lieη, η even, need not grow."""

from fractions import Fraction
from itertools import pairwise

from verify.arithmetic.exact import decimal, text
from verify.hamiltonians import systems
from verify.papers.argument import Argument, refutation, step
from verify.papers.checks.check import NUMBERS, Check, vanishes
from verify.papers.checks.differential import flow_of_every_hamiltonian
from verify.papers.exact_maps import Areas, Point, areas
from verify.proof.assistant.stated import Shipped
from verify.schemes.methods.taylor.lie import lie_map

START = Point(p=Fraction(1), q=Fraction(-1, 20))


def increasing(start: Point = START, h: Fraction = Fraction(1, 10), steps: int = 3) -> Argument:
    """|Λ| after n steps falls: exact for the Duffing oscillator, and why for every even η."""
    duffing = systems.get("duffing").hamiltonian().with_values({"delta": 1})
    found = areas(lie_map(duffing, 2), start, h, steps).delta_j
    totals = [abs(Areas(found[:n]).lam) for n in range(1, steps + 1)]
    shown = ", ".join(f"`{decimal(x, 4)}`" for x in totals)
    flow = flow_of_every_hamiltonian(4)
    leading = flow.delta_j(*flow.lie(2))[3]
    falls = Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}, from (p, q) = {start}: |Λ| after n steps falls, "
        f"n = 1 … {steps}",
        any(later < earlier for earlier, later in pairwise(totals)),
        shown,
        NUMBERS,
    )
    telescopes = vanishes(
        "the coefficient of h³ in ΔJ of lie2 is X·G for a generic H, with G = det Hess H/2",
        leading - flow.derive(flow.hessian_determinant / 2),
    )
    return refutation(
        f"for the Duffing oscillator (δ = 1, lie2, h = {text(h)}) from (p, q) = {start}, |Λ| after "
        f"1, 2, … steps is {shown}, exact but for the rounding of what is shown; the leading "
        "part of Λ is a boundary term that does not grow",
        [
            step(
                "`ΔJ_k` has both signs, so its product need not grow: from (p, q) = (1, −1/20) the "
                "Duffing oscillator crosses q = 0, where pq changes its sign and with it 3h³δpq, "
                "and |Λ| falls within two steps.",
                falls,
            ),
            step(
                "It is not a matter of a few steps. For lie2 and every smooth H the leading term "
                "of ΔJ is a derivative along the flow: ``ΔJ = (h^3/2) X(det Hess H) + O(h^4)``.",
                telescopes,
                Shipped("Theorems", "lie_telescopes_in_plane_for_even"),
                Shipped("Theorems", "determinant_of_lie_in_plane"),
            ),
            step(
                "On a fixed [0, T] its sum is therefore a boundary term, with D = det Hess H: ``Λ "
                "= (h^2/2)(D(z(T)) − D(z(0))) + O(h^3)``. On a periodic orbit it returns to O(h³) "
                "after every period.",
            ),
        ],
        remark="It is the next order that may grow with T.",
    )


THEOREMS = {"total-error-increases": increasing}
