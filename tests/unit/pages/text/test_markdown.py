"""The report for a repository page: the page's words, its figures as files, and nothing unescaped.

It is read by a parser of Markdown that shares nothing with what writes it.
"""

import re
from collections.abc import Callable, Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from markdown_it import MarkdownIt
from markdown_it.token import Token
from markupsafe import Markup

from tests.helpers.constructed.growth import TWO
from tests.helpers.constructed.separations import CROSSING
from tests.helpers.constructed.stability import MAP, case
from tests.helpers.constructed.work import ladder, result
from tests.helpers.pages.imported_modules import imported_by
from tests.unit.pages.test_page import EVIL, REPORTS, Reader, claim, proof, real, report, run, scene
from verify.pages.markdown.inline_text import Markdown, escape_markdown, markdown, table
from verify.pages.markdown.page import render, write
from verify.pages.page import page_view
from verify.pages.page import render as page_as_html
from verify.pages.text import mathml
from verify.prose import read_prose
from verify.scenes.results.report import Report
from verify.verdict import Verdict

HOSTILE = [
    EVIL,
    "<img src=x onerror=alert(1)>",
    "a | b | c",
    "`code` ``` fence",
    "[x](javascript:alert(1))",
    "![x](https://example.org/x.png)",
    "<https://example.org>",
    "a\n\n# b\n\n---\n\n| c |\n|---|",
    "# title #",
    "- item",
    "1. item",
    "**bold** _it_ ~~gone~~",
    "$\\alpha$ and $`x`$",
    "&lt;script&gt; \\<",
    "</summary></details><b>",
    "]: x",
    "    indented",
    "x\n===",
]
# One of each kind, for whole reports: HTML, a cell's end, a fence, a link, blocks, a tag's end.
WORST = [text for text in HOSTILE if text in (
    EVIL, "a | b | c", "`code` ``` fence", "[x](javascript:alert(1))",
    "a\n\n# b\n\n---\n\n| c |\n|---|", "</summary></details><b>")]  # fmt: skip


@cache
def written() -> tuple[str, dict[str, str]]:
    """The report of `real`, and its figures."""
    return render(real())


def parsed(text: str) -> list[Token]:
    """All tokens, those inside lines too."""
    parser = MarkdownIt("commonmark").enable(["table", "strikethrough"])
    return [t for token in parser.parse(text) for t in (token, *(token.children or ()))]


def seen(text: str) -> str:
    """What a reader sees of it: the rendered HTML's text."""
    parser = MarkdownIt("commonmark").enable(["table", "strikethrough"])
    return " ".join("".join(Reader(parser.render(text)).texts).replace("\xa0", " ").split())


def wanted(text: str) -> str:
    return " ".join(text.split())


# -- what others wrote ----------------------------------------------------------------------------

KEPT = {"a", "b", "br", "code", "details", "i", "span", "sub", "summary", "sup"}


def strange(text: str) -> Iterator[str]:
    """Elements, links and images that no report has."""
    for token in parsed(text):
        if token.type in ("html_inline", "html_block"):
            for tag, rest in re.findall(r"<\s*/?\s*([A-Za-z]+)([^>]*)>", token.content):
                allowed = r'( id="[\w.-]+")?' if tag == "a" else ""
                if tag not in KEPT or not re.fullmatch(allowed, rest):
                    yield token.content
        target = str(token.attrs.get("href", token.attrs.get("src", "")))
        if not re.fullmatch(r"(#[\w.-]+|results\.json|figures/figure-\d+\.svg)?", target):
            yield target


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_text_is_read_as_the_text_it_is(text: str) -> None:
    for shown in (escape_markdown(text), markdown(Markup("{}").format(text))):
        tokens = parsed(shown)
        assert [t.type for t in tokens][:2] == ["paragraph_open", "inline"]
        assert len([t for t in tokens if t.type == "paragraph_open"]) == 1
        assert seen(shown) == wanted(text)
        assert not list(strange(shown))


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_text_stays_in_its_cell(text: str) -> None:
    shown = table(["a", text], [[text, "1"], ["2", Markup("<code>{}</code>").format(text)]])
    cells = [t for t in parsed(shown) if t.type in ("td_open", "th_open")]
    assert len(cells) == 6
    assert seen(shown).count(wanted(text)) == 3


def test_the_checks_see_what_is_not_escaped() -> None:
    assert list(strange(Markdown(EVIL)))
    assert list(strange(Markdown("[x](https://example.org)")))
    planted = table(["a"], [[Markdown("1 | 2")]])
    assert "2" not in seen(planted)  # a pipe that is not escaped loses what is after it
    assert seen("**bold**") != "**bold**"


