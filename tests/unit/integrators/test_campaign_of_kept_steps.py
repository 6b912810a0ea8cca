"""The campaign of steps and what they keep: its truths are the textbooks', what is wrong is seen.

A few of its steps are judged here.
"""

from dataclasses import replace

import pytest
import sympy

from tests.campaigns.kept_steps import Judged, judged
from tests.helpers.sampled.kept_steps import SYSTEMS, DrawnStep, Structure, drawn_step
from verify.integrators.kept_structures import leave_open
from verify.structures import SYMPLECTIC
from verify.structures.reading import ClaimedStructure
from verify.verdict import Verdict


def step_of(system: str, method: str, mistake: str = "", size: float = 1e-3) -> DrawnStep:
    here = SYSTEMS[system]
    return DrawnStep(here, method, mistake, size, (1.0,) * len(here.names), 1.0, "floats")


def orders(step: DrawnStep) -> dict[str, int | None]:
    return {x.name or str(x.kept.formulas[0]): step.order(x.kept) for x in step.system.structures}


def test_what_is_true_is_the_textbook_s() -> None:
    verlet = orders(step_of("pendulum", "verlet"))
    assert verlet == {
        "symplectic": None, "volume": None, "energy": 3, "reversible": None, "symmetric": None,
    }  # fmt: skip
    assert orders(step_of("pendulum", "uneven"))["symmetric"] == 2
    assert orders(step_of("pendulum", "rk4"))["symplectic"] == 6
    assert orders(step_of("kepler", "symplectic-euler"))["angular-momentum"] is None
    assert orders(step_of("damped", "damped"))["conformal"] is None
    assert orders(step_of("lotka", "lotka"))["symplectic"] is None
    body = orders(step_of("body", "body"))
    assert body.pop("reversible") is None
    assert set(body.values()) == {None}
    assert orders(step_of("masses", "ruth3"))["symplectic"] is None


@pytest.mark.parametrize(
    ("mistake", "order"),
    [("friction", 1), ("push", None), ("twist", 1), ("late", 3), ("raw push", None)],
)
def test_a_planted_error_has_its_order(mistake: str, order: int | None) -> None:
    assert orders(step_of("duffing", "verlet", mistake, 1e-9))["symplectic"] == order


def test_texts_are_those_of_the_step_in_its_units() -> None:
    step = replace(step_of("masses", "verlet"), units=(2.0**9, 2.0**9, 2.0**-7, 2.0**-7), time=8.0)
    assert step.formula(sympy.Symbol("v1")) == sympy.Symbol("v1") / 512
    name, more = step.request(step.system.structures[0])
    assert (name, more["form"]) == ("symplectic", "(1/4)*dv1^dx1 + (3/4)*dv2^dx2")
    assert step.system_text.endswith("x1_dot = v1/524288; x2_dot = v2/524288")
    moved = step.function([512.0, 0.0, 0.0, 0.0], 8.0 / 1024)
    assert moved[2] == pytest.approx(2.0**-7 / 1024, rel=1e-6)


def test_what_is_wrong_is_called_wrong() -> None:
    def outcome(step: DrawnStep, structure: Structure, claimed: int | None, verdict: str) -> str:
        kept = leave_open(ClaimedStructure(SYMPLECTIC, claimed), "")
        order = step.order(structure.kept)
        return Judged(
            step, structure, claimed, order, replace(kept, verdict=Verdict(verdict))
        ).outcome

    errors = (("", 0.0), ("friction", 1e-4), ("friction", 1e-15))
    right, wrong, hidden = (step_of("duffing", "verlet", *x) for x in errors)
    area, _, energy, *_ = right.system.structures
    for step, structure, claimed, said in (
        (right, area, None, ("decided", "wrong", "undecided")),
        (right, energy, 4, ("wrong", "decided", "undecided")),
        (right, energy, 3, ("decided", "wrong", "undecided")),
        (wrong, area, None, ("wrong", "decided", "undecided")),
        (wrong, energy, 3, ("wrong", "decided", "undecided")),
        (hidden, area, None, ("in the noise", "decided", "in the noise")),
    ):
        verdicts = ("MEASURED", "REFUTED", "UNDECIDED")
        assert tuple(outcome(step, structure, claimed, x) for x in verdicts) == said
    assert outcome(hidden, area, None, "PROVED") == "wrong"


def test_a_seed_draws_the_same_steps_again() -> None:
    assert drawn_step(3, 1)[0].system_text == drawn_step(3, 1)[0].system_text
    assert drawn_step(3, 1)[0] != drawn_step(3, 10)[0]


@pytest.mark.parametrize("number", [7, 8, 10, 28])
def test_a_sample_of_steps_is_not_judged_wrong(number: int) -> None:
    assert {x.outcome for x in judged(1, number)} <= {"decided", "in the noise"}
