"""Verdicts about users' code in units, shapes and states of their own."""

import math
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import verify
from tests.end_to_end.test_command_line import here
from tests.helpers.programs import scaled_steps as steps
from tests.helpers.programs.compilers import library
from tests.helpers.programs.judged import judged
from verify.errors import InputError
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.foreign.foreign_function import step_of_library
from verify.integrators.measures.survey import Request, places_of_field
from verify.integrators.places.units import FloatField, units_of
from verify.integrators.results import Claims, Finding
from verify.integrators.user_code.user_map import DOUBLE

BOTH = Claims(order=2, symplectic=True)


# -- units ----------------------------------------------------------------------------------------


@pytest.mark.left_to_ci
def test_euler_in_kilometres_and_seconds_is_of_order_1_and_not_symplectic() -> None:
    found = judged(steps.euler_of_earth, hamiltonian=steps.EARTH)
    assert (found.verdict, found.convergence_order, found.symplectic) == ("MEASURED", 1, False)
    assert (
        judged(steps.euler_of_earth, Claims(order=2), hamiltonian=steps.EARTH).verdict == "REFUTED"
    )
    right = judged(steps.verlet_of_earth, BOTH, hamiltonian=steps.EARTH)
    assert (right.verdict, right.convergence_order, right.symplectic) == ("MEASURED", 2, True)


def test_so_it_is_in_c(tmp_path: Path) -> None:
    path = library(tmp_path, "step.c", steps.EULER_OF_EARTH, "-lm")
    found = judged(step_of_library(f"{path}:step", 2, DOUBLE, 60), BOTH, hamiltonian=steps.EARTH)
    assert (found.verdict, found.convergence_order, found.symplectic) == ("REFUTED", 1, False)


KEPLER = "(p1**2 + p2**2)/2 - {}/sqrt(q1**2 + q2**2)"


@pytest.mark.parametrize(("mass", "length"), [("10**18", 1e6), ("1/10**18", 1e-6)])
def test_where_h_has_no_scale_one_is_that_of_a_unit_of_time(mass: str, length: float) -> None:
    field = FloatField(Hamiltonian.parse(KEPLER.format(mass)))
    (_, scale), _ = units_of(field)
    assert 0.1 < float(scale[-1]) / length < 10
    assert len(units_of(field, 7000.0)[0]) == 1
    assert len(units_of(FloatField(Hamiltonian.parse(KEPLER.format("1"))))[0]) == 1


@pytest.mark.left_to_ci
def test_a_mistake_is_seen_where_a_unit_of_time_passes() -> None:
    """At a length of 1 a force of 10⁻⁶ q is nothing beside 10¹⁸/q², and at 10⁶ it is something."""
    for mistake, verdict in ((0.0, "MEASURED"), (1e-6, "REFUTED")):
        step = steps.verlet_in_units(1e6, mistake)
        found = verify.check(KEPLER.format("10**18"), step, keeps=["angular-momentum", "energy: 3"])
        assert {str(x.verdict) for x in found.keeps} == {verdict}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("sigma", ["1/1000", "2", "340"])
def test_a_molecule_of_any_size_is_of_its_order_up_to_the_cutoff(sigma: str) -> None:
    size = float(Fraction(sigma))
    exact = systems.get("lennard-jones").hamiltonian({"epsilon": "1", "sigma": sigma})
    found = judged(steps.molecule(size, 3 * size), BOTH, hamiltonian=exact)
    assert (found.verdict, found.convergence_order) == ("MEASURED", 2), found.reason
    assert found.domain[0] == f"q ≤ `{3 * size:.6g}`"
    wrong = judged(steps.molecule(size * (1 + 1e-6), 50 * size), BOTH, hamiltonian=exact)
    assert (wrong.verdict, wrong.convergence_order) == ("REFUTED", 0), wrong.reason


@pytest.mark.left_to_ci
@pytest.mark.parametrize("rate", [1, 10**6, 10**12])
def test_the_order_of_a_right_method_on_stiff_h_is_seen(rate: int) -> None:
    found = judged(steps.stiff(rate), BOTH, hamiltonian=f"p**2/2 + {rate}*q**2/2")
    assert (found.verdict, found.convergence_order) == ("MEASURED", 2), found.reason
    wrong = judged(steps.stiff(rate), BOTH, hamiltonian=f"p**2/2 + {rate}*1.0001*q**2/2")
    assert wrong.verdict == "REFUTED"


