"""README.md and docs: links that lead somewhere, an index, every command, a README of 8 kB."""

import re
from collections.abc import Iterator
from datetime import date
from pathlib import Path

import click
import pytest

from tests.helpers.pages.blocks import PAGES, agrees, blocks, broken, code_in_text, commands, links
from tests.paths import ROOT
from verify.commands.main import cli

MOST_BYTES = 8000  # of the README
LINKED = {ROOT / name: text for name, text in PAGES.items()} | {
    path: path.read_text(encoding="utf-8")
    for path in (
        *ROOT.glob("[A-Z]*.md"),
        ROOT / "tests" / "README.md",
        ROOT / "reference/README.md",
    )
}


def test_every_link_leads_somewhere() -> None:
    found = {path.name: broken(path, text) for path, text in LINKED.items()}
    assert not {name: links for name, links in found.items() if links}
    assert sum(len([*links(text)]) for text in LINKED.values()) > 100, "they were looked at"


@pytest.mark.parametrize(
    ("link", "wrong"),
    [("docs/how-to/run.md", "docs/runs.md"),
     ("docs/how-to/prove.md#from-coefficients", "docs/how-to/prove.md#from"),
     ("#sixty-seconds", "#seconds"), ("reports/paper/cat.png", "reports/cat.png")],
)  # fmt: skip
def test_a_link_that_leads_nowhere_is_seen(link: str, wrong: str) -> None:
    page = PAGES["README.md"]
    for mark in ("", "!"):
        assert not broken(ROOT / "README.md", f"{page}\n{mark}[x]({link})")
        assert broken(ROOT / "README.md", f"{page}\n| {mark}[x]({wrong}) |") == [wrong]
    assert not broken(ROOT / "README.md", f"{page}\n[x](https://example.org/{wrong})")


def test_every_page_stands_in_the_index_and_the_readme_leads_there() -> None:
    pages = {name.removeprefix("docs/") for name in PAGES if name.startswith("docs/")}
    pages.remove("README.md")
    assert len(pages) > 20
    assert set(links(PAGES["docs/README.md"])) == pages
    assert "docs/README.md" in set(links(PAGES["README.md"]))


def test_the_readme_is_short() -> None:
    assert len(PAGES["README.md"].encode()) <= MOST_BYTES


@pytest.mark.parametrize("page", ["README.md", "docs/reference/command-line.md"])
def test_every_command_stands_in_the_table(page: str) -> None:
    rows = [line for line in PAGES[page].splitlines() if line.startswith("| ")]
    missing = {name for name in cli.commands if not any(f"`verify {name}" in row for row in rows)}
    assert not missing


def commands_below(command: click.Command, name: str) -> Iterator[tuple[str, click.Command]]:
    """Each command with its name, such as `verify reference make`."""
    yield name, command
    if isinstance(command, click.Group):
        for below, inner in command.commands.items():
            yield from commands_below(inner, f"{name} {below}")


COMMANDS = dict(commands_below(cli, "verify"))
OPTIONS = {o for c in COMMANDS.values() for p in c.params for o in p.opts} | {"-h", "--help"}
TEXTS = {name: [*code_in_text(text)] for name, text in PAGES.items()}


def stale(code: str) -> bool:
    """Whether it is a command of ours, or options, that are not there."""
    words = code.replace("COMMAND", "prove").split()
    named = " ".join(words[:2]) in COMMANDS or words[:1] != ["verify"] or len(words) == 1
    options = {word for word in words if re.match(r"--?[a-z]", word)}
    return not named or (words[0] in {"verify", *options} and not options <= OPTIONS)


def test_commands_and_options_in_sentences_are_there() -> None:
    assert not {name: [c for c in codes if stale(c)] for name, codes in TEXTS.items()
                if any(map(stale, codes))}  # fmt: skip
    assert sum(code.startswith(("verify ", "--")) for c in TEXTS.values() for code in c) > 70


