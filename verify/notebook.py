"""Results for notebooks: HTML tables and LaTeX, and numbers for the tables of other libraries.

The HTML is plain and readable on any background: it has no style sheet, colour or script, and
all text in it is escaped. LaTeX is made for formulas and numbers only. Each class decides which of
its values are shown. pandas and xarray are imported when a table of theirs is requested.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from html import escape
from importlib import import_module
from typing import Any

from verify.errors import InputError

_MAX_CHARACTERS = 1200  # the limit for a formula that is shown
_CELL_STYLE = "text-align: left; font-variant-numeric: tabular-nums"


def cut(formula: str) -> str:
    """Return the formula, or its beginning if it is long."""
    if len(formula) <= _MAX_CHARACTERS:
        return formula
    # The last term may be cut: it goes, with the sign before it.
    return f"{formula[:_MAX_CHARACTERS].rsplit(' ', 2)[0]} …"


def html_table(
    caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]], foot: str = ""
) -> str:
    """Return a table of texts, whose first column names the rows.

    All cells are aligned at the left, and all digits have the same width.
    """
    parts = ["<table>", f"<caption>{escape(caption)}</caption>"]
    if heads:
        cells = "".join(f'<th scope="col">{escape(head)}</th>' for head in heads)
        parts.append(f"<thead><tr>{cells}</tr></thead>")
    parts.append("<tbody>")
    # `scope` lets a screen reader name the row and the column of a cell.
    for name, *values in rows:
        cells = "".join(f'<td style="{_CELL_STYLE}">{escape(value)}</td>' for value in values)
        parts.append(f'<tr><th scope="row" style="{_CELL_STYLE}">{escape(name)}</th>{cells}</tr>')
    parts.append("</tbody></table>")
    if foot:
        parts.append(f"<p>{escape(foot)}</p>")
    return "".join(parts)


def short_latex(formula: str) -> str:
    """Return the LaTeX, or a remark if it is too long: LaTeX cannot be cut."""
    return formula if len(formula) <= _MAX_CHARACTERS else r"\text{(too long to be shown)}"


def aligned_latex(lines: Iterable[str]) -> str:
    r"""Return equations one below the other, each aligned at its &.

    >>> print(aligned_latex(["a &= b", "c &= d"]))
    $$\begin{aligned} a &= b \\ c &= d \end{aligned}$$
    """
    return r"$$\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}$$"


def number_latex(text: str) -> str:
    """Return the LaTeX of a decimal text: −1.2 · 10⁻⁵ for `-1.2e-05`."""
    mantissa, _, exponent = text.lower().partition("e")
    power = int(exponent or 0)
    return rf"{mantissa} \cdot 10^{{{power}}}" if power else mantissa


# -- tables of optional libraries -----------------------------------------------------------------


def import_library(name: str, feature: str) -> Any:
    """Import the library of that name; InputError, one line, if it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        raise InputError("library", name, f"is not installed, and {feature} needs it") from None


def nearest_float(text: str) -> float:
    """Return the float nearest to an exact text, a decimal or a quotient; nan for an empty one.

    >>> nearest_float("1/4"), nearest_float("1.5e-03")
    (0.25, 0.0015)
    """
    return float(Fraction(text)) if "/" in text else float(text or "nan")
