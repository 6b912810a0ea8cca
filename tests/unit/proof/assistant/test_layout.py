"""The text of an export: in which order it says what, and how it is set."""

import re

import pytest

from tests.helpers.rocq.assumptions import without_comments
from tests.helpers.rocq.exports import ALL, export
from verify.proof.assistant.shipped_theory import files, text_of

_STATED = re.compile(r"^(?:Theorem|Lemma) (\w+)", re.MULTILINE)
_DEFINED = re.compile(
    r"^(?:Theorem|Lemma|Definition|Fixpoint|Record|Inductive) (\w+)", re.MULTILINE
)
_NOTATION = re.compile(r'^\s*(?:Notation|Infix) "[^"]*" := .*?\.$', re.MULTILINE)
# By these a text changes what others mean, and in no module of their own.
_FAR_REACHING = r"\b(?:Notation|Infix|Coercion|Canonical|Global|Export|Open Scope|Arguments|Bind)\b"


def parts(text: str) -> tuple[str, str, str]:
    """What stands before the data, within their module, and what is to be read."""
    before, *rest = re.split(r"^(?:Module Data|End Data)\.\n", text, flags=re.MULTILINE)
    assert len(rest) in (0, 2)
    if not rest:  # kicks and drifts have none
        before, read = text.split("(** * What is proved", 1)
        return before, "", f"(** * What is proved{read}"
    return before, rest[0], rest[1]


@pytest.mark.left_to_ci
@pytest.mark.sample(14)
@pytest.mark.parametrize("name", ALL)
def test_nothing_stands_between_what_is_claimed_and_what_is_assumed(name: str) -> None:
    before, data, read = parts(export(name).text)
    assert not _DEFINED.findall(without_comments(before))
    plain = without_comments(read)
    assert re.findall(_FAR_REACHING, plain) in ([], ["Open Scope"])
    assert not re.search(r"\b(?:Module|Section|Import|Include)\b", plain)
    stated = _STATED.findall(plain)
    assert set(export(name).theorems) <= set(stated)
    assert not {*_DEFINED.findall(data)} & {*export(name).theorems}
    asked = plain[plain.rindex("Qed.") :]
    # Of all of rings together, and of all over the reals; of one alone by its name.
    lists = re.findall(r"^Definition (\w+) := \((.*?)\)\.", asked, re.DOTALL | re.MULTILINE)
    listed = {of_all: re.findall(r"\w+", names) for of_all, names in lists}
    printed = re.findall(r"^Print Assumptions (\w+)\.$", asked, re.MULTILINE)
    assert [x for one in printed for x in listed.get(one, [one])] == stated
    assert len(printed) == 1 + ("Over the real numbers" in read)


@pytest.mark.parametrize("name", ALL)
def test_the_data_stand_in_proofs_alone(name: str) -> None:
    _, data, read = parts(export(name).text)
    assert not re.findall(_FAR_REACHING, without_comments(data))
    # `belongs` does not look at the derivatives that have numbers.
    read = read.replace("named_derivatives := Data.derivatives", "")
    said = re.sub(r"^Proof\..*?\bQed\.$", "", read, flags=re.DOTALL | re.MULTILINE)
    assert "Data." not in without_comments(said)


@pytest.mark.parametrize("name", ALL)
def test_blanks_stand_where_they_are_wanted(name: str) -> None:
    lines = export(name).text.splitlines()
    assert [line for line in lines if line != line.rstrip()] == []
    assert [line for line in lines if "  " in line.strip()] == []
    assert [line for line in lines if re.search(r"\S \)", line)] == []
    assert [line for line in lines if re.search(r"[(\[] ", line) and "(* " not in line] == []


@pytest.mark.parametrize("name", ["duffing_lie2", "every_two_odd", "gauss6", "yoshida4"])
def test_no_blank_ends_a_line_of_what_stands_alone(name: str) -> None:
    lines = export(name, stands_alone=True).text.splitlines()
    assert [line for line in lines if line != line.rstrip()] == []


def test_no_name_stands_in_brackets_of_its_own() -> None:
    for name in ALL:
        *_, read = parts(export(name).text)
        found = re.findall(r"(?:cos|sin|exp|/|by_coordinate \d) \(\w+\)", without_comments(read))
        assert found == [], name
    assert "(/ q) ^ 2" in export("quotient").text
    assert "[p; - H_q]" in export("every_kick").text.replace(";\n   ", ";")


def test_the_theory_gives_no_notation_of_the_library_another_meaning() -> None:
    """Notations are of scopes that are its own, or end with a section."""
    for name in files():
        outside = re.sub(
            r"^Section (\w+)\.$.*?^End \1\.$", "", text_of(name), flags=re.DOTALL | re.MULTILINE
        )
        for notation in _NOTATION.findall(without_comments(outside)):
            assert re.search(r": (?:formula_scope|ring_of_functions)\.$", notation), (
                name,
                notation,
            )
