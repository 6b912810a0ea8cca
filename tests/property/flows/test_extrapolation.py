"""The exact flows at random initial values, parameters and times."""

from fractions import Fraction

import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.flow_checks import Case, energy_defect, group_defect, motion_defect
from tests.helpers.sampled.formulas import Q, plain, rationals
from verify.flows.ball_evaluation import blow_up
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians import systems
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.flow_recognition import closed_form
from verify.hamiltonians.named_system import System
from verify.hamiltonians.potential_motion import in_potential

CLOSED = [system for system in systems.all_systems().values() if system.flow is not None]
PARTS = st.builds(Fraction, st.integers(-90, 90), st.just(100))
LONGEST = 6


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """A system with random parameters, and a random initial value."""
    system: System = draw(st.sampled_from(CLOSED))
    values = {name: draw(rationals(5)) for name in system.parameters}
    case = Case(system, values, draw(rationals(5)), draw(rationals(5)))
    assume(system.flow is not None and system.flow(values, case.p, case.q) is not None)
    return case


def time_in(case: Case, part: Fraction) -> Fraction:
    """That part of what the solution has before it ends; short where V is steep."""
    end = blow_up(case.motion, 1 if part > 0 else -1, 10)
    return part * min(LONGEST, end if end is not None else LONGEST)


@drawn(120)
@given(cases(), PARTS)
def test_h_is_constant_and_the_equation_of_motion_holds_to_50_digits(
    case: Case, part: Fraction
) -> None:
    time = time_in(case, part)
    assert energy_defect(case, [time]) < 1e-50
    assert motion_defect(case, [time]) < 1e-50


@drawn(120)
@given(cases(), PARTS, PARTS)
def test_the_flow_is_a_group_to_45_digits(case: Case, first: Fraction, whole: Fraction) -> None:
    t, total = time_in(case, first), time_in(case, whole)
    try:
        defect = group_defect(case, total - t, t)
    except NoFlowError:  # from so far out there is no way back with 10,000 digits, and it is said
        assume(False)
    assert defect < 1e-45


@st.composite
def rooted(draw: st.DrawFn) -> Case:
    """q'² = f(q) with chosen roots, some of them multiple, and rational initial values."""
    roots = draw(st.lists(st.integers(-2, 2), max_size=4))
    pairs = draw(st.lists(st.integers(1, 3), max_size=(4 - len(roots)) // 2))  # of complex roots
    q, scale = draw(rationals(4)), draw(rationals(2))
    factors = [*(f"(q - ({r}))" for r in roots), *(f"(q**2 + {n})" for n in pairs)]
    f = sympy.Poly(plain("*".join(factors) or "1"), Q)
    at = f.eval(sympy.Rational(q.numerator, q.denominator))
    value = Fraction(int(at.p), int(at.q))
    assume(value)
    c = [-Fraction(int(x.p), int(x.q)) * scale**2 / value / 2 for x in f.all_coeffs()[::-1]]
    formula = "p**2/2 + " + " + ".join(f"({x})*q**{k}" for k, x in enumerate(c))
    system = System("any", "any", formula, "drawn", flow=in_potential(lambda _: c))
    return Case(system, {}, scale, q)


@drawn(150)
@given(rooted(), PARTS)
def test_motion_between_multiple_roots_satisfies_its_equation(case: Case, part: Fraction) -> None:
    time = time_in(case, part)
    assert energy_defect(case, [time]) < 1e-50
    assert motion_defect(case, [time]) < 1e-50


@drawn(40)
@given(rooted())
def test_an_end_in_finite_time_is_there_and_nowhere_else(case: Case) -> None:
    """Just before its end the solution is far away; without an end it can be followed on."""
    for sign in (1, -1):
        end = blow_up(case.motion, sign, 20)
        assume(end is None or end < 100)
        flow = NumericalFlow(canonical_field(case.system.hamiltonian())[0], 20)
        start = flow.number(case.p), flow.number(case.q)
        if end is None:
            flow.follow(start, Fraction(sign * 2), 5000)  # before noise grows at a saddle
        else:
            near = flow.follow(start, sign * end * Fraction(999, 1000), 5000)
            assert abs(near[1] - start[1]) > 5
            with pytest.raises(NoFlowError):
                flow.follow(start, sign * end * Fraction(1001, 1000), 5000)


@drawn(25)
@given(cases(), PARTS)
def test_the_numerical_flow_agrees(case: Case, part: Fraction) -> None:
    hamiltonian = case.system.hamiltonian(case.values)
    known = closed_form(hamiltonian, case.p, case.q)
    assert known is not None, "what a system knows is found from its formula"
    time = time_in(case, part) / 4
    flow = NumericalFlow(canonical_field(hamiltonian)[0], 35)
    z = flow.follow((flow.number(case.p), flow.number(case.q)), time, 20_000)
    found = case.at(time, 40)
    scale = 1 + max(map(abs, (*found, case.p, case.q)))
    for ours, theirs in zip(found, z, strict=True):
        assert abs(ours - flow.arithmetic.exact(theirs)) < scale / 10**27
