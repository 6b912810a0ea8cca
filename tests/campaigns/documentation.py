"""What takes long on the pages, done by a person: each such block, on its page, and its new mark.

    python -m tests.campaigns.documentation                       # which there are, and when
    python -m tests.campaigns.documentation docs/how-to/bench.md  # run those of pages
    python -m tests.campaigns.documentation --all --write         # all, and write today's date

A page is read through as the suite does it, in a folder of its own, and what is marked
`<!-- run by hand: … -->` is done, too; where it prints, it is compared. Of README.md only that is
done, in a clone.
"""

import argparse
import contextlib
import re
import subprocess
import tempfile
import time
from collections.abc import Iterator
from datetime import date
from pathlib import Path

from tests.helpers.pages.blocks import BY_HAND, PAGES, Block, blocks
from tests.helpers.pages.session import PageError, Session, folder_of_a_user
from tests.paths import ROOT

_SHORT = 100  # seconds that are told as such
README = "README.md"


def marked(page: str) -> list[Block]:
    """The blocks of a page that a person runs."""
    return [block for block in blocks(PAGES[page]) if block.last_run is not None]


def run(page: str) -> dict[int, str]:
    """How long each of a page's marked blocks took, by its line. PageError where one fails."""
    times, last = {}, marked(page)[-1]
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder).resolve()
        session = Session(by_hand=True)
        with _clone(place) if page == README else folder_of_a_user(place):
            for block in marked(page) if page == README else blocks(PAGES[page]):
                begun = time.monotonic()
                session.play(block)
                if block.last_run is not None:
                    times[block.line] = shown(time.monotonic() - begun)
                    print(f"{page}:{block.line}  {times[block.line]}", flush=True)
                if block == last:
                    break
    return times


@contextlib.contextmanager
def _clone(place: Path) -> Iterator[None]:
    """A fresh checkout, which is what the README's set-up begins with."""
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(place)], check=True)
    with contextlib.chdir(place):
        yield


def shown(seconds: float) -> str:
    """A time as marks have it.

    >>> shown(12.3), shown(140), shown(9000)
    ('12 s', '2 min', '2 h')
    """
    if seconds < _SHORT:
        return f"{max(1, round(seconds))} s"
    return f"{round(seconds / 60)} min" if seconds < 60 * _SHORT else f"{seconds // 3600:.0f} h"


def dated(text: str, times: dict[int, str], today: date) -> str:
    """The page with the day and the time in the mark of each block that begins at such a line."""
    lines = text.splitlines(keepends=True)
    for line, took in times.items():
        at = next(k for k in range(line - 1, -1, -1) if BY_HAND.match(lines[k]))
        lines[at] = re.sub(BY_HAND, f"<!-- run by hand: {today}, {took} -->", lines[at])
    return "".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pages", nargs="*", choices=[[], *filter(marked, PAGES)], metavar="PAGE")
    parser.add_argument("--all", action="store_true", help="Run those of all pages.")
    parser.add_argument("--write", action="store_true", help="Write today's date to the marks.")
    given = parser.parse_args()
    for page in given.pages or filter(marked, PAGES):
        if not (given.all or given.pages):
            print(*(f"{page}:{b.line}  {b.last_run}  {b.text.split('#')[0].splitlines()[0]}"
                    for b in marked(page)), sep="\n")  # fmt: skip
            continue
        try:
            times = run(page)
        except PageError as error:
            print(f"{page}: {error}")
            continue
        if given.write:
            (ROOT / page).write_text(dated(PAGES[page], times, date.today()), encoding="utf-8")


if __name__ == "__main__":
    main()
