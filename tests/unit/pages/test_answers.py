"""What a referee asks first is answered from the report's data, and only what it has data for."""

from typing import Any

from tests.unit.pages.test_page import claim, proof, real, report, scene
from verify.pages.answers import RefereeQuestion, answer_questions
from verify.pages.page import page_view, render
from verify.prose import read_prose
from verify.scenes.paper_sections import Cause
from verify.scenes.results.claim import statements_of
from verify.scenes.results.report import Report
from verify.verdict import Verdict

P, R = Verdict.PROVED, Verdict.REFUTED
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
        "Of 2 statements on every H, 1 holds as meant, 1 holds in some readings and none is "
        "refuted in every reading."
    )
    found = answered(statements(("A", P, ""), ("B", R, ""), ("B", R, "")))
    (line,) = found["Is the theory right?"].lines
    assert line.sentence == (
        "Of 2 statements on every H, 1 holds as meant and 1 is refuted in every reading:"
    )
    assert line.links == (("B", "claim-c1"),)


def test_what_explains_several_statements_stands_first_with_a_link_to_each() -> None:
    cause = Cause(says=read_prose("It is `1/N`."), explains=("B", "C"))
    made = statements(
        ("A", P, ""), ("B", R, ""), ("C", R, "mine"), ("C", R, "mine"), causes=(cause,)
    )
    question, *_ = answered(made).values()
    assert question.question == "What is wrong, and why?"
    assert [(line.sentence, line.links) for line in question.lines] == [
        ("It is 1/N.", (("B", "claim-c1"), ("C", "claim-c2"))),
    ]
    assert "What is wrong, and why?" in render(made)


def test_a_scheme_preserves_area_only_where_every_proof_says_so() -> None:
    made = report(
        (
            scene(proofs=(proof(), proof(**KEEPS))),
            scene(name="other", title="Other", proofs=(proof(**KEEPS | {"scheme": "lie2"}),)),
        ),
        claims=(claim(statement_id="A", scene=""),),
        statements=statements_of((claim(statement_id="A", scene=""),)),
    )
    lie2, euler = answered(made)["Is area preserved?"].lines
    assert lie2.sentence == (
        "lie2: no; ΔJ = (3*a*p*q)*h**3 + O(h**4) (My oscillator); det J ≡ 1 (Other)"
    )
    assert euler.sentence == "symplectic-euler: yes, det J ≡ 1 is proved"


def test_of_a_long_leading_term_its_order_is_told() -> None:
    """The page would be wider than any window; the proof itself shows it whole."""
    long = " + ".join(f"{k}*a*p*q**{k}" for k in range(2, 30))
    found = answered(report((scene(proofs=(proof(leading=long),)),)))
    assert found["Is area preserved?"].lines == (("lie2: no; ΔJ = O(h**3), no smaller", ()),)


def test_what_is_not_decided_is_no_no() -> None:
    open_ = proof(order=None, area_preserving=None, verdict=Verdict.UNDECIDED)
    made = statements(("A", P, ""))
    made = made.model_copy(update={"scenes": (scene(proofs=(open_,)),)})
    assert answered(made)["Is area preserved?"].lines == (("lie2: not decided", ()),)


def test_a_refuted_table_is_linked() -> None:
    tables = answered(real())["Do the printed tables stand?"]
    assert tables.lines
    (line,) = tables.lines
    assert (
        line.sentence
        == "None of the 2 printed values is the lg MSE from any of the 2 initial values:"
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
