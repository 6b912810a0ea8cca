"""What the templates are set with, for the page and for the Markdown that is made of them."""

from collections.abc import Callable
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from verify.pages.figures.captioned_plot import Plot
from verify.pages.text import mathml, notation, prose, typography, words
from verify.pages.text.signs import SIGNS

TEMPLATES = Path(__file__).parent / "templates"
_FILTERS = (
    prose.prose, prose.quoted, prose.sentence, prose.cell, notation.notation, mathml.name,
    mathml.formula, mathml.plain, typography.exact, typography.number,
    typography.whole, typography.listed, typography.every,
)  # fmt: skip


def environment(drawn: Callable[[Plot], Markup] = lambda plot: plot.svg) -> Environment:
    """`drawn`: a picture as the format has it."""
    made = Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters.update({each.__name__: each for each in _FILTERS})
    own = {"equation": _equation, "hamiltonian": mathml.hamiltonian}
    made.globals.update(own, words=words, signs=SIGNS, drawn=drawn)
    return made


def _equation(left: str, text: str) -> Markup:
    return mathml.equation(mathml.NAMED[left], text)