@pytest.mark.left_to_ci
@pytest.mark.parametrize("speed", [1e-5, 1.0, 1e4])
def test_a_body_near_the_speed_of_light_has_a_unit_of_p_and_one_of_q_by_it(speed: float) -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        p = p - h / 2 * 2 * q
        q = q + h * speed * p / (speed**2 + p**2) ** 0.5
        return p - h / 2 * 2 * q, q

    energy = f"{speed}*sqrt({speed}**2 + p**2) + q**2"
    found = judged(step, BOTH, hamiltonian=energy)
    assert found.convergence_order == 2, found.reason
    assert found.symplectic
    places = places_of_field(FloatField(Hamiltonian.parse(energy)), time_dependent=False)
    assert max(abs(x.z[0]) for x in places) < 10 * speed
    wrong = judged(step, BOTH, hamiltonian=energy.replace("+ q**2", "+ 1.001*q**2"))
    assert (wrong.verdict, wrong.convergence_order) == ("REFUTED", 0)


IN_C = """
#include <math.h>
static double F(double q, double t) {{ return {force}; }}
static double V(double p) {{ return {velocity}; }}
void step(int n, double t, double h, double *p, double *q)
{{
    p[0] += h/2*F(q[0], t); q[0] += h*V(p[0]); p[0] += h/2*F(q[0], t + h);
}}
"""


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("energy", "force", "velocity", "right", "wrong"),
    [
        ("p**2/2 + 1e-12*cos(1e6*q) + q**4/4", "1e-6*sin(1e6*q) - {}*q*q*q", "p", "1", "1.01"),
        ("p**2/2 + q**2/2 + q**4/4 + 1e-24*q**6/6", "-q - q*q*q - {}*pow(q, 5)", "p",
         "1e-24", "1.01e-24"),
        ("p**2/2 + exp(50*q) + exp(-0.01*q)", "-50*exp(50*q) + {}*exp(-0.01*q)", "p",
         "0.01", "0.0101"),
        ("p**2/2 - cos(q) + 0.3*q*cos(t/100000)", "-sin(q) - 0.3*cos(t/{})", "p", "1e5", "2e5"),
        ("3e8*sqrt(p**2 + 2.73e-22**2) + 1e-9*q**2", "-2e-9*q", "p*3e8/hypot(p, {})",
         "2.73e-22", "2.74e-22"),
    ],
    ids=["ripples", "far", "slow", "clock", "fast"],
)  # fmt: skip
def test_every_scale_of_h_is_looked_at(
    tmp_path: Path, energy: str, force: str, velocity: str, right: str, wrong: str
) -> None:
    for number, verdict in ((right, "MEASURED"), (wrong, "REFUTED")):
        texts = {"force": force.format(number), "velocity": velocity.format(number)}
        path = library(tmp_path, f"{verdict}.c", IN_C.format(**texts), "-lm")
        function = step_of_library(f"{path}:step", 1, DOUBLE, 60)
        assert judged(function, BOTH, hamiltonian=energy).verdict == verdict


@pytest.mark.parametrize(
    "energy",
    ["p**2/2 - cos(q)", "p**2/2 + exp(q) - q", "p**2/2 + 4*(q**-12 - q**-6)", "p**2/2 + exp(-q**2)",
     "p**2/2 + (1 - exp(-q))**2", "p**2/2 + q**2/2 + q**4/4", "p**2/2 - exp(-q)/q"],
)  # fmt: skip
def test_where_numbers_end_or_a_force_dies_out_is_no_scale_of_its_own(energy: str) -> None:
    scales, _ = units_of(FloatField(Hamiltonian.parse(energy)))
    assert len(scales) == 1
    assert all(1 / 10 <= x <= 10 for x in scales[0])


