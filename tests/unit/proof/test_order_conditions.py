"""What a proof makes of conditions on coefficients, whatever scheme they are of."""

from dataclasses import dataclass

import pytest

from verify.proof import order_for_every_h
from verify.proof.order_conditions import prove_by_conditions
from verify.proof.order_for_every_h import prove_for_every_h
from verify.schemes.conditions.condition import Condition
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict


@dataclass(frozen=True)
class Made:
    """Three conditions, one for each order; `wrong` says of some that they fail, or are open."""

    wrong: dict[int, bool | None]
    separable: bool = False
    most_order: int = 10

    def order_conditions(self, order: int) -> tuple[Condition, ...]:
        assert order <= self.most_order
        return tuple(self.condition(n) for n in range(1, min(order, 3) + 1))

    def area_conditions(self) -> tuple[Condition, ...]:
        return (self.condition(0),)

    def condition(self, n: int) -> Condition:
        holds = self.wrong.get(n, True)
        return Condition(f"c{n} = 0", n, "0" if holds else "1.2e-11", holds)


def made(wrong: dict[int, bool | None], order: int, separable: bool = False) -> Scheme:
    return Scheme(
        name="made", order=order, area_preserving=True, explicit=False, symmetric=False,
        source="this test", build=lambda _: None, every_h=Made(wrong, separable),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("wrong", "order", "verdict", "agreed", "preserves"),
    [
        ({3: False}, 2, Verdict.PROVED, 2, True),
        ({3: None}, 2, Verdict.PROVED, 2, True),
        ({2: False}, 2, Verdict.REFUTED, 1, True),
        ({2: None}, 2, Verdict.UNDECIDED, 1, True),
        ({2: None, 3: False}, 3, Verdict.REFUTED, 1, True),
        ({1: False, 2: None}, 2, Verdict.REFUTED, 0, True),
        ({0: False, 3: False}, 2, Verdict.UNDECIDED, 2, None),
        ({0: None, 3: False}, 2, Verdict.UNDECIDED, 2, None),
        ({0: False, 2: False}, 2, Verdict.REFUTED, 1, None),
    ],
)
def test_the_verdict_follows_from_the_conditions(
    wrong: dict[int, bool | None], order: int, verdict: Verdict, agreed: int, preserves: bool | None
) -> None:
    scheme = made(wrong, order)
    proof = prove_by_conditions(scheme, scheme.every_h)
    assert (proof.verdict, proof.convergence_order) == (verdict, agreed)
    assert (proof.area_preserving, proof.order) == (preserves, None)
    assert [c.order for c in proof.conditions] == [*range(1, order + 1), 0]
    if verdict is Verdict.REFUTED:
        assert "(residue 1.2e-11)" in proof.reason


def test_no_conditions_on_area_say_nothing_of_area(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Made, "area_conditions", lambda _: ())
    scheme = made({3: False}, 2)
    assert prove_by_conditions(scheme, scheme.every_h).area_preserving is None


def test_what_fails_for_some_h_may_hold_for_every_separable_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(order_for_every_h, "get", lambda _: made({2: False}, 2))
    assert prove_for_every_h("made").verdict is Verdict.REFUTED
    assert prove_for_every_h("made", separable=True).verdict is Verdict.UNDECIDED
    monkeypatch.setattr(order_for_every_h, "get", lambda _: made({3: False}, 2))
    assert prove_for_every_h("made", separable=True).separable is True
    monkeypatch.setattr(order_for_every_h, "get", lambda _: made({2: False}, 2, separable=True))
    assert prove_for_every_h("made", separable=True).verdict is Verdict.REFUTED


@pytest.mark.parametrize("claimed", [2, 3])
def test_no_condition_is_asked_for_beyond_those_that_are_known(claimed: int) -> None:
    scheme = made({}, claimed)
    proof = prove_by_conditions(scheme, Made({}, most_order=3))
    assert (proof.verdict, proof.convergence_order) == (Verdict.PROVED, 3)
    wrong = prove_by_conditions(scheme, Made({2: False}, most_order=3))
    assert (wrong.verdict, wrong.convergence_order) == (Verdict.REFUTED, 1)
