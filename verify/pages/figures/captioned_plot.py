"""A picture with its caption, and the phrases and numbers that captions share."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from math import inf
from typing import TYPE_CHECKING

from markupsafe import Markup

from verify.pages.text.typography import NBSP, between, is_decimal, number, whole
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.regions import FlowImage
from verify.scenes.results.run import RunResult

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_SVG_WIDTH = re.compile(r'viewBox="0 0 ([0-9.]+) ')
# A picture up to the first width, in points, takes half of the page; up to the second, most of it.
_HALF_WIDTH, _MOST_WIDTH = 420, 640
# Significant digits of a number in a caption.
_MAX_DIGITS = 4


@dataclass(frozen=True)
class Plot:
    """An inline SVG with its caption; `alternative` is the image's text alternative."""

    svg: Markup
    lead: str
    caption: str
    alternative: str

    @property
    def span(self) -> str:
        """The part of the page's width that it takes, by its width in points: half, most, full."""
        match = _SVG_WIDTH.search(self.svg)
        points = float(match[1]) if match else 0
        return "half" if points <= _HALF_WIDTH else "most" if points <= _MOST_WIDTH else "full"


def captioned_plot(
    draw: "Callable[[], Figure]", *, name: str, lead: str, caption: str, label: str = ""
) -> Plot:
    """Draw the figure and return it with its caption.

    `lead`: a title without a stop; with a stop it is also the text alternative, unless `label` is
    given.
    `name` prefixes every id in the SVG, so it must be unique on the page.
    """
    # matplotlib takes long to import, and is needed only if something is drawn.
    from verify.pages.figures.svg import render_svg

    alternative = label or f"{lead}."
    return Plot(render_svg(draw, name=name, label=alternative), f"{lead}.", caption, alternative)


# -- phrases and numbers of captions --------------------------------------------------------------


def describe_runs(runs: Sequence[RunResult]) -> str:
    """Return a sentence on the number system, the number of steps and the origin of the bounds."""
    steps = sorted({run.steps for run in runs})
    count = between(whole(steps[0]), whole(steps[-1]), " … ")
    systems = " and ".join(dict.fromkeys(map(name_arithmetic, runs)))
    methods = dict.fromkeys(
        f"{run.error_kind}: {run.error_method}" for run in runs if run.status == "finished"
    )
    bounds = f"; error bounds {' or '.join(methods)}" if methods else ""
    return f"Computed in {systems} with N = {count} steps{bounds}."


def name_arithmetic(result: RunResult | FlowImage) -> str:
    """Return the number system, with its digits unless it is float64."""
    name = result.arithmetic
    return name if name in ("float64", "") else f"{name} ({result.digits} digits)"


def known_digits(value: Value | None, *, strong: bool = False) -> Markup:
    """Return a few of the known digits; if none is known, the bound; a dash for no value."""
    if value is None:
        return Markup("–")
    if Decimal(value.value) == 0 and value.bound != "0":
        return Markup("|·|{0}≤{0}{1}").format(NBSP, round_to_few_digits(value.bound))
    template = Markup("<b>{}</b>") if strong else Markup("{}")
    return template.format(round_to_few_digits(value.value))


def round_to_few_digits(text: str) -> str:
    """Return the number rounded to its first few digits."""
    digit_count = sum(c.isdigit() for c in text.lower().partition("e")[0])
    if not is_decimal(text) or digit_count <= _MAX_DIGITS or Decimal(text) == 0:
        return number(text)
    return number(f"{Decimal(text):.{_MAX_DIGITS - 1}e}")


def round_crossover(step_size: str) -> str:
    """Return a crossover to two digits: it is interpolated, and no further digit is reliable."""
    return number(f"{Decimal(step_size):.1e}").replace(" ", NBSP)


def lg(text: str) -> float:
    """Return lg |value| of a decimal or quotient, whatever its size; −∞ for 0."""
    if "/" in text:
        value = Fraction(text)
        return lg(str(abs(value.numerator))) - lg(str(value.denominator))
    size = abs(Decimal(text))
    return float(size.log10()) if size else -inf
