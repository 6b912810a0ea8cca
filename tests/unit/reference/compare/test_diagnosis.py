"""A mistake is named where it fits, and where the right reading is off by many times more."""

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from verify.reference.compare import diagnosis
from verify.reference.compare.diagnosis import Diagnosis
from verify.reference.compare.table_agreement import (
    DOUBLE,
    ColumnFindings,
    ColumnVerdict,
    Fit,
    RunFindings,
)

PLACE = (7, "lambda")
UNIT = DOUBLE
THEIRS = Fraction(3, 1000)
ROUNDED = UNIT * THEIRS  # as near as two numbers of that size are told apart


def judged(right: Fraction, other: Fraction, *, fits: bool = True) -> list[str]:
    """The names that are said of a column that is off by `right` in the right reading, and by
    `other` in the first of the others; the rest of them do not fit."""
    wrong = Fit({"lambda": ColumnVerdict.MORE})
    wrong.parts, wrong.distances = {"lambda": PLACE[0]}, {PLACE: right}
    near = Fit({"lambda": ColumnVerdict.AGREES if fits else ColumnVerdict.MORE})
    near.distances = {PLACE: other}
    asked: list[Any] = []

    def fit(_: Any, __: Any, ___: Any, read: Any = None, *, wholly: bool = True) -> Fit:
        if read is None:
            return wrong
        asked.append(read)
        return near if len(asked) == 1 else wrong

    judge = SimpleNamespace(
        fit=fit, digits=lambda _: 17, cells={PLACE: SimpleNamespace(submitted=THEIRS)},
        names=["lambda"], right_setting=None, state=[],
    )  # fmt: skip
    findings = RunFindings(
        "a run", {"lambda": ColumnFindings(ColumnVerdict.MORE, 3, 2.0, 7, 7)}, unit=UNIT
    )
    named = Diagnosis(judge, findings)._explain_column(None, "lambda")  # type: ignore[arg-type]
    return [name for name, _ in named]


@pytest.mark.parametrize("times", [2, 10, 29])
@pytest.mark.parametrize("other", [ROUNDED, 5 * ROUNDED, 1000 * ROUNDED, ROUNDED / 100])
def test_a_reading_that_is_not_much_nearer_is_not_named(times: int, other: Fraction) -> None:
    """Nearer than rounding does not count: no number tells that."""
    assert judged(times * max(other, ROUNDED), other) == []


@pytest.mark.parametrize("times", [30, 31, 1000])
@pytest.mark.parametrize("other", [ROUNDED, 5 * ROUNDED, 1000 * ROUNDED, ROUNDED / 100])
def test_a_reading_that_fits_and_is_much_nearer_is_named(times: int, other: Fraction) -> None:
    assert judged(times * max(other, ROUNDED), other) == ["lambda+1"]
    assert judged(times * max(other, ROUNDED), other, fits=False) == []


@pytest.mark.parametrize("times", [2, 29, 30, 1000])
def test_a_mistake_of_the_state_is_told_by_the_same_rule(
    times: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    right, other = Fit({"lambda": ColumnVerdict.MORE}), Fit({"lambda": ColumnVerdict.AGREES})
    right.parts, right.distances = {"lambda": PLACE[0]}, {PLACE: times * ROUNDED}
    other.distances = {PLACE: ROUNDED}
    late = SimpleNamespace(name="late", says="a step late", setting="late", synonyms=())
    judge = SimpleNamespace(
        fit=lambda setting, *_, **__: other if setting == "late" else right,
        units=lambda: [UNIT], right_setting="right",
        cells={PLACE: SimpleNamespace(submitted=THEIRS)},
        numbers=lambda *_: {},
    )  # fmt: skip
    for where in ("input_mistakes", "state_mistakes"):
        mistakes = [late] if where == "state_mistakes" else []
        monkeypatch.setattr(diagnosis, where, lambda _, mistakes=mistakes: mistakes)
    found = list(Diagnosis(judge, RunFindings("a run"))._fitting_mistakes(["lambda"]))  # type: ignore[arg-type]
    assert found == ([late] if times >= 30 else [])


def test_the_place_of_a_fit_is_the_first_at_which_rounding_does_not_usually_explain_it() -> None:
    fit = Fit(dict.fromkeys(("p", "q", "mse"), ColumnVerdict.AGREES))
    assert fit.place is None
    for step, name, verdict in [
        (1, "mse", ColumnVerdict.ROUNDING), (3, "q", ColumnVerdict.PERHAPS),
        (5, "p", ColumnVerdict.MORE), (7, "q", ColumnVerdict.MORE), (9, "q", ColumnVerdict.AGREES),
    ]:  # fmt: skip
        fit.take(step, name, verdict)
    assert (fit.place, fit.parts) == ((3, "q"), {"q": 3, "p": 5})
    assert fit.verdicts == {
        "p": ColumnVerdict.MORE,
        "q": ColumnVerdict.MORE,
        "mse": ColumnVerdict.ROUNDING,
    }
    assert not fit.fits