def evil(text: str) -> Report:
    return report(
        (
            scene(
                name=text, title=text, hamiltonian=text, parameters={text: text}, source=text,
                proofs=(proof(scheme=text, reason=text, leading=text, delta_j=text, p_next=text,
                              jacobian=((text, text), (text, text)), witness={text: text}),),
                runs=(run(scheme=text, error_method=text, fallback=text, left_domain=text),),
            ),
        ),
        title=text,
        claims=(
            claim(id=text, source=text, statement=text, scene=text, evidence=text, proof=text,
                  verdict=Verdict.REFUTED, details=((text, text), (text, text))),
        ),
        left_out=((text, text),),
    )  # fmt: skip


@cache
def shown_with(text: str) -> str:
    return render(evil(text))[0]


@pytest.mark.sample(2)
@pytest.mark.parametrize("text", WORST)
def test_what_others_wrote_stays_text_in_a_whole_report(text: str) -> None:
    assert len(WORST) == 6
    shown = shown_with(text)
    # What is a formula by chance is set as one.
    usual = shown_with("no formula" if mathml.read(text) is None else "formula")
    assert not list(strange(shown))
    # Blocks come from the template alone.
    assert [t.type for t in parsed(shown) if t.type == "heading_open"] == [
        t.type for t in parsed(usual) if t.type == "heading_open"
    ]
    for kind in ("fence", "table_open", "image", "list_item_open", "td_open"):
        count = len([t for t in parsed(shown) if t.type == kind])
        assert count == len([t for t in parsed(usual) if t.type == kind]), kind


# -- what it says ---------------------------------------------------------------------------------


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", REPORTS)
def test_the_finding_and_every_claim_are_the_pages(name: str) -> None:
    made = REPORTS[name]()
    page = page_view(made)
    text, _ = render(made)
    assert seen(text.split("\n")[2]) == wanted(page.first.finding.replace("\xa0", " "))
    ids = re.findall(r'<a id="([^"]+)"></a>', text)
    assert len(ids) == len(set(ids))
    assert {c.anchor for c in page.claims} <= set(ids)
    for token in parsed(text):
        target = str(token.attrs.get("href", ""))
        assert not target.startswith("#") or target[1:] in ids
    for c in page.claims:
        assert seen(text).count(f" {c.result.id} · system: ") or not c.scene_anchor


def test_its_numbers_are_those_of_the_runs() -> None:
    text = seen(written()[0])
    for each in real().scenes[0].runs:
        bounds = [v.bound for n, v in each.values.items() if n not in "pq" and v.bound != "0"]
        for bound in bounds:
            assert bound.partition("e")[0] in text


def stability() -> Report:
    return report((scene(stability=(case(),), stability_maps=(MAP,)),))


def sections() -> Report:
    told = claim(section="4.2 B", verdict=Verdict.REFUTED)
    return report((scene(),), claims=(told, claim(id="b", section="4.1 A"), claim(id="c")))


def everything_of_a_scheme() -> Report:
    return report((scene(separations=(CROSSING,), growth_laws=(TWO,), runs=(run(),)),))


SHOWN: dict[str, Callable[[], Report]] = {
    **REPORTS,
    "stability": stability,
    "sections": sections,
    "separation and growth": everything_of_a_scheme,
    "work": lambda: report((scene(work_precision=result(ladder())),)),
}


def outline_of_the_page(made: Report) -> tuple[list[str], list[str]]:
    """Headings and figures in their order."""
    page = page_as_html(made)
    heads = re.findall(r"(?s)<h[1-4][^>]*>(.*?)</h[1-4]>", page)
    names = [seen(head.partition('<span class="tally">')[0]) for head in heads]
    labels = re.findall(r'<svg[^>]* aria-label="([^"]*)"', page)
    return names, [wanted(label) for label in labels]


def outline_of_the_text(made: Report) -> tuple[list[str], list[str]]:
    tokens = parsed(render(made)[0])
    heads = [b for a, b in pairwise(tokens) if a.type == "heading_open"]
    return [seen(t.content) for t in heads], [seen(t.content) for t in tokens if t.type == "image"]


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", SHOWN)
def test_it_shows_what_the_page_shows_in_the_same_order(name: str) -> None:
    heads, figures = outline_of_the_page(SHOWN[name]())
    own_heads, own_figures = outline_of_the_text(SHOWN[name]())
    assert own_heads == heads
    assert [f.rstrip(".") for f in own_figures] == [f.rstrip(".") for f in figures]


def test_the_outlines_differ_where_the_reports_do() -> None:
    assert outline_of_the_text(sections()) != outline_of_the_page(report((scene(),)))
    swapped = real().model_copy(update={"scenes": (), "claims": real().claims})
    assert outline_of_the_text(real()) != outline_of_the_page(swapped)


