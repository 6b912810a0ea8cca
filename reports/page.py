"""A Report → one self-contained page, and the same results as JSON beside it."""

from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from reports import mathml, typography
from reports.views import page_view
from verify.keeping import write_atomically
from verify.scene_results import Report
from verify.verdict import Verdict

PAGE, DATA = "index.html", "results.json"

# Each verdict's sign and meaning; the sign and the word say it, the colour only helps.
SIGNS = {
    Verdict.PROVED: ("✓", "exact algebra shows it"),
    Verdict.ENCLOSED: ("⊂", "a rigorous numeric enclosure shows it; its error bound is certain"),
    Verdict.MEASURED: ("≈", "numbers show it; their error bounds are estimates, not certificates"),
    Verdict.REFUTED: ("✗", "a counterexample, or the proof of the contrary, contradicts it"),
    Verdict.UNDECIDED: ("?", "neither shown nor contradicted by what was computed"),
}


def write(report: Report, folder: Path) -> Path:
    """Write `index.html` and `results.json` into the folder; the path of the page."""
    page = folder / PAGE
    content = render(report)
    write_atomically(folder / DATA, report.model_dump_json(indent=1))
    write_atomically(page, content)
    return page


def render(report: Report) -> str:
    """The whole page as text."""
    return _environment().get_template("page.html").render(page=page_view(report), signs=SIGNS)


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent / "templates", encoding="utf-8"),
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
