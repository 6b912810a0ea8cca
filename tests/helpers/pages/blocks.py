"""The blocks of a page of the documentation: files to save, commands and their output, Python."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from difflib import unified_diff
from pathlib import Path

from markdown_it import MarkdownIt

from tests.paths import ROOT

# The documentation, which a user follows: by its place in the repository, its text.
DOCS = ROOT / "docs"
PATHS = [ROOT / "README.md", DOCS / "README.md", *sorted(DOCS.glob("[!_]*/*.md"))]
PAGES = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in PATHS}
NAMED = re.compile(r"(?P<how>[Ss]ave this as|[Aa]ppend this to) `(?P<name>[\w.-]+)`[^`]*:$")
LEFT_OUT = "…"  # alone on a line: some lines of the output are left out
# What takes long is run by a person: when that was last done, and how long it took. Or why not.
BY_HAND = re.compile(r"<!-- run by hand: (?P<date>[\d-]+), (?P<took>\d+ (?:s|min|h)) -->")
NOT_RUN = re.compile(r"<!-- not run: (?P<why>[^<>]+) -->")
RUN_TIME = re.compile(r"… s\b")
SECONDS = r"\d+(?:\.\d+)?(?:e[-+]?\d+)? s"


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, its first line, and what stands right before it.

    `remarks`: the comments between that and the block, which a reader does not see.
    """

    language: str
    text: str
    line: int
    before: str
    remarks: tuple[str, ...] = ()

    @property
    def is_by_hand(self) -> bool:
        """Whether it is marked as run by a person, or as not run."""
        return any(BY_HAND.match(x) or NOT_RUN.match(x) for x in self.remarks)

    @property
    def last_run(self) -> date | None:
        """When a person last ran it. Raises ValueError where that is no day."""
        marks = filter(None, map(BY_HAND.match, self.remarks))
        return next((date.fromisoformat(mark["date"]) for mark in marks), None)

    @property
    def file(self) -> str:
        """The file that the page says to save it as, or to append it to; empty where none."""
        named = NAMED.search(self.before)
        return named["name"] if named else ""

    @property
    def is_appended(self) -> bool:
        named = NAMED.search(self.before)
        return named is not None and named["how"].lower().startswith("append")


def blocks(page: str) -> list[Block]:
    """The fenced blocks of a Markdown text, in its order."""
    found: list[Block] = []
    before, remarks = "", list[str]()
    for token in MarkdownIt().enable("table").parse(page):
        if token.type == "html_block" and token.content.startswith("<!--"):
            remarks += token.content.splitlines()
            continue
        if token.type == "fence":
            assert token.map is not None
            line = token.map[0] + 1
            found.append(Block(token.info.strip(), token.content, line, before, (*remarks,)))
        if token.type == "inline":
            before = " ".join(token.content.split())
        elif token.type != "paragraph_close":
            before = ""
        if token.type != "paragraph_close":
            remarks = []
    return found


def commands(console: str) -> Iterator[tuple[str, list[str]]]:
    """Each command of a console block, on one line, and the lines that it prints."""
    assert console.startswith("$ "), console
    for part in re.split(r"^\$ ", console, flags=re.MULTILINE)[1:]:
        command, printed = [], part.splitlines()
        while printed and printed[0].endswith("\\"):
            command.append(printed.pop(0).removesuffix("\\").strip())
        yield " ".join([*command, printed[0].strip()]), printed[1:]


def agrees(shown: list[str], printed: list[str]) -> bool:
    """Whether a page shows what is printed, word for word, but for what it marks with `…`.

    `… s` stands for a run time, and a line with nothing but `…` for any lines. Blanks at the end of
    a line cannot be seen, and are not compared.
    """
    pattern = "".join(
        r"(?:.*\n)*?" if line.strip() == LEFT_OUT else _run_times(line.rstrip()) + r"\n"
        for line in shown
    )
    return re.fullmatch(pattern, "".join(f"{line.rstrip()}\n" for line in printed)) is not None


def _run_times(line: str) -> str:
    return SECONDS.join(re.escape(part) for part in RUN_TIME.split(line))


def difference(shown: list[str], printed: list[str]) -> str:
    return "\n".join(unified_diff(shown, printed, "the page", "what comes out", lineterm=""))


def anchors(page: str) -> set[str]:
    """What links can name on a page: its headings, as GitHub writes them."""
    tokens = MarkdownIt().parse(page)
    heads = [tokens[k + 1].content for k, t in enumerate(tokens) if t.type == "heading_open"]
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


def links(page: str) -> Iterator[str]:
    """Where the links and the pictures of a page point to."""
    for token in MarkdownIt().enable("table").parse(page):
        for child in token.children or []:
            target = child.attrGet({"link_open": "href", "image": "src"}.get(child.type, ""))
            if target is not None:
                yield str(target)


def code_in_text(page: str) -> Iterator[str]:
    """What stands between backticks in its sentences and tables."""
    for token in MarkdownIt().enable("table").parse(page):
        yield from (c.content for c in token.children or [] if c.type == "code_inline")


def broken(path: Path, page: str) -> list[str]:
    """The links of the page at this path that lead nowhere; those to other hosts are not asked."""
    found = []
    for link in links(page):
        name, _, anchor = link.partition("#")
        if re.match(r"https?://", name):
            continue
        file = path if not name else path.parent / name
        there = file.exists()
        if there and anchor:
            there = anchor in anchors(file.read_text(encoding="utf-8"))
        if not there:
            found.append(link)
    return found
