"""The campaigns of steps in drawn units and of implicit ones: what they hold to be true is, and
what they call wrong is wrong. A few of their cases are asked here."""

import random
from pathlib import Path

import pytest

from tests.campaigns.implicit_steps import Judged as JudgedImplicit
from tests.campaigns.implicit_steps import delta_by_mpmath, delta_in_floats
from tests.campaigns.stepping.asked import Answer, asked
from tests.campaigns.stepping.implicit import Implicit, source_of
from tests.campaigns.stepping.methods import METHODS, MISTAKES, Parts
from tests.campaigns.stepping.programs import Case, spoilt_one
from tests.campaigns.stepping.programs import source_of as program_of
from tests.campaigns.stepping.systems import SYSTEMS, InUnits, in_units
from tests.campaigns.stepping.truth import Truth, truth_of
from tests.campaigns.steps_in_units import Judged, case_of, judged


def units(name: str, seed: int = 1) -> InUnits:
    return in_units(SYSTEMS[name], random.Random(seed))  # noqa: S311


def truth(name: str, method: str, *changes: tuple[str, str]) -> Truth:
    """Of the method for that H, with something in its program changed."""
    here, how = units(name), METHODS[method]
    parts = Parts(how.lines, how.names, here.constants, here.system.velocity)
    source = program_of(here, parts)
    for old, new in changes:
        assert old in source
        source = source.replace(old, new, 1)
    return truth_of(here, source)


@pytest.mark.parametrize("method", METHODS)
def test_a_method_is_of_its_order_and_symplectic_or_not(method: str) -> None:
    here = truth("driven-pendulum", method)
    assert (here.order, here.symplectic) == (METHODS[method].order, METHODS[method].symplectic)


@pytest.mark.parametrize("name", SYSTEMS)
def test_force_and_velocity_are_those_of_h(name: str) -> None:
    here = truth(name, "kick-drift-kick")
    assert here.order >= 2
    assert here.symplectic
    old = SYSTEMS[name].force[-1]
    assert truth(name, "kick-drift-kick", (old, f"1.001*({old})")).order == 0


def test_mistakes_by_hand_have_the_order_that_theory_says() -> None:
    kick = "p = plus(p, 1/2*h, force(q))\n    return"
    stale = truth("duffing", "kick-drift-kick", (kick, kick.replace("force(q)", "old")),
                  ("    p = plus", "    old = force(q)\n    p = plus"))  # fmt: skip
    assert (stale.order, stale.symplectic) == (1, False)
    clock = truth("driven-pendulum", "kick-drift-kick", ("t + (0 + 1)*h", "t"))
    assert (clock.order, clock.symplectic) == (1, True)


def test_rounded_coefficients_hide_no_order_at_tiny_steps() -> None:
    case = case_of(134, 100)
    assert (case.method.name, case.truth.order) == ("forest-ruth", 4)


@pytest.mark.parametrize("kind", MISTAKES)
def test_a_planted_mistake_breaks_what_is_claimed(kind: str) -> None:
    case = spoilt_one("x", random.Random(3), kind)  # noqa: S311
    lost = case.method.symplectic and not case.truth.symplectic
    assert lost or case.truth.order < case.method.order


def answer(verdict: str, status: int, **said: object) -> Answer:
    return Answer(status, 0.0, "", {"verdict": verdict, **said})


def test_what_is_wrong_is_called_wrong() -> None:
    right = case_of(0, 1, 0)
    spoilt = Case("x", right.units, right.method, "sign", "", Truth(0, 1.0))
    for case, wrong, decided in (
        (right, ("REFUTED", 1), ("MEASURED", 0)), (spoilt, ("PROVED", 0), ("REFUTED", 1)),
    ):  # fmt: skip
        assert Judged(case, answer(*wrong), "").outcome == "wrong"
        assert Judged(case, answer(*decided), "").outcome == "decided"
        assert Judged(case, answer("UNDECIDED", 1), "").outcome == "undecided"
        assert Judged(case, Answer(2, 0.0, "bad input"), "").outcome == "error"
    order = answer("MEASURED", 0, convergence_order=7, convergence_order_known=True)
    assert Judged(right, order, "").wrong_order


@pytest.mark.left_to_ci
@pytest.mark.parametrize("index", [14, 17, 19])
def test_a_sample_of_steps_is_not_answered_wrongly(index: int, tmp_path: Path) -> None:
    result = judged(case_of(index, 1, 0), tmp_path, ["--time-limit", "10"])
    assert result.outcome in ("decided", "undecided"), str(result)


