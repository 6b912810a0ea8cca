"""Eq. 1 and its invariant, and the equations of second order, 17 and 25, from Eq. 18 and 26."""

from collections.abc import Sequence

import sympy

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import parse
from verify.algebra.symbols import P, Q
from verify.papers.argument import Argument, ArgumentTexts, same, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.proof.assistant.shipped_theory import ShippedTheorem

_TEXTS = ArgumentTexts(__file__)

DUFFING = ("p**2/2 + q**2/2 + delta*q**4/4", "q + delta*q**3")  # H, and q'' less its sign
PENDULUM = ("p**2/2 - cos(q)", "sin(q)")
_NAMES = ("p", "q", "delta")


def eq_1(sign: int = -1) -> Argument:
    """Prove X H = 0 and div X = 0 for a generic H; `sign` is that of p' = −H_q."""
    flow = flow_of_every_hamiltonian(2)
    diff, h_p, h_q = flow.ring.diff, flow.h_p, flow.h_q
    rate = vanishes("dH/dt = `H_p` p' + `H_q` q' for a generic H", sign * h_q * h_p + h_p * h_q)
    divergence = vanishes(
        "the divergence ∂p'/∂p + ∂q'/∂q for a generic H", sign * diff(h_q, "p") + diff(h_p, "q")
    )
    return _TEXTS.proof("eq_1", rate=rate, divergence=divergence)


def _from_hamiltonian(
    name: str, source: str, formulas: Sequence[str], words: str, *theorems: ShippedTheorem
) -> Argument:
    hamiltonian, force = (parse(text, _NAMES, source=name) for text in formulas)
    h_p, h_q = sympy.diff(hamiltonian, P), sympy.diff(hamiltonian, Q)
    # q'' = d(H_p)/dt along the solution
    second = sympy.diff(h_p, P) * -h_q + sympy.diff(h_p, Q) * h_p
    first = same(
        f"H = `{formulas[0]}`: `H_p` − p and `H_q` less the force", [h_p - P, h_q - force], _NAMES
    )
    whole = same(
        f"q'' by Eq. 1 with H = `{formulas[0]}`, plus `{formulas[1]}`", [second + force], _NAMES
    )
    return _TEXTS.proof(
        "_from_hamiltonian",
        first=first,
        theorems=theorems,
        whole=whole,
        source=source,
        force=to_text(force),
        words=words,
    )


def eq_17(formulas: Sequence[str] = DUFFING) -> Argument:
    """Prove q'' + q + δq³ = 0 from Eq. 18."""
    words = ", for every δ, the coefficient of the cubic restoring force"
    return _from_hamiltonian("eq-17", "Eq. 18", formulas, words)


def eq_25(formulas: Sequence[str] = PENDULUM) -> Argument:
    """Prove q'' + sin q = 0 from Eq. 26."""
    moves = ShippedTheorem("Examples", "pendulum_moves")
    return _from_hamiltonian("eq-25", "Eq. 26", formulas, "", moves)