@pytest.mark.parametrize(
    ("code", "is_stale"),
    [
        ("verify prove --scheme lie2", False), ("verify prov", True), ("--digits", False),
        ("--digit", True), ("verify run --digit 5", True), ("-o", False), ("-x", True),
        ("verify", False), ("verify.prove", False), ("python -m verify", False),
    ],
)  # fmt: skip
def test_a_stale_command_or_option_is_seen(code: str, is_stale: bool) -> None:
    assert stale(code) == is_stale


def test_what_is_not_typed_is_looked_at_by_another_test() -> None:
    texts = {
        name for name, page in PAGES.items() if any(b.language == "text" for b in blocks(page))
    }
    assert texts == {"docs/how-to/tests-of-your-own.md"}, (
        "test_own_integrator.py looks at its failure"
    )


# -- what takes long ------------------------------------------------------------------------------


def undone(page: str, today: date) -> list[str]:
    """What is wrong with the marks of a page: which blocks nobody is known to have run."""
    found = []
    for block in blocks(page):
        parts = re.split(r"&&|\n", block.text.replace("\\\n", " "))
        starts = [part.split(maxsplit=1)[0] for part in parts if part.strip()]
        ours = block.language == "sh" and any(Path(word).name == "verify" for word in starts)
        if ours and not block.is_by_hand:
            found.append(f"line {block.line}: no mark says when this was last run")
        if any("run" in remark for remark in block.remarks) and not block.is_by_hand:
            found.append(f"line {block.line}: no mark is written so")
        try:
            if block.last_run and block.last_run > today:
                found.append(f"line {block.line}: {block.last_run} is to come")
        except ValueError as error:
            found.append(f"line {block.line}: {error}")
    return found


def test_what_the_suite_does_not_run_says_when_a_person_did() -> None:
    today = date.today()
    assert not {name: wrong for name, page in PAGES.items() if (wrong := undone(page, today))}
    assert sum(block.last_run is not None for page in PAGES.values() for block in blocks(page)) > 10


LONG = "so:\n\n<!-- run by hand: 2026-11-24, 6 min -->\n```sh\nverify report paper -o paper\n```\n"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<!-- run by hand: 2026-11-24, 6 min -->\n", ""), ("11-24", "13-24"), ("11-24", "11-25"),
        ("run by hand", "run by me"), ("6 min", "long"), (" 6 min", ""),
        ("-->\n", "-->\n\nNow:\n\n"),
    ],
)  # fmt: skip
def test_a_mark_that_is_missing_or_wrong_is_seen(old: str, new: str) -> None:
    today = date(2026, 11, 24)
    assert not undone(LONG, today)
    assert not undone(LONG.replace("run by hand: 2026-11-24, 6 min", "not run: it is yours"), today)
    assert LONG.count(old) == 1
    assert undone(LONG.replace(old, new), today)


def test_no_run_time_is_printed_as_a_fact() -> None:
    """Of what commands print: a page that says when it was measured may have them."""
    shown = [
        line
        for text in PAGES.values()
        for block in blocks(text)
        if block.language == "console"
        for _, lines in commands(block.text)
        for line in lines
    ]
    assert len(shown) > 200
    assert any("… s" in line for line in shown)
    told = [line.replace("less than 1 s of", "") for line in shown]  # which is said of all that do
    assert not [line for line in told if re.search(r"\d s\b", line)]


@pytest.mark.parametrize(
    ("shown", "printed", "same"),
    [
        ("20 steps, … s; done", "20 steps, 0.157 s; done", True),
        ("20 steps, … s; done", "20 steps, 1e-05 s; done", True),
        ("20 steps, … s; done", "20 steps, long s; done", False),
        ("20 steps, … s; done", "21 steps, 0.157 s; done", False),
        ("… steps", "20 steps", False),
        ("a\n…\nd", "a\nb\nc\nd", True),
        ("a\n…\nd", "a\nd", True),
        ("a\n…\nd", "a\nb\nc", False),
        ("h … 2h", "h … 2h", True),
        ("h … 2h", "h 1 2h", False),
        ("a.c", "abc", False),
        ("a  ", "a", True),
    ],
)
def test_only_what_is_marked_may_differ(shown: str, printed: str, same: bool) -> None:
    assert agrees(shown.splitlines(), printed.splitlines()) == same
