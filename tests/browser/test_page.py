"""The page in a real browser: quiet, closed to the outside, seen in full, and open to everyone."""

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.browser.checks import Opened, opened
from tests.browser.made_pages import EVIL, NAMES, page_of, planted
from tests.unit.pages.test_mistakes_by_library import GIVEN
from tests.unit.pages.test_page import report
from verify.pages.page import render

pytestmark = pytest.mark.left_to_ci

PHONE, DESK = 360, 1280
SHORT = "own scene"  # the page on which errors are planted
A4 = 680  # px: 210 mm without the margins
CUT = """() => [...document.querySelectorAll('.statement, .why')].filter(
  each => each.scrollWidth > each.clientWidth && getComputedStyle(each).display !== 'inline')
  .map(each => each.textContent)"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pages")


def file_of(folder: Path, page: str) -> Path:
    path = folder / "index.html"
    path.write_text(page, encoding="utf-8")
    return path


# -- what each page is held to --------------------------------------------------------------------


# Each page at both widths and in both themes; a theme changes no width.
SEEN = [
    (name, width, scheme)
    for k, name in enumerate(NAMES)
    for width, scheme in zip(
        (PHONE, DESK), (("light", "dark"), ("dark", "light"))[k % 2], strict=True
    )
]


@pytest.mark.sample(3)
@pytest.mark.parametrize(("name", "width", "scheme"), SEEN)
def test_the_page_is_quiet_closed_seen_in_full_and_kept_from_nobody(
    browser: Browser, folder: Path, name: str, width: int, scheme: str
) -> None:
    path = file_of(folder, page_of(name))
    with opened(browser, path, width=width, scheme=scheme) as found:
        assert found.sideways() == []
        assert found.violations() == []
        found.open_all()
        assert found.sideways() == []
        assert found.without_size() == []
        assert found.page.locator("svg").count() > 0
        assert found.page.locator("math").count() > 5
        assert found.violations() == []
        assert found.console_errors() == []
        assert found.outside() == []


def test_contents_that_are_longer_than_the_window_are_scrolled_by_keys(
    browser: Browser, folder: Path
) -> None:
    with opened(browser, file_of(folder, page_of("paper")), width=DESK, height=200) as found:
        contents = "document.querySelector('.contents > details')"
        assert found.page.evaluate(f"{contents}.scrollHeight > {contents}.clientHeight")
        assert found.violations() == []


@pytest.mark.parametrize("name", NAMES)
def test_what_others_wrote_stays_text(browser: Browser, folder: Path, name: str) -> None:
    with opened(browser, file_of(folder, page_of(name))) as found:
        assert EVIL in found.open_all().page.inner_text("body")
        assert found.page.evaluate("window.planted") is None
        assert found.page.locator("script").count() == 1
        assert found.page.locator("img").count() == 0


@pytest.mark.parametrize("name", NAMES)
def test_the_answer_and_its_picture_are_on_the_first_screen(
    browser: Browser, folder: Path, name: str
) -> None:
    with opened(browser, file_of(folder, page_of(name))) as found:
        for part in ("h1", ".finding", ".tiles", "#telling svg", "#telling .seen"):
            box = found.page.locator(part).bounding_box()
            assert box is not None
            assert box["y"] + box["height"] <= 800, part


def test_formulas_are_set_in_the_font_of_the_page(browser: Browser, folder: Path) -> None:
    path = file_of(folder, page_of("paper"))
    fonts = "[...document.fonts].map(font => `${font.family} ${font.status}`)"
    with opened(browser, path) as found:
        assert found.page.evaluate(fonts) == ["Formulas loaded"]
    refused = file_of(folder, page_of("paper").replace("; font-src data:", "", 1))
    with opened(browser, refused) as found:
        assert found.page.evaluate(fonts) == ["Formulas error"], "a planted error"


# -- ways through the page ------------------------------------------------------------------------


def test_an_anchor_opens_its_claim(browser: Browser, folder: Path) -> None:
    path = file_of(folder, page_of("paper"))
    with opened(browser, path, fragment="#claim-eq-3") as found:
        assert found.page.locator("#claim-eq-3 .evidence").is_visible()
        assert (
            found.page.evaluate("document.querySelectorAll('.claim > details[open]').length") == 1
        )
        found.page.click("#telling .jump a")
        evidence = found.page.locator("#claim-table-9 .evidence")
        evidence.wait_for(state="visible", timeout=2000)
        found.page.click("#claim-table-9 > details > summary")
        assert not evidence.is_visible()
        found.page.click("#claim-table-9 > .mark")
        assert evidence.is_visible(), "the same link again"


def test_a_tile_shows_the_claims_that_it_counts_and_all_again(
    browser: Browser, folder: Path
) -> None:
    with opened(browser, file_of(folder, page_of("paper"))) as found:
        seen = "[...document.querySelectorAll('.claim')].filter(c => c.checkVisibility())"
        every = found.page.evaluate(f"{seen}.length")
        tile = found.page.locator(".tile.refuted button")
        tile.click()
        told = found.page.evaluate(f"{seen}.map(c => c.dataset.told)")
        assert set(told) == {"refuted"}
        assert 0 < len(told) < every
        assert tile.get_attribute("aria-pressed") == "true"
        found.page.evaluate("location.hash = '#' + document.querySelector('.claim[hidden]').id")
        found.page.wait_for_function(f"{seen}.length === {every}", timeout=2000)
        tile.click()
        tile.click()
        assert found.page.evaluate(f"{seen}.length") == every


def test_claims_are_filtered_by_words_and_by_kind_of_mistake(
    browser: Browser, folder: Path
) -> None:
    page = render(report(claims=GIVEN))
    for width, scheme in ((PHONE, "dark"), (DESK, "light")):
        with opened(browser, file_of(folder, page), width=width, scheme=scheme) as found:
            seen = "[...document.querySelectorAll('.claim')].filter(c => c.checkVisibility())"
            ids = f"{seen}.map(c => c.querySelector('.foot').textContent.trim()).sort()"
            assert found.sideways() == []
            assert found.violations() == []
            found.page.locator(".filters input").fill("BETA ruth")
            assert found.page.evaluate(ids) == ["b/3"]
            found.page.locator(".filters input").fill("")
            found.page.locator(".filters select").select_option("wrong order")
            assert found.page.evaluate(ids) == ["b/2", "b/3"]
            found.page.locator("#wrong a").first.click()
            found.page.wait_for_function(f"{seen}.length === {len(GIVEN)}", timeout=2000)
            assert found.page.locator(".filters select").input_value() == ""


def test_on_demand_the_refuted_statements_come_first_with_their_readings(
    browser: Browser, folder: Path
) -> None:
    with opened(browser, file_of(folder, page_of("paper"))) as found:
        told = "[...document.querySelectorAll('.claim')].map(c => [c.id, c.dataset.told])"
        seen = "[...document.querySelectorAll('.claim')].filter(c => c.checkVisibility())"
        before = found.page.evaluate(told)
        button = found.page.locator("button.sort")
        button.click()
        after = found.page.evaluate(told)
        ranks = ["refuted", "undecided", "measured"]
        assert after == sorted(
            before, key=lambda each: ranks.index(each[1]) if each[1] in ranks else len(ranks)
        )
        assert found.page.evaluate(f"{seen}.length") == len(before), "none is hidden"
        assert found.page.locator("div.group > .claim").count() == len(before), "all in one list"
        assert found.violations() == []
        button.click()
        assert found.page.evaluate(told) == before


def test_without_scripts_a_claim_opens_by_hand(browser: Browser, folder: Path) -> None:
    with opened(browser, file_of(folder, page_of("paper")), script=False) as found:
        evidence = found.page.locator("#claim-table-9 .evidence")
        assert not evidence.is_visible()
        found.page.click("#claim-table-9 > details > summary")
        assert evidence.is_visible()


def test_the_keyboard_reaches_the_content_and_opens_a_claim(browser: Browser, folder: Path) -> None:
    with opened(browser, file_of(folder, page_of("paper"))) as found:
        page = found.page
        page.keyboard.press("Tab")
        skip = page.locator(".skip:focus").bounding_box()
        assert skip is not None
        assert skip["x"] >= 0
        page.keyboard.press("Enter")
        assert page.evaluate("document.activeElement.id") == "content"
        page.locator("#claim-eq-3 summary").focus()
        outline = "getComputedStyle(document.activeElement).outlineStyle"
        page.keyboard.press("Enter")
        assert page.evaluate(outline) == "solid"
        assert page.locator("#claim-eq-3 .evidence").is_visible()


def test_the_contents_stand_at_the_side_and_fold_on_a_phone(browser: Browser, folder: Path) -> None:
    path = file_of(folder, page_of("paper"))
    link = ".contents a[href='#terms']"
    with opened(browser, path) as found:
        assert found.page.locator(link).is_visible()
        found.page.click(link)
        assert found.page.locator(link).is_visible(), "it stays beside what it led to"
    with opened(browser, path, width=PHONE) as found:
        assert not found.page.locator(link).is_visible()
        found.page.click(".contents summary")
        assert found.page.locator(link).is_visible()


@pytest.mark.sample(2)
@pytest.mark.parametrize("full", [True, False])
@pytest.mark.parametrize("name", NAMES)
def test_on_paper_a_full_page_is_unfolded_another_says_what_was_found(
    browser: Browser, folder: Path, name: str, full: bool
) -> None:
    path = file_of(folder, page_of(name, full=full))
    with opened(browser, path, width=A4, scheme="dark") as found:
        page = found.page
        page.emulate_media(media="print", color_scheme="dark")
        for folded in ("main details table", ".evidence"):
            assert all(each.is_visible() is full for each in page.locator(folded).all()), folded
        for each in page.locator(".claim .statement, .claim .why, #terms dd").all():
            assert each.is_visible()
        assert page.evaluate(CUT) == []
        assert not page.locator(".contents").is_visible()
        assert found.sideways() == []
        assert (
            page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
        )
        assert page.pdf(prefer_css_page_size=True).startswith(b"%PDF")


# -- planted errors -------------------------------------------------------------------------------

CONTROLS: dict[str, tuple[str, bool, Callable[[Opened], list[str]]]] = {
    "an error on the console": (
        "<script>console.error('planted')</script>", False, Opened.console_errors,
    ),
    "a script that the policy stops": (
        "<script>console.log('planted')</script>", True, Opened.console_errors,
    ),
    "an image from outside": ("<img src='https://x.invalid/a.png' alt='a'>", False, Opened.outside),
    "an image that the policy stops": (
        "<img src='https://x.invalid/a.png' alt='a'>", True, Opened.console_errors,
    ),
    "a wide element": ("<div style='width: 3000px'>wide</div>", True, Opened.sideways),
    "a figure without size": ("<svg width='0' height='0'></svg>", True, Opened.without_size),
    "a formula that is hidden": (
        "<math style='display: none'><mi>x</mi></math>", True, Opened.without_size,
    ),
    "faint text": (
        "<p style='color: #aaa; background: #fff'>faint</p>", True, Opened.violations,
    ),
    "a picture without words": ("<svg role='img'></svg>", True, Opened.violations),
}  # fmt: skip


@pytest.mark.parametrize("error", CONTROLS)
def test_a_planted_error_is_seen(browser: Browser, folder: Path, error: str) -> None:
    text, policy, check = CONTROLS[error]
    with opened(browser, file_of(folder, planted(SHORT, text, policy=policy))) as found:
        assert check(found.open_all())


@pytest.mark.parametrize("policy", [True, False])
def test_without_a_planted_error_none_is_seen(browser: Browser, folder: Path, policy: bool) -> None:
    checks = {check for _, kept, check in CONTROLS.values() if kept is policy}
    with opened(browser, file_of(folder, planted(SHORT, "", policy=policy))) as found:
        found.open_all()
        assert [wrong for check in checks for wrong in check(found)] == []
