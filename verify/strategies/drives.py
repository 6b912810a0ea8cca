"""What makes a drawn H depend on time: a term in t that is added to it, and that nothing cancels.

The forms are those of a driven oscillator, from a force that grows with t to a mass that changes;
each is smooth for all real t, and is a function of q and t alone or of p and t alone, so that
H = T + V stays so.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from hypothesis import strategies as st

from verify.strategies.formulas import Formula
from verify.strategies.terms import Drawer, Limits, Sum, power, times

_Form = Callable[[Drawer], str]


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
    found = draw(still)
    forms = _LINEAR if linear else [*_LINEAR, *_others(kinds, limits)]
    return replace(found, text=found.text + _drive(Drawer(draw, limits), forms), timed=True)


def _others(kinds: Sequence[str], limits: Limits) -> Iterator[_Form]:
    if limits.degree > 1:
        yield from (_parametric, _mass)
    if "trigonometric" in kinds:
        yield _shaken


def _drive(d: Drawer, forms: Sequence[_Form]) -> str:
    """The term, with its sign."""
    sign, size = d.pick(("+", "-")), d.positive()
    term = Sum()
    term.add(size, d.pick(forms)(d))
    return f" {sign} {term.written({})}"


def _force_of_power(d: Drawer) -> str:
    return f"q*{power('t', d.whole(1, 3))}"


def _force_of_waves(d: Drawer) -> str:
    return f"q*{d.pick(('cos', 'sin'))}({times(d.inner(), 't')})"


def _chirp(d: Drawer) -> str:
    """A force whose frequency grows."""
    return f"q*sin({times(d.inner(), 't')} + t**2{_over(d)})"


def _parametric(d: Drawer) -> str:
    """A stiffness that comes and goes."""
    return f"{power('q', d.whole(2, min(4, d.limits.degree)))}*cos({times(d.inner(), 't')})"


def _shaken(d: Drawer) -> str:
    """A pendulum whose point of support moves."""
    return f"cos({times(d.inner(), 't')})*cos(q)"


def _mass(d: Drawer) -> str:
    """A kinetic energy that dies out in both directions of time."""
    return f"p**2/(1 + t**2{_over(d)})"


def _over(d: Drawer) -> str:
    number = d.whole(1, d.limits.size)
    return "" if number == 1 else f"/{number}"


_LINEAR: Sequence[_Form] = (_force_of_power, _force_of_waves, _chirp)
