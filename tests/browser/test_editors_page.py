"""The erratum's page for an editor, printed by a real browser: one sheet, and closed to others."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.browser.checks import opened
from tests.helpers.constructed.papers import paper_sized
from tests.unit.pages.errata.test_what_others_wrote import hostile
from verify.pages.errata.errata import write_errata

pytestmark = pytest.mark.left_to_ci

A4 = (595, 842)  # points


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The editor's page of an erratum with all the repairs and causes of the paper."""
    folder = tmp_path_factory.mktemp("errata")
    write_errata(paper_sized(), folder)
    return (folder / "editor.html").read_text(encoding="utf-8")


def printed(browser: Browser, path: Path, text: str) -> list[tuple[int, int]]:
    """The size of each sheet, in points, of the page as it is printed."""
    path.write_text(text, encoding="utf-8")
    with opened(browser, path) as seen:
        pdf = seen.page.pdf(prefer_css_page_size=True)
    sheets = re.findall(rb"/Type /Page\n.*?/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", pdf, re.DOTALL)
    assert len(sheets) == len(re.findall(rb"/Type /Page\b", pdf))
    return [(round(float(width)), round(float(height))) for width, height in sheets]


def test_the_page_of_the_whole_paper_is_one_sheet_of_a4(
    browser: Browser, page: str, tmp_path: Path
) -> None:
    assert page.count("<li>") > 15, "the causes, tables and conclusions"
    assert printed(browser, tmp_path / "editor.html", page) == [A4]


def test_a_page_with_more_on_it_is_seen_to_be_more_than_one_sheet(
    browser: Browser, page: str, tmp_path: Path
) -> None:
    twice = page.replace("</ul>", "</ul>" + "<p>It is so.</p>" * 60, 1)
    assert printed(browser, tmp_path / "editor.html", twice) == [A4, A4]


def test_nothing_on_it_is_cut_or_asked_for_from_outside(
    browser: Browser, page: str, tmp_path: Path
) -> None:
    path = tmp_path / "editor.html"
    path.write_text(page, encoding="utf-8")
    with opened(browser, path, width=703) as seen:  # 186 mm, the sheet without its margins
        assert seen.sideways() == []
        assert seen.without_size() == []
        assert seen.violations() == []
        assert seen.console_errors() == []
        assert seen.outside() == []


def test_what_others_wrote_starts_nothing_there(browser: Browser, tmp_path: Path) -> None:
    write_errata(hostile(), tmp_path)
    with opened(browser, tmp_path / "editor.html") as seen:
        assert seen.page.locator("script, img, a").count() == 0
        assert "<script>alert(1)</script>" in seen.page.inner_text("body")
        assert seen.outside() == []
