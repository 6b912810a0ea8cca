"""What a referee asks first is answered from the report's data, and only what it has data for."""

from typing import Any

import pytest

from tests.helpers.constructed.work import ladder, result
from tests.unit.pages.test_page import claim, proof, real, report, scene
from verify.pages.answers import RefereeQuestion, answer_questions, explain
from verify.pages.page import page_view, render
from verify.prose import Formula, read_prose
from verify.scenes.paper_sections import Cause
from verify.scenes.results.claim import statements_of
from verify.scenes.results.report import Report
from verify.studies.work_precision.work_lines import compare_all
from verify.verdict import Verdict

P, R, U = Verdict.PROVED, Verdict.REFUTED, Verdict.UNDECIDED
KEEPS = {"scheme": "symplectic-euler", "area_preserving": True, "order": None, "leading": "0"}


def answered(made: Report) -> dict[str, RefereeQuestion]:
    found = answer_questions(made, page_view(made).claims)
    return {each.question: each for each in found}


def statements(*readings: tuple[str, Verdict, str], **more: Any) -> Report:
    """Each reading: of which statement, its verdict, and the scene it speaks of, "" for every H."""
    claims = tuple(
        claim(id=f"c{k}", source=of, statement_id=of, verdict=verdict, scene=where)
        for k, (of, verdict, where) in enumerate(readings)
    )
    return report((scene(),), claims=claims, statements=statements_of(claims), **more)


def test_the_theory_is_what_is_said_of_every_h() -> None:
    found = answered(statements(("A", P, ""), ("B", R, ""), ("B", P, ""), ("C", R, "mine")))
    (line,) = found["Is the theory right?"].lines
    assert line.sentence == (
        "Of 2 statements on every H, 1 holds as meant and 1 depends on the reading; none is "
        "refuted in every reading."
    )
    assert line.links == ()
    found = answered(statements(("A", P, ""), ("B", R, ""), ("B", R, ""), ("C", R, "mine")))
    (line,) = found["Is the theory right?"].lines
    assert line.sentence == (
        "Of 2 statements on every H, 1 holds as meant and 1 is refuted in every reading. "
        "What needs a repair:"
    )
    assert line.links == (("B", "claim-c1"),)


def test_what_needs_a_repair_is_refuted_undecided_or_explained_by_a_cause() -> None:
    cause = Cause(says=read_prose("So."), explains=("C", "E"))
    report_of_all = statements(
        ("A", P, ""), ("B", U, ""), ("C", R, ""), ("C", P, ""), ("D", R, ""), ("D", P, ""),
        ("E", R, "mine"), causes=(cause,),
    )  # fmt: skip
    (line,) = answered(report_of_all)["Is the theory right?"].lines
    assert line.sentence == (
        "Of 4 statements on every H, 1 holds as meant, 2 depend on the reading and 1 is "
        "undecided. What needs a repair:"
    )
    assert line.links == (("B", "claim-c1"), ("C", "claim-c3")), "D depends, and E is of one H"


@pytest.mark.parametrize(
    ("count", "links", "end"),
    [(12, 12, "12 are refuted in every reading. What needs a repair:"),
     (13, 0, "13 are refuted in every reading.")],
)  # fmt: skip
def test_a_long_list_of_what_needs_a_repair_is_left_out(count: int, links: int, end: str) -> None:
    refuted = tuple((f"S{k}", R, "") for k in range(count))
    asked = answered(statements(("A", P, ""), *refuted, ("Z", P, "mine")))
    (line,) = asked["Is the theory right?"].lines
    assert len(line.links) == links
    assert line.sentence.endswith(f"1 holds as meant and {end}")


def test_a_cause_has_a_link_to_each_statement_that_it_explains() -> None:
    cause = Cause(says=read_prose("It is `1/N`."), explains=("B", "C"))
    report_of_all = statements(
        ("A", P, ""), ("B", R, ""), ("C", R, "mine"), ("C", R, "mine"), causes=(cause,)
    )
    lines = explain(report_of_all.causes, page_view(report_of_all).claims)
    assert [(line.sentence, line.links) for line in lines] == [
        ("It is 1/N.", (("B", "claim-c1"), ("C", "claim-c2"))),
    ]