@pytest.mark.parametrize(("factor", "verdict"), [("3e-7", "REFUTED"), ("1e-8", "MEASURED")])
def test_a_constant_that_is_wrong_in_its_seventh_digit_is_none_that_was_rounded(
    tmp_path: Path, factor: str, verdict: str
) -> None:
    source = IN_C.format(force=f"-sin(q)*(1 + {factor})", velocity="p")
    function = step_of_library(f"{library(tmp_path, 'step.c', source, '-lm')}:step", 1, DOUBLE, 60)
    found = judged(function, BOTH)
    assert found.verdict == verdict, found.reason
    noted = any("h^1 only, as the rounding of a coefficient" in str(x) for x in found.notes)
    assert noted == (verdict == "MEASURED")


def test_where_a_loop_does_one_turn_less_no_order_is_seen() -> None:
    def slopes(p: Any, q: Any) -> Any:
        return [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2, *p]

    def step(p: Any, q: Any, h: Any) -> Any:
        z = [*p, *q]
        end = z
        for _ in range(60):
            middle = [(x + y) / 2 for x, y in zip(z, end, strict=True)]
            new = [x + h * y for x, y in zip(z, slopes(middle[:2], middle[2:]), strict=True)]
            moved = max(abs(x - y) for x, y in zip(new, end, strict=True))
            end = new
            if moved < 1e-8:
                break
        return end[:2], end[2:]

    energy = "(p1**2 + p2**2)/2 + (q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
    found = judged(step, Claims(order=2), hamiltonian=energy)
    assert (found.verdict, found.convergence_order) == ("MEASURED", 2), found.reason


CHAIN = """
void step(int n, double t, double h, double *p, double *q)
{
    double m[3] = {2, 3, 5};
    for (int turn = 0; turn < 2; turn++) {
        for (int i = 0; i < 3; i++) {
            double left = i ? q[i - 1] : 0, right = i < 2 ? q[i + 1] : 0;
            p[i] -= h/2*(2*q[i] - left - right + q[i]*q[i]*q[i])/m[i];
        }
        if (!turn) for (int i = 0; i < 3; i++) q[i] += h*p[i];
    }
}
"""


@pytest.mark.left_to_ci
def test_velocities_of_three_bodies_in_c_are_named(tmp_path: Path) -> None:
    path = library(tmp_path, "chain.c", CHAIN, "-lm")
    energy = (
        "p1**2/4 + p2**2/6 + p3**2/10 + (q1**2 + (q2 - q1)**2 + (q3 - q2)**2 + q3**2)/2"
        " + (q1**4 + q2**4 + q3**4)/4"
    )
    found = judged(step_of_library(f"{path}:step", 3, DOUBLE, 60), BOTH, hamiltonian=energy)
    assert found.verdict == "REFUTED"
    note = "in momenta p = m·v, m = (2, 3, 5), it is of order 2 and symplectic"
    assert note in map(str, found.notes)


def test_a_term_that_acts_far_from_0_alone_is_seen() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        if q > steps.FAR:
            return p, q
        p = p - h * (1e-3 * q + 2.0001e-15 * q**3)
        return p, q + h * p / 5

    right, wrong = "2e-15", "2.0001e-15"
    for cubic, verdict in ((wrong, "MEASURED"), (right, "REFUTED")):
        formula = f"p**2/10 + 0.001*q**2/2 + {cubic}*q**4/4"
        assert judged(step, Claims(order=1), hamiltonian=formula).verdict == verdict


# -- what may be ignored --------------------------------------------------------------------------


def pull(q: Any) -> Any:
    return -math.sin(q)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9, 1e-12])
def test_a_tolerance_above_the_noise_is_refuted_and_named(tolerance: float) -> None:
    found = judged(steps.midpoint(pull, tolerance), Claims(symplectic=True))
    assert found.verdict == "REFUTED"
    assert "an iteration that stops, at a tolerance of at least" in found.reason
    assert found.largest is not None
    assert tolerance / 10 < found.largest < 100 * tolerance
    allowed = Request(within=Fraction(1000 * tolerance))
    assert (
        judged(steps.midpoint(pull, tolerance), Claims(symplectic=True), request=allowed).verdict
        == "MEASURED"
    )


def test_an_iteration_to_the_noise_is_within_it() -> None:
    found = judged(steps.midpoint(pull, 1e-15), BOTH)
    assert (found.verdict, "within the noise of doubles" in found.reason) == ("MEASURED", True)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("share", [1e-3, 1e-9, 1e-12])
