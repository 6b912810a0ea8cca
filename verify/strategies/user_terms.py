"""The terms that make a formula trigonometric, exponential or rational.

Each is drawn as its numerator, its denominator, and whether its coefficient has to be positive.
Where H is to be `confining` (H → ∞ in every direction), a term is bounded; or at most linear in one
variable and bounded in the other, so that even powers of both outgrow it; or ≥ 0. Where H is to be
`open` along the half-axis x → s·∞, y = 0, a term stays bounded above there. Where H is `free`, any
term will do.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from verify.strategies.terms import Drawer, combination, power, times

Shape = Literal["confining", "open", "free"]
# Numerator, denominator, whether the coefficient has to be positive.
TermShape = tuple[str, str, bool]


@dataclass(frozen=True)
class TermRequest:
    """The requested term: of both variables if `mixed`; an open H is so along x → direction·∞."""

    shape: Shape
    mixed: bool
    x: str = "q"
    y: str = "p"
    direction: int = 1


def draw_trigonometric(d: Drawer, want: TermRequest) -> TermShape:
    """Draw sin or cos of a multiple of q, p or both."""
    function = d.pick(("cos", "sin"))
    if not want.mixed:
        return f"{function}({times(d.inner(), d.pick((want.x, want.y)))})", "", False
    if d.whole(0, 3) == 3:  # it vanishes on both axes
        outer, inner = d.pick((("p", "q"), ("q", "p")))
        return f"{outer}*sin({times(d.inner(), inner)})", "", False
    return f"{function}({combination(d.inner(), _draw_factor(d))})", "", False


def draw_exponential(d: Drawer, want: TermRequest) -> TermShape:
    """Draw exp, cosh or sinh of a multiple, or a bump exp(−x²)."""
    bump = d.whole(0, 3) == 3
    if want.mixed:
        if bump:
            return "exp(-p**2 - q**2)", "", False
        return _draw_mixed_exponential(d, want)
    name = d.pick((want.x, want.y))
    if bump:
        return f"exp(-{name}**2)", "", False
    if want.shape == "open" and name == want.x:  # exp(−direction·k·x) → 0 along the half-axis
        return f"exp({times(-want.direction * d.inner(), name)})", "", False
    functions = ("exp", "cosh") if want.shape == "confining" else ("exp", "cosh", "sinh")
    function = d.pick(functions)
    k = _draw_factor(d) if function == "exp" else d.inner()
    return f"{function}({times(k, name)})", "", want.shape == "confining"


def _draw_mixed_exponential(d: Drawer, want: TermRequest) -> TermShape:
    if want.shape == "open":  # on y = 0 the exponent is −direction·k·x, which falls
        along, across = -want.direction * d.inner(), _draw_factor(d)
        k, m = (along, across) if want.x == "p" else (across, along)
        return f"exp({combination(k, m)})", "", False
    function = d.pick(("exp", "cosh"))
    return f"{function}({combination(d.inner(), _draw_factor(d))})", "", want.shape == "confining"


def draw_rational(d: Drawer, want: TermRequest) -> TermShape:
    """Draw a quotient over c + x² or the like with c ≥ 1, so that no denominator vanishes."""
    constant = d.whole(1, min(d.limits.size, 9))
    if not want.mixed:
        name = d.pick((want.x, want.y))
        return d.pick(("", name)), f"{constant} + {name}**2", False
    match d.whole(0, 2):
        case 0:
            return "p*q", f"{constant} + p**2 + q**2", False
        case 1:
            return "", f"{constant} + ({combination(1, _draw_factor(d))})**2", False
    # y, which vanishes on the axis where H is open, has to stand above.
    x, y = (want.x, want.y) if want.shape == "open" else d.pick((("q", "p"), ("p", "q")))
    exponent = d.whole(1, 2)
    positive = exponent == 2 and want.shape == "confining"
    return power(y, exponent), f"{constant} + {x}**2", positive


def _draw_factor(d: Drawer) -> int:
    """Draw ±1, ±2 or ±3; the simplest is 1."""
    index = d.whole(0, 5)
    return -(index // 2 + 1) if index % 2 else index // 2 + 1


TERMS_BY_KIND: dict[str, Callable[[Drawer, TermRequest], TermShape]] = {
    "trigonometric": draw_trigonometric,
    "exponential": draw_exponential,
    "rational": draw_rational,
}
KINDS = ("polynomial", *TERMS_BY_KIND)
