"""What is made once and shared: programs, what is tried in them, and what bounds derivatives."""

from collections.abc import Mapping
from copy import copy
from fractions import Fraction
from itertools import permutations

import flint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.unit.kernels.test_program import STATE, VARIABLES, Polynomial, polynomials, program_of
from verify import arithmetic
from verify.algebra.enclosure import Enclosures, enclose_all
from verify.algebra.ring import Poly
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.kernels.statements import EXTREMES, TANGENT
from verify.kernels.step.computation import StepRequest, computation_of, step_map_of
from verify.kernels.step.evaluator import Evaluator, _nest
from verify.kernels.step.operations import StepProgram
from verify.scenes import observables
from verify.schemes import get
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.maps.kinds.taylor_series import build

MIXED = Hamiltonian.parse("p**4/4 + p**2*q**3/3 + p*q**2/5")
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
EXPLICIT = ["lie1", "lie2", "lie3"]


# -- trials ---------------------------------------------------------------------------------------


def written(program: StepProgram) -> tuple[object, ...]:
    """All that a program is."""
    lists = [*program.ops], [*program.static], [*program.depth], [*program.loops]
    return (*lists, program.cost, dict(program._index_of), dict(program._special))


@drawn(60)
@given(st.booleans(), polynomials, polynomials)
def test_what_is_taken_back_leaves_nothing_and_is_put_back_as_it_was(
    pipelined: bool, one: Polynomial, two: Polynomial
) -> None:
    program, _, evaluator, made = program_of(pipelined, one, two)
    elements: list[Poly] = [*made]
    empty, longer = written(StepProgram()), written(program)
    tail = program.cut(StepProgram().mark())
    assert written(program) == empty
    program.put_back(tail)
    assert written(program) == longer
    mark = program.mark()
    squared = evaluator.evaluate(elements[0] * elements[1] + 5)
    assert squared < len(program.ops)
    program.cut(mark)
    assert written(program) == longer


def test_a_constant_that_is_taken_back_is_written_anew() -> None:
    program = StepProgram()
    x, mark = program.input("p", static=False), program.mark()
    one = program.constant(Fraction(1))
    assert program.mul(x, one) == x
    program.cut(mark)
    y = program.input("q", static=False)  # has the index that 1 had
    assert y == one
    assert program.mul(x, y) != x


def test_what_is_live_is_found_anew_after_something_was_taken_back() -> None:
    program = StepProgram()
    x, y = (program.input(name, static=False) for name in STATE)
    mark = program.mark()
    first = program.add(x, y)
    assert program.live([first]) == [x, y, first]
    program.cut(mark)
    second = program.mul(x, x)  # as long a program, with another last operation
    assert second == first
    assert program.live([second]) == [x, second]


def copied(evaluator: Evaluator) -> Evaluator:
    other = copy(evaluator)
    other.program, other._index_of = evaluator.program.copy(), dict(evaluator._index_of)
    return other


@drawn(60)
@given(st.booleans(), polynomials, polynomials)
def test_a_copy_grows_on_its_own(pipelined: bool, one: Polynomial, two: Polynomial) -> None:
    program, _, evaluator, made = program_of(pipelined, one, two)
    x: Poly
    y: Poly
    x, y = made
    before, other = written(program), copied(evaluator)
    assert written(other.program) == before
    ours, theirs = x * x + y, other.evaluate(x * x + y)
    assert written(program) == before
    assert evaluator.evaluate(ours) == theirs
    assert written(other.program) == written(program)


@drawn(60)
@given(st.booleans(), polynomials)
def test_no_other_way_to_sum_a_polynomial_is_cheaper(
    pipelined: bool, polynomial: Polynomial
) -> None:
    """Every way is written into a program of its own."""
    program, (index,), evaluator, (element,) = program_of(pipelined, polynomial)
    found = rank(program, index, pipelined)
    for order in permutations(range(len(STATE))):
        for name in ("_horner", "_estrin"):
            own = StepProgram()
            inputs = {n: own.input(n, static=n not in STATE) for n in VARIABLES}
            trial = Evaluator(own, evaluator.ring, inputs, pipelined)
            result = in_order(trial, element, order, name)
            assert found <= rank(own, result, pipelined), (order, name)