def test_after_a_cause_stand_whom_it_disfavours_and_its_origin() -> None:
    cause = Cause(
        says=read_prose("It is `1/N`."), explains=("A",), disfavours=read_prose("By `h^2`."),
        origin=read_prose("A slip."),
    )  # fmt: skip
    (line,) = explain((cause,), page_view(statements(("A", R, ""))).claims)
    assert line.sentence == "It is 1/N. By h^2. A slip."
    assert [part for part in line.sentence.parts if type(part) is Formula] == ["1/N", "h^2"]


TWO_SYSTEMS = (
    scene(proofs=(proof(), proof(**KEEPS))),
    scene(name="other", title="Other", proofs=(proof(**KEEPS | {"scheme": "lie2"}),)),
)


def test_a_scheme_preserves_area_only_where_every_proof_says_so() -> None:
    of_both = statements(("A", P, ""), ("B", P, "mine"), ("C", P, "other"))
    made = of_both.model_copy(update={"scenes": TWO_SYSTEMS})
    lie2, euler = answered(made)["Is area preserved?"].lines
    assert lie2.sentence == (
        "lie2: no; ΔJ = (3*a*p*q)*h**3 + O(h**4) (My oscillator); det J ≡ 1 (Other)"
    )
    assert euler.sentence == "symplectic-euler: yes, det J ≡ 1 is proved"


def test_of_a_paper_only_the_systems_are_asked_that_a_statement_names() -> None:
    """The others stand below, with their proofs; ours is no statement."""
    claims = (
        claim(id="a", statement_id="A", scene=""), claim(id="b", statement_id="B", scene="other"),
        claim(id="ours", standing="ours", scene="mine"),
    )  # fmt: skip
    made = report(TWO_SYSTEMS, claims=claims, statements=statements_of(claims))
    assert answered(made)["Is area preserved?"].lines == (("lie2: yes, det J ≡ 1 is proved", ()),)
    without = made.model_copy(update={"statements": ()})
    (lie2, euler) = answered(without)["Is area preserved?"].lines
    assert "(My oscillator); det J ≡ 1 (Other)" in lie2.sentence
    assert euler.sentence == "symplectic-euler: yes, det J ≡ 1 is proved"


def test_equal_cost_is_told_of_scenes_and_not_of_a_paper_that_does_not_ask_for_it() -> None:
    lines = ladder("lie2"), ladder("euler")
    costly = scene(work_precision=result(*lines, comparisons=compare_all(lines, "1")))
    asked = answered(report((costly,)))
    (line,) = asked["Which scheme at equal cost?"].lines
    assert line.sentence.startswith("My oscillator: ")
    of_a_paper = statements(("A", P, ""), ("B", P, "mine"))
    questions = answered(of_a_paper.model_copy(update={"scenes": (costly,)}))
    assert list(questions) == ["Is the theory right?", "Is area preserved?"]


def test_of_a_long_leading_term_its_order_is_told() -> None:
    """The page would be wider than any window; the proof itself shows it whole."""
    long = " + ".join(f"{k}*a*p*q**{k}" for k in range(2, 30))
    found = answered(report((scene(proofs=(proof(leading=long),)),)))
    assert found["Is area preserved?"].lines == (("lie2: no; ΔJ = O(h**3), no smaller", ()),)


def test_what_is_not_decided_is_no_no() -> None:
    open_ = proof(order=None, area_preserving=None, verdict=Verdict.UNDECIDED)
    made = statements(("A", P, ""), ("B", P, "mine"))
    made = made.model_copy(update={"scenes": (scene(proofs=(open_,)),)})
    assert answered(made)["Is area preserved?"].lines == (("lie2: not decided", ()),)


def test_a_refuted_table_is_linked() -> None:
    tables = answered(real())["Do the printed tables stand?"]
    assert tables.lines
    (line,) = tables.lines
    assert line.sentence == (
        "The printed row is lg(1/N) = lg(h/T) to all its digits; none of the 2 printed values is "
        "the lg MSE from any of the 2 initial values:"
    )
    assert [name for name, _ in line.links] == ["Table 9"]
    assert 'class="answers"' in render(real())


def test_of_a_few_proofs_alone_the_formula_is_told_and_of_many_the_page_below_says_more() -> None:
    few, many = (report(tuple(scene(proofs=(proof(),)) for _ in range(n))) for n in (1, 4))
    (only,) = answer_questions(few, ())
    assert only.question == "Is area preserved?"
    assert not answer_questions(many, ())
    assert 'class="answers"' not in render(many)
    assert not answer_questions(report((scene(proofs=()),)), ()), "no proof, no question"
