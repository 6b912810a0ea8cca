"""Straight-line programs and the kernels made of them: exact, without repetition, without ballast.

The oracle runs a program's operations one by one with Fractions, and evaluates the polynomial by
its definition, the sum of coefficient × monomial.
"""

import ast
import re
from collections.abc import Mapping
from fractions import Fraction
from functools import reduce
from math import prod
from operator import add, mul, sub

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify import arithmetic
from verify.algebra.embedding import embed
from verify.algebra.formula import symbol
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.statements import EXTREMES, TANGENT
from verify.kernels.step.evaluator import Evaluator
from verify.kernels.step.kinds import Root
from verify.kernels.step.operations import StepProgram
from verify.scenes import observables

VARIABLES = ("p", "q", "h", "delta")
STATE = ("p", "q")
DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4")
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
MIXED = Hamiltonian.parse("p**4/4 + p**2*q**3/3 + delta*p*q**2 + q**2")

rationals = st.fractions(min_value=-9, max_value=9, max_denominator=12)
monomials = st.tuples(*[st.integers(0, 5)] * len(VARIABLES))
polynomials = st.dictionaries(monomials, rationals.filter(bool), max_size=12)
points = st.fixed_dictionaries(dict.fromkeys(VARIABLES, rationals))
Polynomial = Mapping[tuple[int, ...], Fraction]


def value_of(polynomial: Polynomial, at: Mapping[str, Fraction]) -> Fraction:
    """The polynomial at a point by its definition."""
    return sum(
        (c * prod(at[n] ** k for n, k in zip(VARIABLES, m, strict=True))
         for m, c in polynomial.items()),
        Fraction(0),
    )  # fmt: skip


def results(program: StepProgram, at: Mapping[str, Fraction]) -> list[Fraction]:
    """The value of every operation, by running them in order."""
    done: list[Fraction] = []
    binary = {"add": add, "sub": sub, "mul": mul}
    for op in program.ops:
        args = [done[a] for a in op.args]
        if op.kind == "input":
            done.append(at[op.name])
        elif op.kind == "const":
            done.append(op.value)
        elif op.kind == "neg":
            done.append(-args[0])
        else:
            done.append(reduce(binary[op.kind], args))
    return done


def program_of(
    pipelined: bool, *polynomials: Polynomial
) -> tuple[StepProgram, list[int], Evaluator, list[object]]:
    """A program for the polynomials; p and q vary, h and delta are fixed in the loop."""
    symbols = [symbol(name) for name in VARIABLES]
    expressions = [
        sympy.Add(
            *(
                sympy.Rational(c.numerator, c.denominator)
                * sympy.Mul(*(s**k for s, k in zip(symbols, m, strict=True)))
                for m, c in polynomial.items()
            )
        )
        for polynomial in polynomials
    ]
    ring, elements = embed(expressions, VARIABLES)
    program = StepProgram()
    inputs = {n: program.input(n, static=n not in STATE) for n in VARIABLES}
    evaluator = Evaluator(program, ring, inputs, pipelined)
    return program, [evaluator.evaluate(x) for x in elements], evaluator, elements


@drawn(150)
@given(st.booleans(), polynomials, polynomials, points)
def test_a_program_evaluates_to_its_polynomials_exactly(
    pipelined: bool, one: Polynomial, two: Polynomial, at: dict[str, Fraction]
) -> None:
    program, (first, second), _, _ = program_of(pipelined, one, two)
    found = results(program, at)
    assert found[first] == value_of(one, at)
    assert found[second] == value_of(two, at)


@drawn(100)
@given(st.booleans(), polynomials, polynomials)
def test_no_operation_occurs_twice(pipelined: bool, one: Polynomial, two: Polynomial) -> None:
    program, _, _, _ = program_of(pipelined, one, two)
    forms = [
        (op.kind, tuple(sorted(op.args)) if op.kind in ("add", "mul") else repr(op))
        for op in program.ops
    ]
    assert len(set(forms)) == len(forms)
    for op in program.ops:
        if op.kind in ("add", "mul"):
            args = [program.ops[a] for a in op.args]
            constants = [x.value for x in args if x.kind == "const"]
            assert 0 not in constants, op
            assert op.kind == "add" or 1 not in constants, op