def test_a_map_that_loses_area_behind_a_comparison_is_refuted(share: float) -> None:
    found = verify.check_map(steps.losing(share))
    assert (found.verdict, found.largest) == ("REFUTED", pytest.approx(share, rel=0.1))
    assert verify.check_map(steps.losing(share), within=2 * share).verdict == "MEASURED"
    assert verify.check_map(steps.losing(0.0)).verdict == "MEASURED"


def test_rounded_states_are_coarse_in_several_degrees_too() -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        p = p - h / 2 * q
        q = q + h * p
        return np.round(p - h / 2 * q, 3), np.round(q, 3)

    found = judged(step, Claims(symplectic=True), hamiltonian="(p1**2 + p2**2 + q1**2 + q2**2)/2")
    assert found.verdict == "UNDECIDED"
    assert "its numbers are coarse" in found.reason


@pytest.mark.left_to_ci
def test_a_matrix_of_few_digits_is_told_that_a_symplectic_one_is_near() -> None:
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c + 0.4 * s, 2.3 * s], [-1.16 / 2.3 * s, c - 0.4 * s]])
    wrong = turn + np.array([[1e-3, 0], [0, 0]])
    for digits in (6, 9):
        for matrix, near in ((turn, True), (wrong, False)):
            few = np.round(matrix, digits)

            def rounded(p: Any, q: Any, matrix: Any = few) -> Any:
                q, p = matrix @ np.array([q, p])
                return p, q

            found = verify.check_map(rounded)
            assert found.verdict == "REFUTED"
            said = f"within half a unit of the {digits}th digit of its entries"
            assert any(said in note for note in found.notes) is near


# -- shapes ---------------------------------------------------------------------------------------

SHAPES = [
    steps.words, steps.eps_last, steps.size_first, steps.unknown_names, steps.state_of_q_p,
    steps.state_of_p_q, steps.by_attributes, steps.annotated,
]  # fmt: skip


@pytest.mark.parametrize("step", SHAPES, ids=lambda f: f.__name__)
def test_each_shape_is_understood(step: steps.Step) -> None:
    found = judged(step, BOTH)
    assert (found.verdict, found.convergence_order) == ("PROVED", 2), found.notes


@pytest.mark.left_to_ci
def test_bodies_in_space_have_arrays_of_their_shape() -> None:
    found = judged(steps.bodies, BOTH, hamiltonian=steps.TWO_BODIES)
    assert found.verdict.holds
    assert found.convergence_order == 2


def test_what_returns_another_shape_is_told_what_came() -> None:
    with pytest.raises(InputError, match=r"returns 2 numbers.*wanted: p', q'"):
        judged(lambda p, q, h: (p[0], q[0]), hamiltonian=steps.TWO_BODIES)


# -- other forms ----------------------------------------------------------------------------------


@pytest.mark.left_to_ci
def test_velocities_are_refuted_and_told_what_they_are_in_momenta() -> None:
    def step(x: Any, v: Any, dt: Any) -> Any:
        v, x = steps.in_velocities(v, x, dt)
        return x, v

    found = judged(step, BOTH, hamiltonian=steps.UNLIKE)
    assert found.verdict == "REFUTED"
    note = "in momenta p = m·v, m = (1, 3), it is of order 2 and symplectic"
    assert note in found.notes
    seen = verify.check_map(steps.in_velocities, degrees=2)
    assert seen.verdict == "REFUTED"
    assert any("with m = (1, 3)" in note for note in seen.notes)
    assert not any("m = (" in note for note in verify.check_map(steps.boris, degrees=3).notes)


def test_det_j_is_told_of_what_is_not_symplectic() -> None:
    found = verify.check_map(steps.boris, degrees=3)
    assert (found.verdict, found.area_preserving) == ("REFUTED", True)
    assert "det J is 1" in found.reason


# -- branches -------------------------------------------------------------------------------------

BRANCHES = {
    "|q| > 2": lambda p, q: abs(q) > 2,
    "p > 1": lambda p, q: p > 1,
    "q < -1": lambda p, q: q < -1,
    "energy > 1/2": lambda p, q: p * p / 2 + 1 - math.cos(q) > 0.5,
    "q > 30": lambda p, q: q > 30,
    "p < -40": lambda p, q: p < -40,
    "p q > 25": lambda p, q: p * q > 25,
}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", BRANCHES)
def test_a_fault_on_the_other_side_of_a_comparison_is_seen(name: str) -> None:
    found = judged(steps.faulty(BRANCHES[name]), Claims(symplectic=True))
    assert found.verdict == "REFUTED", found.notes
    assert judged(steps.clipped, Claims(symplectic=True)).verdict == "REFUTED"


