"""The steps of arguments: each is marked, in full or as not checked, and no mark says too much."""

import re
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from verify.papers import check_theorem, lie_derivative_scheme, names
from verify.papers.argument import (
    BALLS,
    NUMBERS,
    ArgumentTexts,
    Check,
    Step,
    _read_argument,
    checks_of,
    steps,
)
from verify.prose import Display, Formula
from verify.verdict import Verdict

ONE, TWO, THREE = (Check(name, True, "0") for name in ("one", "two", "three"))
proof = partial(_read_argument, Verdict.PROVED)
RUN = Check("a run", True, "0", NUMBERS)
BALL = Check("a ball", True, "0", BALLS)
_MARK = re.compile(
    r"(exact algebra|exact numbers|enclosures), rows? [0-9–]+( and [0-9–]+)*|"
    r"Rocq, \w+\.\w+(, \w+\.\w+)*"
)


def marks(text: str, **checks: Any) -> list[tuple[tuple[str, ...], tuple[str, ...]]]:
    made = proof(f"because\n\n{text}", **checks)
    return [(tuple(map(str, s.checked_by)), tuple(map(str, s.tried))) for s in made.steps]


# -- the paper's arguments ------------------------------------------------------------------------


@pytest.mark.parametrize("name", names())
def test_each_step_is_marked_by_rows_of_its_table_by_theorems_or_not_at_all(name: str) -> None:
    argument = check_theorem(name)
    assert argument.steps
    for each in argument.steps:
        assert str(each.text).endswith((".", ")", ":")) or each.text.parts[-1] == "."
        assert all(_MARK.fullmatch(mark) for mark in (*each.checked_by, *each.tried))
    (said,) = argument.checked_by
    checked = sum(1 for each in argument.steps if each.checked_by)
    count = len(argument.steps)
    assert said.startswith(f"by hand: an argument in {count} step")
    told = "all checked" if checked == count else f"{checked or 'none'} checked"
    assert told in said


@pytest.mark.parametrize("name", names())
def test_every_row_of_the_table_is_named_by_a_step(name: str) -> None:
    argument = check_theorem(name)
    named: set[int] = set()
    for each in argument.steps:
        for mark in (*each.checked_by, *each.tried):
            for first, last in re.findall(r"(\d+)(?:–(\d+))?", mark.partition(", row")[2]):
                named |= set(range(int(first), int(last or first) + 1))
    assert named == set(range(1, len(argument.details)))


def test_long_formulas_stand_on_lines_of_their_own() -> None:
    shown = [p for n in names() for s in check_theorem(n).steps for p in s.text.parts]
    assert sum(isinstance(part, Display) for part in shown) > 80
    assert max(len(part) for part in shown if isinstance(part, Formula)) < 34


# -- how marks are made ---------------------------------------------------------------------------


def test_a_step_without_a_check_has_no_mark() -> None:
    assert marks("- a [one]\n- b", one=ONE) == [(("exact algebra, row 1",), ()), ((), ())]


def test_what_was_only_tried_is_no_mark() -> None:
    assert marks("- a [tried run]\n- b [one]", run=RUN, one=ONE) == [
        ((), ("exact numbers, row 1",)),
        (("exact algebra, row 2",), ()),
    ]


def test_a_mark_names_how_and_which_rows_and_theorems() -> None:
    assert marks(
        "- a [one, two]\n- b [one, others, Product.product_near_one]",
        one=ONE,
        two=TWO,
        others=[THREE, RUN, BALL],
    ) == [
        (("exact algebra, rows 1–2",), ()),
        (
            (
                "exact algebra, rows 1 and 3",
                "exact numbers, row 4",
                "enclosures, row 5",
                "Rocq, Product.product_near_one",
            ),
            (),
        ),
    ]


def test_a_check_of_several_steps_is_one_row() -> None:
    read = steps("- a [one]\n- b [two; tried one]\n- c [one]", one=ONE, two=TWO)
    assert checks_of(read) == [ONE, TWO]