def test_a_sum_and_a_product_are_one_operation_in_either_order() -> None:
    program = StepProgram()
    x, y = (program.input(n, static=False) for n in STATE)
    assert program.add(x, y) == program.add(y, x)
    assert program.mul(x, y) == program.mul(y, x)
    assert program.add(x, program.neg(y)) != program.add(y, program.neg(x))
    assert len(program.ops) == 2 + 2 + 2 + 2  # inputs, sum and product, negatives, differences


@drawn(50)
@given(st.booleans(), polynomials)
def test_a_polynomial_evaluated_again_adds_nothing(pipelined: bool, polynomial: Polynomial) -> None:
    program, (index,), evaluator, (element,) = program_of(pipelined, polynomial)
    size = len(program.ops)
    assert evaluator.evaluate(element) == index
    assert len(program.ops) == size


@drawn(100)
@given(st.booleans(), polynomials)
def test_what_is_static_is_what_does_not_depend_on_p_and_q(
    pipelined: bool, polynomial: Polynomial
) -> None:
    program, _, _, _ = program_of(pipelined, polynomial)
    depends: list[bool] = []
    for op in program.ops:
        state = op.kind == "input" and op.name in STATE
        depends.append(state or any(depends[a] for a in op.args))
    assert program.static == [not d for d in depends]


@pytest.mark.parametrize("n", range(65))
def test_a_power_is_right_and_takes_few_products(n: int) -> None:
    program = StepProgram()
    x = program.input("p", static=False)
    index = program.power(x, n)
    assert results(program, {"p": Fraction(-3, 2)})[index] == Fraction(-3, 2) ** n
    assert sum(op.kind == "mul" for op in program.ops) <= 2 * max(1, n).bit_length()


# -- kernels --------------------------------------------------------------------------------------


def kernel(hamiltonian: Hamiltonian, scheme: str, *asked: str, name: str = "mpmath") -> Kernel:
    return kernel_for(hamiltonian, scheme, arithmetic.get(name, 17), frozenset(asked))


def words(source: str) -> set[str]:
    return set(re.findall(r"[A-Za-z_]\w*", source))


OBSERVABLES = (*observables.names(planar=True), EXTREMES, TANGENT)
OWN_NAMES = {
    "delta_j_max": {"top", "size"},
    "mse": {"mse"},
    "lambda": {"lam"},
    "lambda_max": {"lam", "lam_top", "lam_size"},
    "lambda_plain": {"plain"},
    "energy_error": set(),
    "energy_error_max": {"e0_low", "e0_high"},
    "extremes": {"dj_low", "dj_high", "lam_low", "lam_high", "lam"},
    "tangent": {"growth", "m_pp", "q_low"},
}


@pytest.mark.parametrize("name", arithmetic.names())
@pytest.mark.parametrize("observable", [*OBSERVABLES, None], ids=str)
def test_a_kernel_holds_nothing_that_was_not_asked_for(observable: str | None, name: str) -> None:
    asked = {observable} if observable else set()
    made = kernel(DUFFING, "lie2", *asked, name=name)
    own = OWN_NAMES.get(observable or "", set())
    foreign = set().union(*OWN_NAMES.values()) - own
    assert own <= words(made.source)
    assert not foreign & words(made.source)
    without = (None, "lambda_plain", "energy_error", "energy_error_max", "tangent")
    assert ("dj" in words(made.source)) == (observable not in without)