def test_a_cutoff_gives_the_order_its_domain_and_refutes_nothing() -> None:
    found = judged(steps.cut_off(50.0), BOTH)
    assert (found.verdict, found.convergence_order) == ("MEASURED", 2)
    assert found.domain[0] == "q ≤ `50`"
    assert any("beyond it the code does something else" in note for note in found.notes)
    there = Request(z=(Fraction(1), Fraction(60)))
    assert judged(steps.cut_off(50.0), BOTH, request=there).verdict == "REFUTED"


def test_what_is_out_of_all_proportion_is_named_and_not_visited() -> None:
    found = judged(steps.stiff(1), BOTH, hamiltonian="p**2/2 + q**2/2")
    assert "it compares, and may do something else, where q ≥ 1e+300: not looked at" in found.notes


@pytest.mark.left_to_ci
@pytest.mark.parametrize("degrees", [1, 2, 3])
def test_all_signs_are_looked_at_in_pairs(degrees: int) -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        if np.any(q > steps.FAR):
            return p, q
        p = p - h * q
        return p, q + h * p

    names = "p q" if degrees == 1 else " ".join(f"p{k} q{k}" for k in range(1, degrees + 1))
    formula = " + ".join(f"{name}**2/2" for name in names.split())
    found: Finding = judged(step, hamiltonian=formula)
    states = [place.z for place in found.places]
    for a in range(2 * degrees):
        for b in range(a):
            seen = {(z[a] > 0, z[b] > 0) for z in states}
            assert len(seen) == 4, (a, b)


# -- limits and requests --------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.parametrize("limit", [1.0, 3.0])
def test_the_time_limit_holds_for_all_that_is_done(limit: float) -> None:
    def step(p: Any, q: Any, h: Any) -> Any:
        for _ in range(100):
            p, q = steps.bodies(p, q, h / 100)
        return p, q

    begun = time.process_time()  # the seconds on the wall depend on what else runs
    found = judged(step, BOTH, limit, steps.TWO_BODIES)
    assert time.process_time() - begun < 2 * limit + 2
    assert found.verdict in ("MEASURED", "UNDECIDED")


def test_a_verdict_that_rests_on_another_place_says_so() -> None:
    mine = Request(z=(Fraction(1, 4), Fraction(1, 3)), step_size=Fraction(1, 100))
    fault = steps.faulty(lambda p, q: q > 2)
    found = judged(fault, Claims(symplectic=True), request=mine)
    note = "it is shown at another place than the one that you gave"
    assert (found.verdict, note in found.notes) == ("REFUTED", True)
    assert found.places[0].z == mine.z
    assert all(place.step == mine.step_size for place in found.places)
    there = Request(z=(Fraction(0), Fraction(5, 2)))
    assert note not in judged(fault, Claims(symplectic=True), request=there).notes


def test_sizes_that_are_given_are_those_of_the_places() -> None:
    scale = {"p": Fraction(1, 1000), "q": Fraction(50)}
    found = judged(steps.stiff(1), hamiltonian="p**2/2 + q**2/2", request=Request(scale=scale))
    assert {place.units for place in found.places} == {(scale["p"], scale["q"])}


@pytest.mark.parametrize(
    "request_",
    [Request(z=(Fraction(0), Fraction(10) ** 200)), Request(scale={"q": Fraction(10) ** 200}),
     Request(step_size=Fraction(1, 10**200)), Request(z=(Fraction(0), Fraction(0)))],
)  # fmt: skip
def test_what_floats_cannot_hold_and_where_h_is_singular_is_bad_input(request_: Request) -> None:
    with pytest.raises(InputError):
        judged(steps.molecule(1.0, 9.0), hamiltonian="p**2/2 + 4/q**12 - 4/q**6", request=request_)