def test_steps_of_another_text_stand_where_they_are_named() -> None:
    others = steps("- b [one]\n- c", one=ONE)
    assert steps("- a\n- [others]\n- d [one]", others=others, one=ONE) == [
        Step("a"),
        *others,
        Step("d", (ONE,)),
    ]


def test_a_setting_stands_before_the_steps_and_a_remark_after_them() -> None:
    made = _read_argument(
        Verdict.PROVED, "because\n\nLet it\nbe.\n\n- a [one]\n\nSo it is.", one=ONE
    )
    assert (str(made.given), str(made.remark)) == ("Let it be.", "So it is.")


def test_a_check_that_no_step_names_is_an_error_and_so_is_a_name_without_a_check() -> None:
    with pytest.raises(ValueError, match="no step names two"):
        steps("- a [one]", one=ONE, two=TWO)
    with pytest.raises(KeyError, match="two"):
        steps("- a [one, two]", one=ONE)


def test_a_failed_example_leaves_nothing_of_an_argument() -> None:
    wrong = Check("tried", False, "1", NUMBERS)
    made = _read_argument(
        Verdict.PROVED, "because\n\n- a [one]\n- b [tried wrong]", one=ONE, wrong=wrong
    )
    assert (made.verdict, made.steps, made.checked_by) == (Verdict.UNDECIDED, (), ())


def test_theorems_alone_are_no_argument() -> None:
    """Something of it is computed in each run."""
    assert proof("because\n\n- a [Product.product_near_one]").steps == ()


def test_how_many_steps_a_machine_checked_is_said() -> None:
    def said(text: str) -> str:
        return str(proof(f"because\n\n{text}", one=ONE).checked_by[0])

    assert said("- a [one]") == "by hand: an argument in 1 step, all checked by machine"
    assert said("- a [one]\n- b") == (
        "by hand: an argument in 2 steps, 1 checked by machine, 1 not"
    )
    assert said("- a [tried one]") == (
        "by hand: an argument in 1 step, none checked by machine, 1 not"
    )


# -- texts beside a module ------------------------------------------------------------------------


@pytest.fixture
def texts(tmp_path: Path) -> ArgumentTexts:
    words = """# A paper\n\n## eq_1\n\n{why} and {size}, `e_{k+1}`\n\n- a [one]\n
## why\n\nsince it is\n\n## _lemma\n\n- c [one]\n"""
    (tmp_path / "eq.md").write_text(words, encoding="utf-8")
    return ArgumentTexts(str(tmp_path / "eq.py"))


def test_words_are_read_below_the_name_of_a_function(texts: ArgumentTexts) -> None:
    made = texts.proof("eq_1", one=ONE, size="2")
    assert str(made.evidence) == "since it is and 2, e_{k+1}"
    assert (made.verdict, str(made.steps[0].text)) == (Verdict.PROVED, "a")
    assert texts.refutation("eq_1", one=ONE, size="2").verdict is Verdict.REFUTED
    assert texts.steps("_lemma", one=ONE) == [Step("c", (ONE,))]


def test_a_value_without_a_place_is_an_error_and_so_is_a_name_without_words(
    texts: ArgumentTexts,
) -> None:
    with pytest.raises(ValueError, match="no place for length"):
        texts.proof("eq_1", one=ONE, size="2", length="3")
    with pytest.raises(KeyError, match="eq_3"):
        texts.proof("eq_3")


TEXTS = sorted(Path(lie_derivative_scheme.__file__).parent.rglob("*.md"))


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.stem)
def test_each_text_of_the_paper_is_used(path: Path) -> None:
    """Those of functions by their names, and those that others include in braces."""
    words, code = path.read_text("utf-8"), path.with_suffix(".py").read_text("utf-8")
    names = re.findall(r"^## (\w+)$", words, re.MULTILINE)
    assert names
    for name in names:
        assert f'("{name}"' in re.sub(r"\(\s+", "(", code) or f"{{{name}}}" in words, name
