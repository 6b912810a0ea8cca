"""A Report → one self-contained page, and the same results as JSON beside it."""

import base64
import hashlib
from functools import cache
from pathlib import Path

from jinja2 import Environment
from markupsafe import Markup

from verify.files import write_atomically
from verify.pages.environment import TEMPLATES, environment
from verify.pages.page_view import page_view
from verify.scenes.results.report import Report

PAGE, DATA = "index.html", "results.json"


def write(report: Report, folder: Path, *, full: bool = False) -> Path:
    """Write `index.html` and `results.json` into the folder; the path of the page."""
    page = folder / PAGE
    content = render(report, full=full)
    write_atomically(folder / DATA, report.model_dump_json(indent=1))
    write_atomically(page, content)
    return page


def render(report: Report, *, full: bool = False) -> str:
    """The whole page as text; `full`: with all that it folds open, on paper too."""
    script = (TEMPLATES / "page.js").read_text(encoding="utf-8")
    template = _environment().get_template("page.html")
    page = template.render(
        page=page_view(report),
        full=full,
        script=Markup(script),  # noqa: S704 - our own
        digest=_digest(script),
    )
    return page.replace("<details", "<details open") if full else page


def _digest(script: str) -> str:
    """What the page's policy names its one script by: no other may run."""
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()


@cache
def _environment() -> Environment:
    return environment()