def test_a_float_in_large_units_is_no_exact_coefficient() -> None:
    """25430.5·1.19591234567e15 as a float is another number, and the order is not refuted by it."""
    strength = 25430.5 * 1.19591234567e15

    def step(p: Any, q: Any, h: Any) -> Any:
        p = p - h * strength * q / 7.3
        return p, q + h * p

    formula = "p**2/2 + 25430.5*1.19591234567e15*q**2/14.6"
    found = judged(step, Claims(order=1, symplectic=True), hamiltonian=formula)
    assert found.verdict == "MEASURED"
    wrong = formula.replace("1.19591234567", "1.19591234568")
    assert judged(step, Claims(order=1), hamiltonian=wrong).verdict == "REFUTED"


def test_where_h_has_no_length_the_users_place_has_one() -> None:
    orbit = tuple(map(Fraction, ("0", "15/2", "7000", "0")))
    mine = Request(z=orbit, step_size=Fraction(10))
    found = judged(steps.verlet_of_earth, BOTH, hamiltonian=steps.EARTH, request=mine)
    assert (found.verdict, found.convergence_order) == ("MEASURED", 2)
    assert {place.units[2] for place in found.places} == {Fraction(5000)}
    assert (found.places[0].z, found.places[0].step) == (orbit, 10)
    assert all(place.step <= 10 for place in found.places)


def test_a_map_takes_h_as_a_parameter() -> None:
    def turn(p: Any, q: Any, h: Any) -> Any:
        p = p - h * np.sin(q)
        return p, q + h * p

    assert verify.check_map(turn, parameters={"h": "1/10"}).verdict == "PROVED"


# -- implicit, and long ---------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_a_generalised_leapfrog_is_refuted_by_its_tolerance(tolerance: float) -> None:
    step = steps.generalised_leapfrog(tolerance)
    found = judged(step, Claims(symplectic=True), hamiltonian=steps.RIEMANNIAN)
    assert found.verdict == "REFUTED"
    assert found.counterexample is not None
    said = float(found.counterexample.found.split()[0])
    at = [float(x) for x in (*found.counterexample.z.values(), found.counterexample.h or 0)]
    with mpmath.workdps(60):
        p, q, h = map(mpmath.mpf, at)
        w = mpmath.mpf(10) ** -25

        def moved(i: int, sign: int) -> Any:
            z = [p + sign * w * (i == 0), q + sign * w * (i == 1)]
            return steps.generalised_leapfrog(tolerance)(*z, h)

        columns = [
            [(a - b) / (2 * w) for a, b in zip(moved(i, 1), moved(i, -1), strict=True)]
            for i in (0, 1)
        ]
        (a, b), (c, d) = columns
        truth = float(a * d - b * c - 1)
    assert said == pytest.approx(truth, rel=1e-6)


def test_a_doubled_phase_space_is_measured_where_algebra_leaves_it_open() -> None:
    def half(p: Any, q: Any, h: Any) -> Any:
        z = steps.doubled([*p, *q], h)
        return z[:2], z[2:]

    found = judged(half, BOTH, hamiltonian=steps.DOUBLED)
    assert (found.verdict.holds, found.convergence_order, found.symplectic) == (True, 2, True)
    assert verify.check_map(steps.doubled, degrees=2, parameters={"h": "1/10"}).verdict.holds


@pytest.mark.left_to_ci
def test_a_star_and_light_planets_are_judged_in_their_units() -> None:
    found = judged(steps.planets(), BOTH, hamiltonian=steps.STAR)
    assert (found.verdict, found.convergence_order, found.symplectic) == ("MEASURED", 2, True)
    wrong = judged(steps.planets(1.001), Claims(order=2), hamiltonian=steps.STAR)
    assert wrong.verdict == "REFUTED"  # of the force between the planets alone


@pytest.mark.left_to_ci
def test_what_is_refuted_in_c_is_printed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = library(tmp_path, "step.c", steps.FAST_KEPLER, "-lm")
    formula = "(p1**2 + p2**2)/2 - 100/sqrt(q1**2 + q2**2)"
    for more in ((), ("--json",)):
        typed = ("check-integrator", f"{path}:step", "--symplectic", "--hamiltonian", formula)
        status, out, _ = here(capsys, *typed, *more)
        assert (status, "REFUTED" in out) == (1, True)
