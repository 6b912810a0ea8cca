"""A picture with its caption, and what captions say in the same words."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import TYPE_CHECKING

from markupsafe import Markup

from verify.pages.text.typography import NBSP, between, is_decimal, number, whole
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.regions import FlowImage
from verify.scenes.results.run import RunResult

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WIDTH = re.compile(r'viewBox="0 0 ([0-9.]+) ')
_HALF, _MOST = 420, 640  # points
_MOST_SHOWN = 4  # significant digits of a number in a caption


@dataclass(frozen=True)
class Plot:
    """An inline SVG with its caption; `alternative` is what stands for the image in words."""

    svg: Markup
    lead: str
    caption: str
    alternative: str

    @property
    def span(self) -> str:
        """How much of the page it takes, by its own width in points: half, most, full."""
        width = _WIDTH.search(self.svg)
        points = float(width[1]) if width else 0
        return "half" if points <= _HALF else "most" if points <= _MOST else "full"


def plotted(
    draw: "Callable[[], Figure]", *, name: str, lead: str, caption: str, label: str = ""
) -> Plot:
    """What `draw` draws, under the lead as a sentence, which is its text alternative too.

    `label`: another text alternative.

    `name` prefixes every id in the SVG, so it must be unique on the page.
    """
    from verify.pages.figures.svg import drawing

    alternative = label or f"{lead}."
    return Plot(drawing(draw, name=name, label=alternative), f"{lead}.", caption, alternative)


def computed(runs: Sequence[RunResult]) -> str:
    """The arithmetic, the number of steps and the origin of the error bounds, in one sentence."""
    steps = sorted({run.steps for run in runs})
    count = between(whole(steps[0]), whole(steps[-1]), " … ")
    systems = " and ".join(dict.fromkeys(map(arithmetic_of, runs)))
    methods = dict.fromkeys(
        f"{run.error_kind}: {run.error_method}" for run in runs if run.status == "finished"
    )
    bounds = f"; error bounds {' or '.join(methods)}" if methods else ""
    return f"Computed in {systems} with N = {count} steps{bounds}."


def arithmetic_of(found: RunResult | FlowImage) -> str:
    """Its number system, and with how many digits where it may have more or fewer than 17."""
    name = found.arithmetic
    return name if name in ("float64", "") else f"{name} ({found.digits} digits)"


def few_digits(found: Value | None, *, strong: bool = False) -> Markup:
    """The first of the known digits; where none is known, the bound."""
    if found is None:
        return Markup("–")
    if Decimal(found.value) == 0 and found.bound != "0":
        return Markup("|·|{0}≤{0}{1}").format(NBSP, few(found.bound))
    shown = Markup("<b>{}</b>") if strong else Markup("{}")
    return shown.format(few(found.value))


def few(text: str) -> str:
    """The first of the known digits."""
    digits = sum(c.isdigit() for c in text.lower().partition("e")[0])
    if not is_decimal(text) or digits <= _MOST_SHOWN or Decimal(text) == 0:
        return number(text)
    return number(f"{Decimal(text):.{_MOST_SHOWN - 1}e}")