def test_delta_j_of_a_loop_is_that_of_its_own_operations() -> None:
    """−8.9e-11 and 2.59e-10 were computed elsewhere, for this loop and place."""
    step, place = Implicit("midpoint", "fixed-point", 8, "pendulum"), {"p": "3/4", "q": "-2/5"}
    delta = delta_by_mpmath(step, {**place, "h": "1/4"})
    assert delta == pytest.approx(2.59e-10, rel=0.01)
    assert delta_by_mpmath(step, {**place, "h": "1/10"}) == pytest.approx(-8.9e-11, rel=0.01)
    tight = Implicit("midpoint", "newton", 14, "pendulum")
    assert abs(delta_by_mpmath(tight, place) or 0) < 1e-20
    exact = Implicit("symplectic-euler", "newton", 14, "quartic")
    assert delta_by_mpmath(exact, place) == 0


def test_differences_in_floats_see_what_mpmath_does_where_they_agree() -> None:
    loose = Implicit("midpoint", "newton", 1, "product")
    place = {"p": "1/7", "q": "6/5", "h": "1/2"}
    by_floats, by_mpmath = delta_in_floats(loose, place), delta_by_mpmath(loose, place)
    assert by_mpmath
    assert by_floats == pytest.approx(by_mpmath, rel=0.1)


@pytest.mark.parametrize(
    ("delta", "said", "outcome"),
    [
        (1e-9, answer("REFUTED", 1, delta_j_max="1.5e-9", probe_error="1e-12"), "refuted"),
        (1e-9, answer("REFUTED", 1, delta_j_max="3e-9", probe_error="1e-12"), "size"),
        (1e-9, answer("MEASURED", 0, delta_j_max="1e-9", probe_error="1e-12"), "missed"),
        (1e-9, answer("UNDECIDED", 1, delta_j_max="1e-9", probe_error="1e-12"), "missed"),
        (1e-13, answer("MEASURED", 0, delta_j_max="1e-12", probe_error="1e-12"), "in the noise"),
        (1e-13, answer("REFUTED", 1, delta_j_max="1e-11", probe_error="1e-12"), "accused"),
        (0.0, answer("REFUTED", 1, delta_j_max="1e-13", probe_error="1e-12"), "accused"),
        (1e-9, answer("PROVED", 0, delta_j="0"), "zero"),
        (1e-9, answer("MEASURED", 0, reason="ΔJ is 0", probe_error="1e-8"), "zero"),
        (1e-9, answer("UNDECIDED", 1, reason="det J ≡ 1 is claimed and not decided"), "unknown"),
        (None, answer("MEASURED", 0, delta_j_max="1e-9", probe_error="1e-12"), "unknown"),
        (1e-9, Answer(2, 0.0, "bad input"), "error"),
    ],
)
def test_what_is_said_of_a_defect_is_judged(
    delta: float | None, said: Answer, outcome: str
) -> None:
    step = Implicit("midpoint", "newton", 8, "pendulum")
    assert JudgedImplicit(step, said, delta, "").outcome == outcome


@pytest.mark.parametrize(("noise", "outcome"), [("1e-12", "in the noise"), ("1e-15", "unknown")])
def test_a_solver_in_floats_whose_defect_is_not_clear_is_in_the_noise_or_not_known(
    noise: str, outcome: str
) -> None:
    step = Implicit("midpoint", "scipy", 8, "pendulum")
    said = answer("MEASURED", 0, delta_j_max="1e-15", probe_error=noise)
    assert JudgedImplicit(step, said, None, "", most=1e-13).outcome == outcome


def test_the_noise_of_a_counterexample_is_that_of_its_place() -> None:
    example = {"quantity": "det J − 1", "found": "1.5e-08 ± 8.9e-15", "p": "1", "h": "1/8"}
    defect = answer("REFUTED", 1, probe_error="1e-9", counterexample=example).defect
    assert (defect.size, defect.noise) == (1.5e-8, 8.9e-15)


def test_the_place_and_size_of_a_counterexample_are_read(tmp_path: Path) -> None:
    """Of today's answer; its keys are read in `asked.py` alone."""
    path = tmp_path / "euler.py"
    path.write_text("def step(p, q, h):\n    return p - h*q, q + h*p\n")
    energy = ["--hamiltonian", "(p**2 + q**2)/2"]
    found = asked(["check-integrator", f"{path}:step", *energy, "--symplectic"])
    assert (found.outcome, found.order) == ("refuted", 1)
    path.write_text(source_of(Implicit("midpoint", "frozen", 3, "quartic")))
    found = asked(["check-integrator", f"{path}:step", "--hamiltonian", "p**2/2 + q**4/4"])
    assert found.outcome in ("accepted", "undecided", "refuted")
    assert asked(["check-integrator", f"{path}:none", *energy]).outcome == "error"