@pytest.mark.parametrize("name", arithmetic.names())
@pytest.mark.parametrize("h", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
def test_a_function_of_the_state_changes_no_line_of_what_else_was_asked_for(
    h: Hamiltonian, name: str
) -> None:
    others = ("delta_j_max", "mse", "lambda")
    plain = kernel(h, "lie2", *others, name=name).source.splitlines()
    more = kernel(h, "lie2", *others, "energy_error_max", name=name).source.splitlines()
    rest = iter(more[1:])
    inside = [line for line in plain[1:] if "return" not in line]
    # Its own names are numbers behind those of the others, so that these keep theirs.
    assert all(any(line == other for other in rest) for line in inside)
    assert len(more) < 1.6 * len(plain)


def test_the_table_above_covers_every_observable() -> None:
    assert set(OWN_NAMES) == set(OBSERVABLES)


@pytest.mark.parametrize("scheme", ["lie1", "lie2", "lie3", "lie4"])
@pytest.mark.parametrize("h", [DUFFING, MIXED], ids=["duffing", "mixed"])
def test_a_polynomial_hamiltonian_calls_no_function(h: Hamiltonian, scheme: str) -> None:
    tree = ast.parse(kernel(h, scheme, *OBSERVABLES).source)
    called = {n.func.id for n in ast.walk(tree) if isinstance(n, ast.Call)}
    assert called <= {"range", "abs", "approx"}
    assert not [n for n in ast.walk(tree) if isinstance(n, ast.Div | ast.Pow)]


def test_cos_and_sin_of_one_angle_are_one_call_where_the_arithmetic_has_that() -> None:
    source = kernel(PENDULUM, "lie3", *OBSERVABLES).source
    assert source.count("cos_sin(") == 1
    assert not re.search(r"\b(cos|sin)\(", source)


@pytest.mark.parametrize("scheme", ["lie2", "lie3", "symplectic-euler"])
@pytest.mark.parametrize("h", [DUFFING, PENDULUM], ids=["duffing", "pendulum"])
def test_every_value_that_is_computed_is_used(h: Hamiltonian, scheme: str) -> None:
    tree = ast.parse(kernel(h, scheme, "lambda", "lambda_plain").source)
    names = [n for n in ast.walk(tree) if isinstance(n, ast.Name)]
    stored = {n.id for n in names if isinstance(n.ctx, ast.Store)}
    loaded = {n.id for n in names if isinstance(n.ctx, ast.Load)}
    assert stored - loaded <= {"k"}


@pytest.mark.parametrize("scheme", ["lie2", "lie4"])
def test_before_the_loop_stands_only_what_does_not_depend_on_the_state(scheme: str) -> None:
    function = ast.parse(kernel(MIXED, scheme, *OBSERVABLES).source).body[0]
    assert isinstance(function, ast.FunctionDef)
    loop = next(n for n in function.body if isinstance(n, ast.For))
    before = function.body[: function.body.index(loop)]
    assert before, "h and delta make coefficients that are the same at every step"
    assert not {n.id for s in before for n in ast.walk(s) if isinstance(n, ast.Name)} & set(STATE)


@pytest.mark.parametrize("scheme", ["lie2", "lie3", "symplectic-euler"])
def test_a_vanishing_parameter_leaves_no_trace(scheme: str) -> None:
    without = kernel(DUFFING.with_values({"delta": 0}).with_symbols(), scheme, *OBSERVABLES)
    harmonic = kernel(Hamiltonian.parse("p**2/2 + q**2/2"), scheme, *OBSERVABLES)
    assert without.parameters == ()
    assert "x0" not in words(without.source)
    assert without.source == harmonic.source
    assert "x0" in words(kernel(DUFFING, scheme, *OBSERVABLES).source)


def test_where_area_is_preserved_nothing_of_delta_j_is_computed() -> None:
    made = kernel(DUFFING, "symplectic-euler", "lambda", "mse")
    bare = kernel(DUFFING, "symplectic-euler")
    products = [sum(isinstance(n, ast.Mult) for n in ast.walk(ast.parse(k.source)))
                for k in (made, bare)]  # fmt: skip
    assert products[0] - products[1] <= 2  # lam * dj and dj * dj with dj = 0


def test_a_roots_degree_is_no_operand() -> None:
    """It was taken for one: the root of degree 1 of the results number x and 2."""
    program = StepProgram()
    x = program.input("x", static=False)
    with pytest.raises(TypeError):
        program.call("root", x, 2)  # type: ignore[call-arg, arg-type]
    assert program.ops[program.root(x, 2)] == Root((x,), 2)
    assert program.root(x, 2) != program.root(x, 3)
