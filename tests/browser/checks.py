"""What a page in a browser is held to: each check returns what is wrong, in words."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page

_OPEN_ALL = "document.querySelectorAll('details').forEach(each => each.open = true)"
_WITHOUT_SIZE = """() => [...document.querySelectorAll('math, svg')].filter(each => {
  const box = each.getBoundingClientRect();
  return !(box.width > 0 && box.height > 0);
}).map(each => `${each.localName}: ${each.textContent.trim().slice(0, 60)}`)"""
_SIDEWAYS = """() => {
  const over = document.documentElement.scrollWidth - window.innerWidth;
  return over > 0 ? [`${over} px wider than the window`] : [];
}"""


class Opened:
    """A page, with what it said and asked for from the first moment on."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.errors: list[str] = []
        self.requests: list[str] = []
        page.on("console", self._said)
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))

    def _said(self, message: Any) -> None:
        if message.type in ("error", "warning"):
            self.errors.append(message.text)

    def open_all(self) -> "Opened":
        """Unfolds everything, so that what is folded is looked at too."""
        self.page.evaluate(_OPEN_ALL)
        return self

    # -- the checks -------------------------------------------------------------------------------

    def console_errors(self) -> list[str]:
        return self.errors

    def outside(self) -> list[str]:
        """Requests for anything but this file."""
        return [url for url in self.requests if not url.startswith(("file:", "data:"))]

    def without_size(self) -> list[str]:
        """Formulas and figures that cannot be seen."""
        return list(self.page.evaluate(_WITHOUT_SIZE))

    def sideways(self) -> list[str]:
        return list(self.page.evaluate(_SIDEWAYS))

    def violations(self) -> list[str]:
        """What axe-core finds that is serious or critical, with where it is."""
        found = Axe().run(self.page).response["violations"]
        return [
            f"{each['id']} ({each['impact']}): {node['target']} {node['failureSummary']}"
            for each in found
            if each["impact"] in ("serious", "critical")
            for node in each["nodes"][:5]
        ]


@contextmanager
def opened(
    browser: Browser, path: Path, *, width: int = 1280, height: int = 800, fragment: str = "",
    scheme: Any = "light", script: bool = True,
) -> Iterator[Opened]:  # fmt: skip
    """The file in a window of its own that has no network."""
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=scheme, java_script_enabled=script
    )
    try:
        context.route(lambda url: not url.startswith("file:"), lambda route: route.abort())
        found = Opened(context.new_page())
        found.page.goto(f"{path.as_uri()}{fragment}")
        yield found
    finally:
        context.close()