def test_the_first_picture_stands_once_and_is_pointed_to() -> None:
    text, figures = written()
    told = page_view(real()).first.plot
    assert told is not None
    assert text.count(f"![{escape_markdown(told.lead)}]") == 1
    assert f"Picture: [{escape_markdown(told.lead)}](#telling)" in text
    assert len(figures) == text.count("![")


def test_the_tiles_and_the_counts_of_a_section_are_the_pages() -> None:
    text, _ = render(sections())
    assert "- ✓ <b>2</b> proved: exact algebra shows it\n- ✗ <b>1</b> refuted: " in text
    assert "### 4.2 B\n\n✗ 1 refuted\n" in text


def test_a_claim_that_is_closed_shows_its_statement() -> None:
    for statement, shown in (
        ("ΔJ = O(`h^η`), *a*", "ΔJ = O(h<sup>η</sup>), *a*"),
        ("It is `3*p**2*q`.", "It is 3 p<sup>2</sup> q."),  # no MathML in a <summary>
        ("It is `p*sqrt(q)/(1 + h*q)`.", "p √q/(1+h q)"),
        (f"{EVIL} $x$", "&lt;script&gt;"),
    ):
        text, _ = render(report(claims=(claim(statement=read_prose(statement)),)))
        summary, _ = re.findall(r"<summary>(.*)</summary>", text)  # its own, and that of the terms
        assert shown in summary
        assert "<script" not in text


def test_the_views_own_markup_is_set_and_not_shown() -> None:
    text, _ = render(report((scene(separations=(CROSSING,), runs=(run(),)),)))
    assert "Truncation against rounding" in text
    assert "<code>" in text
    assert not re.search(r"&lt;/?(code|b|sub|span)", text)


# -- figures --------------------------------------------------------------------------------------


def test_every_figure_is_a_file_with_a_text_alternative(tmp_path: Path) -> None:
    path = write(real(), tmp_path)
    assert path == tmp_path / "report.md"
    images = [t for t in parsed(path.read_text(encoding="utf-8")) if t.type == "image"]
    assert len(images) == 3
    for image in images:
        assert image.content
        root = ElementTree.fromstring((tmp_path / str(image.attrs["src"])).read_text())  # noqa: S314
        assert float(root.get("width", "0pt").removesuffix("pt")) > 100
        assert root[0].get("fill") == "#fff"
    written = {str(f.relative_to(tmp_path)) for f in tmp_path.rglob("*") if f.is_file()}
    shown = {str(image.attrs["src"]) for image in images}
    assert written == {"report.md", "results.json"} | shown


def test_figures_of_an_earlier_report_do_not_stay(tmp_path: Path) -> None:
    write(real(), tmp_path)
    users = tmp_path / "figures" / "figure-mine.svg"
    users.write_text("mine")
    write(report((scene(),)), tmp_path)
    assert list((tmp_path / "figures").iterdir()) == [users]


def test_a_proof_is_written_without_matplotlib() -> None:
    code = "from verify.pages.markdown.page import render; render(REPORTS['proof only']())"
    assert not {"matplotlib", "verify.pages.figures.step_size_figures"} & imported_by(code)


def test_the_same_report_gives_the_same_text() -> None:
    assert render(real()) == written()


# -- formulas -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("p**2/2 - cos(q)", r"\tfrac{1}{2}\,p^{2}-\cos q"),
        ("3*delta*h**3*p*q", r"3\,h^{3}\,\delta \,p\,q"),
        ("sqrt(p)/(1 + omega0**2)", r"\sqrt{p}/(1+{\omega }_{0}^{2})"),
        ("k_max*exp(-q)", r"k_{\mathrm{max}}\,e^{-q}"),
    ],
)
def test_formulas_are_tex(formula: str, expected: str) -> None:
    assert re.sub(r"\s", "", markdown(mathml.formula(formula))) == re.sub(
        r"\s", "", f"$`{expected}`$"
    )


def test_no_formula_holds_what_ends_it() -> None:
    text, _ = written()
    fences = [token for token in parsed(text) if token.type == "fence"]
    (program,) = (fence for fence in fences if fence.info != "math")
    formulas = [fence.content for fence in fences if fence is not program]
    assert formulas
    for formula in formulas:
        assert "$" not in formula
        assert formula.count(r"\left") == formula.count(r"\right")
        assert formula.count("{") == formula.count("}")
    scripts = [claim.reproduction for claim in real().claims if claim.reproduction]
    assert [(program.info, program.content)] == [("python", script) for script in scripts]
