"""Notes of a run: one more makes others, whatever becomes of those before; numbers made once."""

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.kernels.notes import LazyNote, Notes


@drawn(60)
@given(st.lists(st.tuples(st.integers(0, 20), st.integers()), max_size=30))
def test_notes_stay_what_they_were_wherever_one_is_added(adds: list[tuple[int, int]]) -> None:
    """Also to notes that others were made of before, as after an interruption."""
    made: list[tuple[Notes[int], tuple[int, ...]]] = [(Notes(), ())]
    for at, item in adds:
        notes, expected = made[at % len(made)]
        made.append((notes.and_then(item), (*expected, item)))
    for notes, expected in made:
        assert (tuple(notes), len(notes)) == (expected, len(expected))
        assert notes[:2] == list(expected[:2])
        for k in range(-len(expected), len(expected)):
            assert notes[k] == expected[k]


def test_of_no_notes_there_is_no_last() -> None:
    with pytest.raises(IndexError):
        Notes[int]()[-1]
    with pytest.raises(IndexError):
        Notes([1])[1]


def test_what_others_have_added_is_no_note_of_ones_own() -> None:
    none, first = Notes[int](), Notes([1])
    none.and_then(2)
    first.and_then(2)
    for notes, index in ((none, -1), (none, 0), (first, 1), (first, -2)):
        with pytest.raises(IndexError):
            notes[index]
    assert first[-1] == 1


def test_a_number_is_made_where_it_is_looked_at_and_once() -> None:
    seen: list[str] = []

    def make(name: str, state: Any, done: int) -> Fraction:
        seen.append(name)
        return Fraction(state[0] + done)

    note = LazyNote(("p", "q"), make, (3,), 4)
    assert (list(note), len(note), seen) == (["p", "q"], 2, [])
    assert note["q"] == note["q"] == 7
    assert seen == ["q"]
    with pytest.raises(KeyError):
        note["other"]
    assert dict(note) == {"p": 7, "q": 7}
