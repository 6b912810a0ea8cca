"""How anything shows itself in a notebook: plain tables, readable on any background.

HTML without a style sheet, a colour or a script; everything is escaped. LaTeX is made of formulas
and numbers only. What is shown is said by those whose it is; nothing is known of it here.
"""

from collections.abc import Iterable, Sequence
from html import escape

_LONGEST = 1200  # characters of a formula that is shown
_CELL = "text-align: left; font-variant-numeric: tabular-nums"


def cut(formula: str) -> str:
    """A formula as it is, or its beginning where it is long."""
    if len(formula) <= _LONGEST:
        return formula
    return f"{formula[:_LONGEST].rsplit(' ', 2)[0]} …"


def html_table(
    caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]], foot: str = ""
) -> str:
    """The first column names the rows; all is text. Left, as words read; digits line up."""
    parts = ["<table>", f"<caption>{escape(caption)}</caption>"]
    if heads:
        cells = "".join(f'<th scope="col">{escape(head)}</th>' for head in heads)
        parts.append(f"<thead><tr>{cells}</tr></thead>")
    parts.append("<tbody>")
    for name, *values in rows:
        cells = "".join(f'<td style="{_CELL}">{escape(value)}</td>' for value in values)
        parts.append(f'<tr><th scope="row" style="{_CELL}">{escape(name)}</th>{cells}</tr>')
    parts.append("</tbody></table>")
    if foot:
        parts.append(f"<p>{escape(foot)}</p>")
    return "".join(parts)


def short_latex(formula: str) -> str:
    """A formula's LaTeX cannot be cut; one that is too long is left out."""
    return formula if len(formula) <= _LONGEST else r"\text{(too long to be shown)}"


def aligned_latex(lines: Iterable[str]) -> str:
    r"""Equations one below the other, each with the & at which it is aligned.

    >>> print(aligned_latex(["a &= b", "c &= d"]))
    $$\begin{aligned} a &= b \\ c &= d \end{aligned}$$
    """
    return r"$$\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}$$"


def number_latex(text: str) -> str:
    """`-1.2e-05` → −1.2 · 10⁻⁵."""
    mantissa, _, exponent = text.lower().partition("e")
    power = int(exponent or 0)
    return rf"{mantissa} \cdot 10^{{{power}}}" if power else mantissa
