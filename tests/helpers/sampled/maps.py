"""Drawn one-step maps, and their expansions in h by sympy."""

import math
from collections.abc import Sequence

import sympy
from hypothesis import strategies as st

from tests.helpers.sampled.formulas import H, P, Q, lie_step, plain, polynomials, rationals


@st.composite
def planted(draw: st.DrawFn) -> tuple[str, str, str, int]:
    """H, p', q' and the order that the map would have without what is planted in it."""
    text = f"p**2/2 + {draw(polynomials('pq', degree=3, most_terms=2))}"
    eta = draw(st.integers(0, 3))
    step = [str(x) for x in lie_step(plain(text), eta)]
    for _ in range(draw(st.integers(0, 2))):
        at, power = draw(st.integers(0, 1)), draw(st.integers(0, 4))
        term = draw(polynomials("pq", degree=2, most_terms=1) | st.just("1"))
        step[at] += f" + ({draw(rationals(3))})*h**{power}*{term}"
    return text, step[0], step[1], eta


def coefficients(x: sympy.Expr) -> dict[int, sympy.Expr]:
    found = sympy.Poly(sympy.expand(x), H)
    return {int(n): c for (n,), c in found.terms()} if found.as_expr() != 0 else {}


def order_of_flow(hamiltonian: sympy.Expr, step: Sequence[sympy.Expr], most: int) -> int | None:
    """Up to which power of h the map agrees with the flow."""
    own, flow = [coefficients(x) for x in step], [P, Q]
    for n in range(most + 1):
        pairs = zip(own, flow, strict=True)
        if any(sympy.expand(c.get(n, 0) - y / math.factorial(n)) != 0 for c, y in pairs):
            return n - 1
        flow = [
            sympy.expand(hamiltonian.diff(P) * y.diff(Q) - hamiltonian.diff(Q) * y.diff(P))
            for y in flow
        ]
    return None


def determinant(step: Sequence[sympy.Expr]) -> sympy.Expr:
    p, q = step
    return sympy.expand(p.diff(P) * q.diff(Q) - p.diff(Q) * q.diff(P) - 1)
