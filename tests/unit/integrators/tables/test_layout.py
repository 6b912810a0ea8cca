"""Tableaux as they are pasted: what is a rule, which rows are empty, and blanks of every kind."""

import pytest

from verify.integrators.tables.entry import parse_tableau, plain

BLANKS = "\u00a0\u2009\u202f\u2002\u2003 "


def test_a_row_without_times_and_numbers_is_a_stage_and_no_rule() -> None:
    """The first of an explicit method."""
    found = parse_tableau("|\n| 1/2\n---+---\n| 0 1")
    assert (found.a, found.c) == (((), ("1/2",)), None)
    assert (found.b, found.embedded) == (("0", "1"), None)


@pytest.mark.parametrize("rule", ["---+---", "  --  ", "====", "|────|", "—— : ——", "__"])
def test_a_rule_is_a_line_of_nothing_else(rule: str) -> None:
    found = parse_tableau(f"0 |\n1/2 | 1--1/2\n{rule}\n| 0 1")
    assert (found.a, found.c) == (((), ("1--1/2",)), ("0", "1/2"))
    assert (found.b, found.embedded) == (("0", "1"), None)


@pytest.mark.parametrize("blank", BLANKS)
def test_digits_may_be_grouped_by_a_blank_of_any_kind(blank: str) -> None:
    assert plain(f"0.123{blank}456{blank}789") == "0.123456789"
