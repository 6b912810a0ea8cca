"""Eq. 1 and its invariant, and the equations of second order, 17 and 25, from Eq. 18 and 26."""

from collections.abc import Sequence

import sympy

from verify.algebra.embedding import embed
from verify.algebra.formula import parse, to_text
from verify.claims.theorems.argument import Argument, Check, concluded, vanishes
from verify.claims.theorems.differential import flow_of_every_hamiltonian
from verify.schemes.step_map import P, Q
from verify.verdict import Verdict

DUFFING = ("p**2/2 + q**2/2 + delta*q**4/4", "q + delta*q**3")  # H, and q'' less its sign
PENDULUM = ("p**2/2 - cos(q)", "sin(q)")


def conservative(sign: int = -1) -> Argument:
    """X H = 0 and div X = 0 for a generic H; `sign` is that of p' = −H_q."""
    flow = flow_of_every_hamiltonian(2)
    diff, h_p, h_q = flow.ring.diff, flow.h_p, flow.h_q
    return concluded(
        "eq-1",
        Verdict.PROVED,
        "along solutions of Eq. 1 dH/dt = −`H_q` `H_p` + `H_p` `H_q` = 0 for every H, and the flow "
        "has no divergence",
        """With p' = −`H_q`, q' = `H_p` the chain rule gives dH/dt = `H_p` p' + `H_q` q' = 0: the
        system is conservative and H an invariant, on whose level curves the exact flow can be
        drawn. Its divergence −`H_qp` + `H_pq` is 0 too, so that the exact flow preserves area
        (Liouville). None of it needs that H is separable. ∎""",
        [
            vanishes(
                "dH/dt and the divergence, for a generic H",
                sign * h_q * h_p + h_p * h_q,
                sign * diff(h_q, "p") + diff(h_p, "q"),
            )
        ],
    )


def _from_hamiltonian(name: str, source: str, formulas: Sequence[str], words: str) -> Argument:
    hamiltonian, force = (parse(text, ("p", "q", "delta"), source=name) for text in formulas)
    h_p, h_q = sympy.diff(hamiltonian, P), sympy.diff(hamiltonian, Q)
    # q'' = d(H_p)/dt along the solution
    second = sympy.diff(h_p, P) * -h_q + sympy.diff(h_p, Q) * h_p
    ring, (gap,) = embed([second + force], ("p", "q", "delta"))
    return concluded(
        name,
        Verdict.PROVED,
        f"H as in {source} gives q' = p and p' = −(`{to_text(force)}`), so that q'' + "
        f"`{to_text(force)}` = 0{words}",
        """q' = `H_p` = p, and p' = −`H_q`; so q'' = p' = −`H_q`, which is the equation. Conversely
        p = q' and the equation give Eq. 1 with this H. ∎""",
        [
            Check(
                f"q'' by Eq. 1 with H = `{formulas[0]}`, plus `{formulas[1]}`",
                ring.decide(gap).zero is True,
                f"`{to_text(second + force)}`",
            )
        ],
    )


def eq_17(formulas: Sequence[str] = DUFFING) -> Argument:
    """q'' + q + δq³ = 0 from Eq. 18."""
    words = ", for every δ, the coefficient of the cubic restoring force"
    return _from_hamiltonian("eq-17", "Eq. 18", formulas, words)


def eq_25(formulas: Sequence[str] = PENDULUM) -> Argument:
    """q'' + sin q = 0 from Eq. 26."""
    return _from_hamiltonian("eq-25", "Eq. 26", formulas, "")


THEOREMS = {"eq-1": conservative, "eq-17": eq_17, "eq-25": eq_25}
