"""What the templates of every format are set with: the same filters, so that all say the same."""

from collections.abc import Callable
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from verify.pages.text import mathml, typography, words

TEMPLATES = Path(__file__).parent / "templates"


def environment(
    *, autoescape: bool = True, finalize: Callable[[object], object] | None = None
) -> Environment:
    """`finalize` sets what each expression gives, in a format that is not HTML."""
    made = Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=autoescape,  # noqa: S701 - off only for what is not HTML
        finalize=finalize,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters.update(
        prose=typography.prose,
        sentence=typography.sentence,
        cell=typography.cell,
        is_number=typography.is_number,
        number=typography.number,
        whole=typography.whole,
        listed=typography.listed,
        formula=mathml.formula,
        name=mathml.name,
        plain=mathml.plain,
        every=every,
    )
    made.globals.update(equation=_equation, words=words)
    return made


def every(count: int, one: str, many: str = "") -> str:
    """`the one run` or `all 1,200 runs`; `many`: the plural where it is not `one` with an s."""
    if count == 1:
        return f"the one {one}"
    return f"all {typography.whole(count)} {many or one + 's'}"


def _equation(left: str, text: str) -> Markup:
    return mathml.equation(mathml.NAMED[left], text)
