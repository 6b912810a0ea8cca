"""An erratum's files, and what a reader of their Markdown or HTML sees."""

import re
from html.parser import HTMLParser
from pathlib import Path

from markdown_it import MarkdownIt

from verify.pages.errata.errata import write_errata
from verify.scenes.results.report import Report

MARKDOWN = MarkdownIt("commonmark").enable("table")


def written(report: Report, folder: Path) -> dict[str, str]:
    """The files of the report's erratum by their names; there are no others in the folder."""
    paths = write_errata(report, folder)
    assert sorted(paths) == sorted(folder.iterdir())
    return {path.name: path.read_text(encoding="utf-8") for path in paths}


def corrections(text: str) -> dict[str, list[str]]:
    """The paragraphs below each statement's heading in an `errata.md`."""
    _, *parts = re.split("^### ", text.partition("\n## Corrections\n")[2], flags=re.M)
    paragraphs = (part.partition("\n## ")[0].split("\n\n") for part in parts)
    return {head: [line.strip() for line in lines if line.strip()] for head, *lines in paragraphs}


def tables(text: str) -> list[list[list[str]]]:
    """The tables of a text in Markdown, as rows of cells."""
    rows: list[list[list[str]]] = []
    for token in MARKDOWN.parse(text):
        if token.type == "table_open":
            rows.append([])
        elif token.type == "tr_open":
            rows[-1].append([])
        elif token.type == "inline" and rows and token.level > 3:
            rows[-1][-1].append(token.content)
    return rows


class Elements(HTMLParser):
    """The tags of a page, and its text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.text = ""
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.tags.add(tag)

    def handle_data(self, data: str) -> None:
        self.text += data
