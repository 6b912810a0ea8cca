"""The files of the theory: each imports what comes before it, assumes nothing, and can be read."""

import re
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.helpers.rocq.assumptions import assuming_words, without_comments
from verify.proof.assistant.shipped_theory import (
    FOLDER,
    files,
    format_modules,
    imports_of,
    install,
    sort_by_imports,
    text_of,
)

MOST_LINES, MOST_CHARACTERS, MOST_FILES = 300, 110, 22
_REQUIRED = re.compile(r"^From (Coq|AreaPreservation) Require Import [\w ]+\.$")


def needs() -> dict[str, list[str]]:
    return {name: imports_of(name) for name in files()}


def test_no_two_files_have_one_name() -> None:
    assert len(files()) == len(list(FOLDER.rglob("*.v"))) > 50
    assert {path for path in FOLDER.rglob("*") if path.is_file()} >= set(files().values())


def test_every_import_is_of_a_file_and_all_files_have_an_order() -> None:
    assert {name for imported in needs().values() for name in imported} < set(files())
    before: set[str] = set()
    for name in sort_by_imports(files()):
        assert set(imports_of(name)) <= before, name
        before.add(name)
    assert before == set(files())
    assert sort_by_imports(["Step"])[-1] == "Step"
    assert set(sort_by_imports(["Step"])) < before


def test_there_is_no_circle_of_imports() -> None:
    list(TopologicalSorter(needs()).static_order())
    with pytest.raises(CycleError):
        list(TopologicalSorter({**needs(), "Rings": ["Theorems"]}).static_order())


@pytest.mark.parametrize("name", files())
def test_a_file_says_what_it_imports_in_whole_lines_before_all_else(name: str) -> None:
    """As they are looked for by what puts the files in an order, or into one file."""
    plain = without_comments(text_of(name))
    required = [line for line in plain.splitlines() if re.search(r"\b(Require|From)\b", line)]
    assert required
    assert all(map(_REQUIRED.match, required)), required
    first, *_ = re.split(r"^(?:Section|Definition|Lemma|Fixpoint|Record)\b", plain, flags=re.M)
    assert all(line in first for line in required)


@pytest.mark.parametrize("name", files())
def test_a_file_assumes_nothing(name: str) -> None:
    assert assuming_words(text_of(name)) == []


@pytest.mark.parametrize("name", files())
def test_a_file_can_be_read(name: str) -> None:
    lines = text_of(name).splitlines()
    assert len(lines) <= MOST_LINES
    # What a file imports is one line, as it is looked for.
    assert [x for x in lines if len(x) > MOST_CHARACTERS and not _REQUIRED.match(x)] == []
    assert text_of(name).isascii()
    assert text_of(name).startswith("(** ")


def test_no_folder_has_many_files() -> None:
    folders = [path for path in (FOLDER, *FOLDER.rglob("*")) if path.is_dir()]
    assert all(len(list(path.glob("*.v"))) <= MOST_FILES for path in folders)


def test_what_stands_alone_imports_nothing_but_the_library() -> None:
    plain = without_comments(format_modules(["Step"], user_text="defect_of_step"))
    assert re.findall(r"^From (\w+) Require", plain, re.MULTILINE) == ["Coq"]
    opened = re.findall(r"^Module (\w+)\.$", plain, re.MULTILINE)
    assert opened == [name for name in sort_by_imports(["Step"]) if name in opened]
    assert opened[-1] == "Step"
    ended = re.findall(r"^End (\w+)\.$", plain, re.MULTILINE)
    assert [name for name in ended if name in opened and ended.count(name) == 1] != []
    assert set(opened) <= set(ended)


def test_the_theory_is_installed_with_its_order(tmp_path: Path) -> None:
    written = install(tmp_path / "theory")
    assert [path.stem for path in written] == sort_by_imports(files())
    assert [path.read_text(encoding="utf-8") for path in written] == [
        text_of(path.stem) for path in written
    ]
    options, *listed = (tmp_path / "theory" / "_CoqProject").read_text().splitlines()
    assert options == "-Q . AreaPreservation"
    assert [tmp_path / "theory" / line for line in listed] == written


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Axiom a : False.", ["Axiom"]),
        ("Section S. Variables a b : nat. End S.", ["Variables"]),
        ("Proof. admit. Admitted.", ["admit", "Admitted"]),
        ("Declare  Module M.", ["Declare  Module"]),
        ("Unset Guard Checking.", ["Unset Guard Checking"]),
        ("Context (a : nat).", ["Context"]),
        ("Section S. End S. Context (a : nat).", ["Context"]),
        ("Section S. Context (a : nat). End S.", []),
        ("(* Axiom (* admit *) Variable *) Definition a := 1.", []),
        ("Definition parameters := axioms.", []),
    ],
)
def test_words_that_assume_something_are_found(text: str, words: list[str]) -> None:
    assert assuming_words(text) == words


@pytest.mark.parametrize("text", ["(* a", "a *)", "(* (* a *)"])
def test_a_comment_that_has_no_end_is_no_comment(text: str) -> None:
    with pytest.raises(AssertionError, match="a comment"):
        without_comments(text)