def rank(program: StepProgram, index: int, pipelined: bool) -> tuple[int, int]:
    costs = program.depth[index], program.cost
    return costs if pipelined else (costs[1], costs[0])


def in_order(evaluator: Evaluator, x: Poly, order: tuple[int, ...], name: str) -> int:
    """The sum with p and q, or q and p, by Horner's or Estrin's rule."""
    ring, program = evaluator.ring, evaluator.program
    used = ring.generators_in(x)
    at = {g.name: (g.index, evaluator.index_of_generator(g)) for g in used}
    present = [n for n in STATE if n in at]
    places = [at[n][0] for n in present]
    static = {i for n, (i, _) in at.items() if n not in STATE}
    terms = evaluator._collect(x, places, static)
    chosen = [k for k in order if k < len(present) and any(outer[k] for outer, _ in terms)]
    if not chosen:
        return terms[0][1] if terms else program.constant(Fraction(0))
    values = [at[present[k]][1] for k in chosen]
    return evaluator._sum_nest(_nest(terms, chosen), values, 0, getattr(evaluator, name))


# -- what is shared -------------------------------------------------------------------------------


def test_all_precisions_and_number_systems_share_a_program_and_leave_it_as_it_is() -> None:
    first = kernel_for(MIXED, "lie2", arithmetic.get("mpfr", 20), frozenset({"lambda"}))
    before, source = written(first.lowering.program), first.source
    for name, digits in (("mpfr", 50), ("mpmath", 30), ("ball", 30)):
        made = kernel_for(MIXED, "lie2", arithmetic.get(name, digits), frozenset({"lambda"}))
        assert made.lowering.program is first.lowering.program
        assert (made.source == source) == (name == "mpfr")  # guards differ
    every = {*observables.names(planar=True), EXTREMES, TANGENT}
    for asked in (frozenset(every), frozenset({"lambda", "tangent"}), frozenset()):
        other = kernel_for(MIXED, "lie2", arithmetic.get("mpfr", 20), asked)
        assert other.lowering.program is not first.lowering.program
    assert written(first.lowering.program) == before
    float64 = kernel_for(MIXED, "lie2", arithmetic.get("float64", 17), frozenset({"lambda"}))
    assert float64.lowering.program is not first.lowering.program


def test_maps_that_are_equal_and_not_the_same_share_nothing() -> None:
    """A map is known by itself: one with a planted error is another one."""
    asked = StepRequest(pipelined=False, scaled=False, tangent=False, needs=frozenset({"delta_j"}))
    one, two = (build(TaylorSeries(2), MIXED) for _ in range(2))
    assert computation_of(one, asked) is computation_of(one, asked)
    assert computation_of(one, asked) is not computation_of(two, asked)
    assert step_map_of(MIXED, "lie2") is step_map_of(MIXED, "lie2")


# -- what bounds derivatives ----------------------------------------------------------------------


@pytest.mark.parametrize("scheme", EXPLICIT)
@pytest.mark.parametrize("h", [MIXED, PENDULUM], ids=["polynomial", "pendulum"])
def test_elements_that_were_read_once_have_the_same_balls(h: Hamiltonian, scheme: str) -> None:
    step = get(scheme).step_map(h).flat
    first, second = step.jacobian
    elements = [step.elements[0], *first, *second, first[0], step.ring.zero]
    made = Enclosures(step.ring, elements)
    with working_precision(96):
        for at in (Fraction(1, 3), Fraction(5, 2)):
            box = {n: rational_ball(at) + flint.arb(0, 0.01) for n in ("p", "q", "h")}
            expected = enclose_all(step.ring, elements, box)
            assert made.enclose_over(box) is not None
            assert list(map(str, made.enclose_over(box) or ())) == list(map(str, expected or ()))


def test_where_an_element_may_be_undefined_there_are_no_balls() -> None:
    step = get("lie1").step_map(Hamiltonian.parse("log(q) + p**2/2")).flat
    made = Enclosures(step.ring, [step.elements[0]])
    with working_precision(96):
        box: Mapping[str, flint.arb] = {n: flint.arb(0, 1) for n in VARIABLES}
        assert made.enclose_over(box) is None
        assert made.enclose_over({**box, "q": flint.arb(3, 1)}) is not None
