"""What is wrong stands first, by library, where refuted claims have a severity."""

from tests.unit.pages.test_page import claim, report
from verify.pages.answers import find_mistakes
from verify.pages.page import page_view, render
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict


def judged(id_: str, section: str, source: str, severity: str = "") -> ClaimResult:
    verdict = Verdict.REFUTED if severity else Verdict.PROVED
    return claim(id=id_, section=section, source=source, verdict=verdict, severity=severity)


GIVEN = (
    judged("a/1", "alpha 1.0", "RK4"),
    judged("b/1", "beta 2.0, printed tables", "Verlet", "wrong clock"),
    judged("b/2", "beta 2.0, printed tables", "Verlet", "wrong order"),
    judged("b/3", "beta 2.0, printed tables", "Ruth", "wrong order"),
    judged("c/1", "gamma 3.0", "Yoshida", "digits below that"),
)


def test_it_is_told_by_library_and_kind_and_digits_are_counted_alone() -> None:
    found = find_mistakes(page_view(report(claims=GIVEN)).claims)
    assert found is not None
    (beta,) = found.libraries
    assert beta.name == "beta 2.0"
    told = [(m.severity, [c.result.source for c in m.claims], m.more_count) for m in beta.mistakes]
    assert told == [("wrong clock", ["Verlet"], 0), ("wrong order", ["Verlet", "Ruth"], 0)]
    assert found.digits == (("gamma 3.0", 1),)
    assert found.faultless == ("alpha 1.0",)


def test_of_many_methods_some_are_named_and_each_once() -> None:
    many = tuple(judged(f"x/{k}", "x 1", f"m{k % 9}", "wrong order") for k in range(12))
    found = find_mistakes(page_view(report(claims=many)).claims)
    assert found is not None
    (mistake,) = found.libraries[0].mistakes
    assert [c.result.source for c in mistake.claims] == [f"m{k}" for k in range(6)]
    assert mistake.more_count == 3


def test_without_severities_there_is_no_such_table() -> None:
    plain = (claim(verdict=Verdict.REFUTED), claim(id="b"))
    assert find_mistakes(page_view(report(claims=plain)).claims) is None
    assert 'id="wrong"' not in render(report(claims=plain))
    assert 'id="telling"' in render(report(claims=plain))


def test_it_stands_before_the_claims_with_links_to_them() -> None:
    page = render(report(claims=GIVEN))
    assert page.index('id="wrong"') < page.index('class="claim')
    assert 'id="telling"' not in page
    assert page.count('data-severity="wrong order"') == 2
    digits = render(report(claims=GIVEN[-1:]))
    assert "Nothing but the last digits of tables." in digits
