"""Each structure that a step keeps is seen; with a planted error it is refuted, in any units."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

import verify
from tests.helpers.programs import kept_steps as steps
from verify.errors import InputError
from verify.integrators.results import Finding


@dataclass(frozen=True)
class Case:
    """A step of `halves` arguments, one with a planted error, and what only the first keeps."""

    step: steps.Step
    wrong: steps.Step
    system: str
    halves: int
    keeps: tuple[str, ...]
    refinements: dict[str, str] = field(default_factory=dict)


CASES = {
    "push": Case(steps.push, steps.push_wrong, steps.PUSH, 2, ("volume",)),
    "leapfrog": Case(
        steps.leapfrog, steps.leapfrog_wrong, steps.MONTE_CARLO, 2, ("volume", "reversible"),
        {"reverses": "-v1, -v2, x1, x2", "form": "dv1^dx1 + dv2^dx2"},
    ),
    "body": Case(
        steps.body, steps.body_wrong, steps.BODY, 1, ("volume", "x**2 + y**2 + w**2"),
        {"poisson": steps.BODY_BRACKET},
    ),
}  # fmt: skip
LOTKA = Case(
    steps.lotka, steps.lotka_wrong, steps.LOTKA, 2, ("symplectic",), {"form": steps.LOTKA_FORM}
)
DAMPED = Case(
    steps.damped, steps.damped_wrong, steps.DAMPED, 2, ("conformal",),
    {"form": "dv^dx", "factor": "exp(-h/10)"},
)  # fmt: skip
CASES |= {"lotka": LOTKA, "damped": DAMPED}
KINDS: dict[str, Any] = {"as it is": lambda x: x, "duals": steps.compared, "floats": steps.packed}


def check(case: Case, step: steps.Step, kind: str) -> Finding:
    plain = KINDS[kind](steps.in_units(step, case.halves, 1.0))
    finding = verify.check(case.system, plain, keeps=case.keeps, **case.refinements)
    assert isinstance(finding, Finding)
    return finding


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", CASES)
def test_what_is_kept_is_seen_and_a_planted_error_is_refuted(name: str, kind: str) -> None:
    case = CASES[name]
    kept, wrong = check(case, case.step, kind), check(case, case.wrong, kind)
    assert kept.verdict in ("PROVED", "MEASURED"), kept.reason
    assert wrong.verdict == "REFUTED"
    assert wrong.counterexample is not None
    refuted = [x for x in wrong.keeps if x.verdict == "REFUTED"]
    assert refuted
    assert all(x.counterexample is not None and x.exact is False for x in refuted)
    if kind != "as it is":
        assert {x.how for x in kept.keeps} == {kind}


@pytest.mark.parametrize("unit", [1e6, 1e-6])
@pytest.mark.parametrize("kind", ["duals", "floats"])
def test_in_other_units_the_verdicts_are_the_same(unit: float, kind: str) -> None:
    """The step is one of 2-forms and of a way back, whose noise has units."""
    case = CASES["leapfrog"]
    system = f"v1_dot = -x1 - x1*x2**2/10/S; v2_dot = -2*x2 - x1**2*x2/10/S; {MOTION}".replace(
        "S", "(10**12)" if unit > 1 else "(1/10**12)"
    )
    for step, expected in ((case.step, ("MEASURED",)), (case.wrong, ("REFUTED",))):
        scaled = KINDS[kind](steps.in_units(step, 2, unit))
        found = verify.check(system, scaled, keeps=case.keeps, **case.refinements)
        assert found.verdict in expected, found.reason


MOTION = "x1_dot = v1; x2_dot = v2"


def verdicts(step: steps.Step, *keeps: str) -> dict[str, str]:
    found = verify.check(steps.PENDULUM, step, keeps=keeps)
    assert isinstance(found, Finding)
    return dict(zip(keeps, (str(x.verdict) for x in found.keeps), strict=True))


def test_an_order_is_claimed_with_a_colon() -> None:
    found = verdicts(steps.verlet, "energy: 3", "energy: 4", "energy")
    assert found == {"energy: 3": "PROVED", "energy: 4": "REFUTED", "energy": "REFUTED"}

    def compared(p: Any, q: Any, h: Any) -> Any:
        return steps.verlet(p, q, h) if p < 1e300 else (p, q)

    measured = verdicts(compared, "energy: 3", "energy: 4", "area", "area: 7")
    assert list(measured.values()) == ["MEASURED", "REFUTED", "MEASURED", "MEASURED"]


def test_an_order_is_seen_through_a_loop_and_where_terms_cancel() -> None:
    """Above the stretch of h¹ the push and the error of the midpoint rule cancel at some place."""

    def pushed(p: Any, q: Any, h: Any) -> Any:
        end = steps.midpoint(p, q, h, 1e-15)
        return end[0] + 0.1 * h, end[1]

    found = verdicts(pushed, "energy: 1", "energy: 2", "area: 3")
    assert list(found.values()) == ["MEASURED", "REFUTED", "MEASURED"]


@pytest.mark.parametrize("kind", ["duals", pytest.param("floats", marks=pytest.mark.left_to_ci)])
def test_a_lower_order_on_one_side_alone_is_no_higher_one(kind: str) -> None:
    """At most places the term is not there: h is small at all before they are followed."""

    def on_one_side(v: Any, x: Any, h: Any) -> Any:
        rub = 1e-5 * h if v > 0 > x else 0.0
        v, x = steps.verlet(v, x, h)
        return v - rub * v, x

    energy, motion = "v**2/2 - cos(x)", "v_dot = -sin(x); x_dot = v"
    for step, verdict in ((steps.verlet, "MEASURED"), (on_one_side, "REFUTED")):
        plain = KINDS[kind](steps.in_units(step, 2, 1.0))
        assert verify.check(motion, plain, keeps=[f"{energy}: 3"]).verdict == verdict


def test_a_step_that_takes_the_size_of_h_is_not_symmetric() -> None:
    found = verify.check(steps.PENDULUM, steps.verlet_without_sign, keeps=["symmetric", "area"])
    symmetric, area = found.keeps
    assert (found.verdict, symmetric.verdict, area.verdict) == ("REFUTED", "REFUTED", "PROVED")
    assert "it takes |h|, so that its step of −h is that of h" in symmetric.reason
    assert verdicts(steps.verlet, "symmetric")["symmetric"] in ("PROVED", "MEASURED")


def test_the_way_back_is_told_in_the_numbers_of_the_code() -> None:
    kept, lost = (
        verify.check(steps.PENDULUM, step, keeps=["reversible", "symmetric"])
        for step in (steps.verlet, steps.verlet_uneven)
    )
    assert [x.way_back.text for x in kept.keeps] == 2 * [
        "in its own numbers it leads back bit for bit, at 6 places"
    ]
    assert [str(x.verdict) for x in lost.keeps] == ["REFUTED", "REFUTED"]
    assert all(x.way_back.units > 1e9 for x in lost.keeps)


def test_friction_of_the_seventh_digit_is_seen() -> None:
    found = verdicts(steps.verlet_with_friction, "area", "reversible", "symmetric")
    assert set(found.values()) == {"REFUTED"}


def test_what_a_loop_may_leave_refutes_nothing() -> None:
    found = verify.check(steps.PENDULUM, steps.midpoint, keeps=["area", "symmetric", "energy: 3"])
    assert [str(x.verdict) for x in found.keeps] == ["UNDECIDED", "UNDECIDED", "MEASURED"]
    assert "an iteration leaves that stops at a tolerance" in found.keeps[0].reason
    allowed = verify.check(steps.PENDULUM, steps.midpoint, keeps=["area"], within="1e-6")
    refused = verify.check(steps.PENDULUM, steps.midpoint, keeps=["energy"], within="1e-6")
    assert (allowed.verdict, refused.verdict) == ("MEASURED", "REFUTED")


def test_a_step_that_does_nothing_or_leads_elsewhere_is_left_open() -> None:
    assert set(verdicts(lambda p, q, h: (p, q), "area", "symmetric").values()) == {"UNDECIDED"}

    def of_another_force(p: Any, q: Any, h: Any) -> Any:
        p = p - 2 * h * np.sin(q)
        return p, q + h * p

    other = verify.check(steps.PENDULUM, of_another_force, keeps=["area"])
    assert other.verdict == "UNDECIDED"
    assert "it is no step of this system" in other.reason


def test_an_angle_that_is_reduced_leads_back() -> None:
    def reduced(p: Any, q: Any, h: Any) -> Any:
        p, q = steps.verlet(p, q, h)
        return p, (q + np.pi) % (2 * np.pi) - np.pi

    assert set(verdicts(reduced, "reversible", "symmetric").values()) == {"MEASURED"}


def test_a_step_that_refuses_negative_h_is_symmetric_or_not() -> None:
    def forward(p: Any, q: Any, h: Any) -> Any:
        if h <= 0:
            raise ValueError("h must be positive")
        return steps.verlet(p, q, h)

    found = verdicts(forward, "symmetric", "area", "reversible")
    assert list(found.values()) == ["UNDECIDED", "PROVED", "MEASURED"]


def test_what_the_exact_flow_does_not_keep_is_refused() -> None:
    with pytest.raises(InputError, match="is not kept by the exact flow"):
        verify.check(steps.DAMPED, steps.damped, form="dv^dx")
    with pytest.raises(InputError, match="has no p and q; write reverses"):
        verify.check(steps.DAMPED, steps.damped, keeps=["reversible"])
    with pytest.raises(InputError, match="goes with an H"):
        verify.check(steps.DAMPED, steps.damped, keeps=["volume"], arguments="v,x,h")


def test_what_is_far_off_is_no_multiple_of_a_turn() -> None:
    """Each number of 10¹⁴ and more is near a multiple of 2π, by the digits that it has."""
    found = verify.check_map(lambda p, q: (p + 1e14 * q, q + p), keeps=["reversible"])
    assert found.verdict == "REFUTED", found.reason


def test_a_map_is_judged_by_its_own_names() -> None:
    names = "v1,v2,x1,x2"
    right = verify.check_map(steps.two, coordinates=names, form="dv1^dx1 + 3*dv2^dx2")
    wrong = verify.check_map(steps.two, coordinates=names, form="dv1^dx1 + 3.001*dv2^dx2")
    assert (right.verdict, wrong.verdict) == ("PROVED", "REFUTED")
    assert list(wrong.counterexample.z) == names.split(",")
    with_masses = verify.check_map(
        lambda v, x, m1, m2: steps.two(v, x), coordinates=names,
        form="m1*dv1^dx1 + m2*dv2^dx2", parameters={"m1": 1, "m2": 3},
    )  # fmt: skip
    assert with_masses.verdict == "PROVED"


def test_names_stand_in_a_text_or_in_a_list() -> None:
    names, form = ["v1", "v2", "x1", "x2"], "dv1^dx1 + 3*dv2^dx2"
    for coordinates in (names, tuple(names), ",".join(names)):
        assert verify.check_map(steps.two, coordinates=coordinates, form=form).verdict == "PROVED"
    turn = verify.check_map(lambda z: [-z[1], z[0]], arguments=["q", "p"])
    assert turn.verdict == "PROVED"
    bad = {"x,y z": "'y z' is no name", "": "'' is no name", "x,x": "x stands twice"}
    for text, problem in bad.items():
        for coordinates in (text, text.split(",")):
            with pytest.raises(verify.InputError, match=f"^coordinates=.*: {problem}$"):
                verify.check_map(steps.two, coordinates=coordinates)
    for wrong in (3, ["x", 3], {"x", "y"}):
        with pytest.raises(verify.InputError, match="is no text, and no list of texts"):
            verify.check_map(steps.two, coordinates=wrong)  # type: ignore[arg-type]
    with pytest.raises(verify.InputError, match="arguments=q,x: is no order of p, q"):
        verify.check_map(lambda z: z, arguments=["q", "x"])


def test_a_map_may_have_any_number_of_coordinates() -> None:
    assert verify.check_map(steps.flow_of_abc, coordinates="x,y,w").verdict == "PROVED"
    stretched = verify.check_map(lambda z: [z[0] * 1.001, z[1], z[2]], coordinates="x,y,w")
    assert stretched.verdict == "REFUTED"
    one = verify.check_map(lambda x: x**3 + x, coordinates="x", density="1/(1 + x**2)")
    assert one.verdict == "REFUTED"


def test_a_map_with_friction_has_its_factor() -> None:
    def friction(p: Any, q: Any, h: Any) -> Any:
        return steps.damped(p, q, h)

    for factor, expected in (("exp(-h/10)", "PROVED"), ("exp(-h/9)", "REFUTED")):
        found = verify.check_map(
            friction, keeps=["conformal"], factor=factor, parameters={"h": "0.1"}
        )
        assert found.verdict == expected
    with pytest.raises(InputError, match="has h, and a map has none"):
        verify.check_map(lambda p, q: (p, q), keeps=["conformal"], factor="exp(-h)")


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"keeps": ["symmetric"]}, "is of steps; a map has no h"),
        ({"keeps": ["volume: 3"]}, "a map has no h"),
        ({"coordinates": "x,y,w"}, "do not hold the 3 coordinates x, y, w"),
        ({"coordinates": "x,h"}, "h has another meaning"),
        ({"coordinates": "x,x"}, "x stands twice"),
        ({"coordinates": "x,y", "keeps": ["symplectic"]}, "write --form"),
        ({"form": "dp^dx"}, "allowed: p, q"),
        ({"keeps": ["energy"]}, "without H"),
    ],
)
def test_what_cannot_be_asked_of_a_map_is_refused(options: dict[str, Any], problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        verify.check_map(lambda p, q: (p, q), **options)


def test_one_turned_momentum_keeps_volume_but_for_its_orientation() -> None:
    def flipped(p: Any, q: Any) -> Any:
        p, q = steps.verlet(p, q, 0.3)
        return -p, q

    found = verify.check_map(flipped, keeps=["volume"], reverses="p, q")
    assert [str(x.verdict) for x in found.keeps] == ["UNDECIDED", "PROVED"]
    assert "orientation turned" in found.keeps[0].reason


def test_steps_of_equations_have_an_order() -> None:
    for order, expected in ((1, "PROVED"), (2, "REFUTED")):
        found = verify.check(steps.LOTKA, steps.lotka, order=order, form=steps.LOTKA_FORM)
        assert found.verdict == expected
        assert (found.counterexample is not None) is (order == 2)
    z = KINDS["floats"](steps.in_units(steps.lotka, 2, 1.0))
    assert verify.check(steps.LOTKA, z, order=1).verdict == "MEASURED"
    assert verify.check(steps.LOTKA, z, order=2).verdict == "REFUTED"
    with pytest.raises(InputError, match="claim --keeps volume"):
        verify.check(steps.LOTKA, steps.lotka, area_preserving=True)
