"""HTML tables and LaTeX for notebooks, plain and readable on any background.

The HTML has no style sheet, colour or script; everything is escaped. LaTeX is made of formulas and
numbers only. The classes that are shown say what they show.
"""

from collections.abc import Iterable, Sequence
from html import escape

_LONGEST = 1200  # characters of a formula that is shown
_CELL = "text-align: left; font-variant-numeric: tabular-nums"


def cut(formula: str) -> str:
    """Return the formula, or its beginning where it is long."""
    if len(formula) <= _LONGEST:
        return formula
    return f"{formula[:_LONGEST].rsplit(' ', 2)[0]} …"


def html_table(
    caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]], foot: str = ""
) -> str:
    """Return a table of texts, whose first column names the rows.

    All is aligned at the left, as words read, and digits have one width.
    """
    parts = ["<table>", f"<caption>{escape(caption)}</caption>"]
    if heads:
        cells = "".join(f'<th scope="col">{escape(head)}</th>' for head in heads)
        parts.append(f"<thead><tr>{cells}</tr></thead>")
    parts.append("<tbody>")
    # `scope` lets a screen reader name the row and the column of a cell.
    for name, *values in rows:
        cells = "".join(f'<td style="{_CELL}">{escape(value)}</td>' for value in values)
        parts.append(f'<tr><th scope="row" style="{_CELL}">{escape(name)}</th>{cells}</tr>')
    parts.append("</tbody></table>")
    if foot:
        parts.append(f"<p>{escape(foot)}</p>")
    return "".join(parts)


def short_latex(formula: str) -> str:
    """Return the LaTeX, or a remark where it is too long: LaTeX cannot be cut."""
    return formula if len(formula) <= _LONGEST else r"\text{(too long to be shown)}"


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
