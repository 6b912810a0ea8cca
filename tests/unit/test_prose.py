"""What results say: its parts, its plain text, and what is read back from JSON."""

import copy

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from verify.prose import Formula, Number, Prose, join_prose, prose, read_prose
from verify.scenes.frozen import ProseText, WithProse

PARTS = st.lists(st.one_of(st.text(), st.builds(Formula, st.text()), st.builds(Number, st.text())))


class Result(WithProse):
    reason: ProseText
    checked: tuple[ProseText, ...] = ()


@given(PARTS)
def test_a_prose_is_its_plain_text_and_its_data_give_it_back(parts):
    made = prose(*parts)
    assert made == "".join(parts)
    for back in (Prose.from_data(made.as_data()), copy.deepcopy(made), copy.copy(made)):
        assert back == made
        assert back.parts == made.parts
        assert [type(p) for p in back.parts] == [type(p) for p in made.parts]


def test_texts_side_by_side_are_one_and_a_prose_gives_its_parts():
    inner = prose("b", Formula("h^3"))
    found = "a" + inner + "c" + "d"
    assert found.parts == ("ab", "h^3", "cd")
    assert join_prose("; ", [inner, "x"]).parts == ("b", "h^3", "; x")
    assert join_prose("; ", []) == ""


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("of order `h^3`.", ("of order ", "h^3", ".")),
        ("`h`", ("h",)),
        ("one ` alone", ("one ` alone",)),
        ("`a` and ` alone", ("a", " and ` alone")),
        ("", ()),
    ],
)
def test_people_quote_formulas(text, parts):
    assert read_prose(text).parts == parts


@given(PARTS, st.lists(PARTS))
def test_a_model_keeps_plain_text_and_parts_beside_it(reason, checked):
    made = Result(reason=prose(*reason), checked=tuple(prose(*each) for each in checked))
    back = Result.model_validate_json(made.model_dump_json())
    assert back == made
    assert back.reason.parts == made.reason.parts
    assert [c.parts for c in back.checked] == [c.parts for c in made.checked]


@pytest.mark.parametrize(
    "data",
    [
        {"reason": "u", "reason_parts": ["v"]},
        {"reason": "u", "reason_parts": [{"formula": "v"}]},
        {"reason": "u", "reason_parts": [{"script": "u"}]},
        {"reason": "u", "reason_parts": [{"formula": 1}]},
        {"reason": "u", "reason_parts": [["u"]]},
        {"reason": "u", "reason_parts": 1},
        {"reason": 1},
        {"reason": "u", "checked": ["a"], "checked_parts": []},
    ],
)
def test_parts_that_are_not_those_of_the_text_are_refused(data):
    with pytest.raises(ValidationError):
        Result.model_validate(data)


def test_a_text_without_parts_is_read():
    assert Result.model_validate({"reason": "u"}).reason.parts == ("u",)


def test_parts_stand_in_data_where_they_say_more_than_the_text():
    made = Result(reason=prose("of order ", Formula("h^3")), checked=(prose("a"), prose("b")))
    assert made.model_dump() == {
        "reason": "of order h^3",
        "reason_parts": ["of order ", {"formula": "h^3"}],
        "checked": ("a", "b"),
    }
