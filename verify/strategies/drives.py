"""What makes a drawn H depend on time: a term in t that is added to it, and that nothing cancels.

The forms are those of a driven oscillator, from a force that grows with t to a mass that changes;
each is smooth for all real t, and is a function of q and t alone or of p and t alone, so that
H = T + V stays so.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from hypothesis import strategies as st

from verify.strategies.formulas import Formula
from verify.strategies.terms import Drawer, Limits, Sum

Form = Sequence[str]  # one is drawn, with the numbers in it
_FORCES: Sequence[Form] = (
    ("q*t", "q*t**2", "q*t**3"),
    ("q*cos({3}t)", "q*sin({3}t)"),
    ("q*sin({3}t + t**2{/})",),  # its frequency grows
)


@st.composite
def driven(
    draw: st.DrawFn,
    still: st.SearchStrategy[Formula],
    kinds: Sequence[str],
    limits: Limits,
    *,
    linear: bool = False,
) -> Formula:
    """Formulas with such a term beside, which in p and q is of one of the kinds, and of no higher
    degree than the limits say; `linear`: in q, which what grows faster than that outgrows."""
    formula, d, term = draw(still), Drawer(draw, limits), Sum()
    forms = _FORCES if linear else [*_FORCES, *_others(kinds, limits)]
    sign, size = d.pick(("+", "-")), d.positive()
    term.add(size, d.filled(d.pick(d.pick(forms))))
    return replace(formula, text=f"{formula.text} {sign} {term.written({})}", timed=True)


def _others(kinds: Sequence[str], limits: Limits) -> Iterator[Form]:
    if limits.degree > 1:
        # A stiffness that comes and goes; a kinetic energy that dies out in both directions.
        yield [f"q**{n}*cos({{3}}t)" for n in range(2, min(4, limits.degree) + 1)]
        yield ["p**2/(1 + t**2{/})"]
    if "trigonometric" in kinds:  # a pendulum whose point of support moves
        yield ["cos({3}t)*cos(q)"]
