"""Terms in t that make a drawn H depend on time, and that no other term cancels.

The forms are those of a driven oscillator, from a force that grows with t to a mass that changes;
each is smooth for all real t, and is a function of q and t alone or of p and t alone, so that a
separable H = T + V stays separable.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from hypothesis import strategies as st

from verify.strategies.formulas import Formula
from verify.strategies.terms import Drawer, Limits, Sum

Form = Sequence[str]  # one is drawn, with the numbers in it
# For the braces see `Drawer.fill_braces`.
_FORCES: Sequence[Form] = (
    ("q*t", "q*t**2", "q*t**3"),
    ("q*cos({3}t)", "q*sin({3}t)"),
    ("q*sin({3}t + t**2{/})",),  # its frequency grows
)


@st.composite
def driven_formulas(
    draw: st.DrawFn,
    still: st.SearchStrategy[Formula],
    kinds: Sequence[str],
    limits: Limits,
    *,
    linear: bool = False,
) -> Formula:
    """Draw formulas with one term in t more, of one of the kinds in q and p.

    Its degree is within the limits. `linear`: the term is linear in q, so that an H which grows
    faster than that stays confining at each t.
    """
    formula, d, term = draw(still), Drawer(draw, limits), Sum()
    # A confining H outgrows a force that is linear in q, but not a stiffness that changes its
    # sign.
    forms = _FORCES if linear else [*_FORCES, *_other_forms(kinds, limits)]
    sign, size = d.pick(("+", "-")), d.positive()
    term.add(size, d.fill_braces(d.pick(d.pick(forms))))
    return replace(formula, text=f"{formula.text} {sign} {term.to_text({})}", timed=True)


def _other_forms(kinds: Sequence[str], limits: Limits) -> Iterator[Form]:
    if limits.degree > 1:
        # A stiffness that comes and goes; a kinetic energy that dies out in both directions.
        yield [f"q**{n}*cos({{3}}t)" for n in range(2, min(4, limits.degree) + 1)]
        yield ["p**2/(1 + t**2{/})"]
    if "trigonometric" in kinds:  # a pendulum whose point of support moves
        yield ["cos({3}t)*cos(q)"]
