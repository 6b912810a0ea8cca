"""A Report → one self-contained page, and the same results as JSON beside it."""

import base64
import hashlib
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from reports import mathml, typography
from reports.first_screen import SIGNS
from reports.views import page_view
from verify.keeping import write_atomically
from verify.scene_results import Report

PAGE, DATA = "index.html", "results.json"
_TEMPLATES = Path(__file__).parent / "templates"


def write(report: Report, folder: Path) -> Path:
    """Write `index.html` and `results.json` into the folder; the path of the page."""
    page = folder / PAGE
    content = render(report)
    write_atomically(folder / DATA, report.model_dump_json(indent=1))
    write_atomically(page, content)
    return page


def render(report: Report) -> str:
    """The whole page as text."""
    script = (_TEMPLATES / "page.js").read_text(encoding="utf-8")
    return (
        _environment()
        .get_template("page.html")
        .render(page=page_view(report), signs=SIGNS, script=Markup(script), digest=_digest(script))  # noqa: S704
    )


def _digest(script: str) -> str:
    """What the page's policy names its one script by: no other may run."""
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(_TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=False,
    )
    environment.filters.update(
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
    )
    environment.globals.update(equation=_equation)
    return environment


def _equation(left: str, text: str) -> Markup:
    return mathml.equation(mathml.NAMED[left], text)
