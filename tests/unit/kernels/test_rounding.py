"""Rounding counted: bounds that hold what a run of few bits gets wrong, for every operation."""

from fractions import Fraction
from typing import Any

import flint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import polynomials
from verify.arithmetic.arb import bounds, rational_ball
from verify.arithmetic.systems import mpfr
from verify.functions import in_rings
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import KernelWriter
from verify.kernels.rounding import PRECISION_BITS, RoundedValue, analyse, rounding_of
from verify.kernels.step.lowering import Lowering
from verify.kernels.step.operations import StepProgram
from verify.schemes import get

BITS = 24
COARSE, FINE = mpfr.at_bits(BITS), mpfr.at_bits(400)
Box = dict[str, tuple[Fraction, Fraction]]


def counted(program: StepProgram, root: int, box: Box) -> Fraction | None:
    """The bound of the value's error in COARSE, for exact inputs all over the box."""
    with flint.ctx.workprec(PRECISION_BITS):
        inputs = {
            name: RoundedValue(rational_ball(low).union(rational_ball(high)), flint.arb(0))
            for name, (low, high) in box.items()
        }
        live = Lowering(program, ()).live([root])
        found = analyse(program, live, inputs, rounding_of(COARSE))
        return None if found is None else bounds(found[root].error)[1]


def value(program: StepProgram, root: int, at: dict[str, Fraction], made: Any) -> Fraction:
    """The program's value at a point in that arithmetic, operation by operation."""
    found: list[Any] = []
    f = made.functions
    with made.context():
        for op in program.ops[: root + 1]:
            x = [found[i] for i in op.args]
            match op.kind:
                case "input":
                    found.append(made.number(at[op.name]))
                case "const":
                    found.append(made.number(op.value))
                case "pi":
                    found.append(f["pi"])
                case "add":
                    found.append(x[0] + x[1])
                case "sub":
                    found.append(x[0] - x[1])
                case "mul":
                    found.append(x[0] * x[1])
                case "neg":
                    found.append(-x[0])
                case "inverse":
                    found.append(1 / x[0])
                case "root":
                    found.append(f["root"](x[0], op.degree))
                case "call":
                    found.append(f[op.function.name](x[0]))
    return made.exact(found[root])  # type: ignore[no-any-return]


def binary(low: int, high: int) -> st.SearchStrategy[Fraction]:
    """Numbers that COARSE has exactly."""
    return st.integers(low * 2**12, high * 2**12).map(lambda n: Fraction(n, 2**12))


def delta_j(text: str) -> tuple[StepProgram, int]:
    step_map = get("lie2").step_map(Hamiltonian.parse(text))
    writer = KernelWriter(step_map, COARSE, frozenset({"lambda"}), compensated=False)
    return writer.program, writer.computation.outputs["dj"]


@drawn(100)
@given(polynomials(degree=5), binary(-2, 2), binary(-2, 2), binary(-2, 2), binary(-2, 2))
def test_the_bound_of_a_delta_j_holds_all_over_the_box(
    text: str, p: Fraction, q: Fraction, p2: Fraction, q2: Fraction
) -> None:
    program, root = delta_j(text)
    h = Fraction(1, 64)
    box = {"p": (min(p, p2), max(p, p2)), "q": (min(q, q2), max(q, q2)), "h": (h, h)}
    bound = counted(program, root, box)
    assert bound is not None
    for at in ({"p": p, "q": q, "h": h}, {"p": p2, "q": q2, "h": h}):
        error = abs(value(program, root, at, COARSE) - value(program, root, at, FINE))
        assert error <= bound


FUNCTIONS = [*in_rings(), "inverse", "root"]


def applied(program: StepProgram, kind: str, x: int, degree: int) -> int:
    """A function's value in the program; `degree`: of a root."""
    if kind == "root":
        return program.root(x, degree)
    return program.inverse(x) if kind == "inverse" else program.call(in_rings()[kind], x)


@pytest.mark.parametrize("kind", FUNCTIONS)
@drawn(60)
@given(x=binary(1, 3), y=binary(1, 3), width=binary(0, 1), sign=st.sampled_from([1, -1]))
def test_the_bound_of_every_function_holds(
    kind: str, x: Fraction, y: Fraction, width: Fraction, sign: int
) -> None:
    """f(x (1/3 + y)): an argument that is rounded three times before the function is."""
    program = StepProgram()
    inputs = [program.input(name, static=False) for name in "xy"]
    third = program.constant(Fraction(1, 3))
    argument = program.mul(inputs[0], program.add(third, inputs[1]))
    if kind not in ("log", "root") and sign < 0:
        argument = program.neg(argument)
    root = applied(program, kind, argument, 3)
    box = {"x": (x, x + width), "y": (y, y + width)}
    bound = counted(program, root, box)
    assert bound is not None
    errors = []
    for at in ({"x": x, "y": y}, {"x": x + width, "y": y}, {"x": x, "y": y + width}):
        true = value(program, root, at, FINE)
        errors.append(abs(value(program, root, at, COARSE) - true))
    assert max(errors) <= bound
    if width == 0:
        assert bound <= 600 * Fraction(2, 2**BITS) * max(1, abs(true)), "and is no idle bound"


@pytest.mark.parametrize("kind", FUNCTIONS)
@pytest.mark.parametrize("x", ["1/50", "1/7", "9/10", "3", "-1/50", "-2"])
@pytest.mark.parametrize("share", ["1/3", "1/10000"])
def test_what_an_argument_is_off_is_magnified_by_the_functions_slope(
    kind: str, x: str, share: str
) -> None:
    """Far above rounding, which is not counted here; below 1 slopes are steep."""
    middle = Fraction(x)
    if kind in ("log", "root") and middle < 0:
        return
    off = abs(middle) * Fraction(share)
    program = StepProgram()
    root = applied(program, kind, program.input("x", static=False), 3)
    with flint.ctx.workprec(PRECISION_BITS):
        given = {"x": RoundedValue(rational_ball(middle), rational_ball(off))}
        found = analyse(program, [0, root], given, lambda *_: flint.arb(0))
        assert found is not None
        bound = bounds(found[root].error)[1]
    true = value(program, root, {"x": middle}, FINE)
    ends = (abs(value(program, root, {"x": y}, FINE) - true) for y in (middle - off, middle + off))
    largest = max(ends)
    assert largest <= bound * (1 + Fraction(1, 2**60))
    flat = kind == "cosh" or (kind in in_rings() and in_rings()[kind].lipschitz is not None)
    limit = None if flat else 4
    assert limit is None or bound <= limit * largest, "and is near what may be reached"


def test_there_is_no_bound_where_the_value_is_not_defined_all_over_the_box() -> None:
    program = StepProgram()
    x = program.input("x", static=False)
    crossing: Box = {"x": (Fraction(-1), Fraction(1))}
    for kind in ("inverse", "log", "root"):
        assert counted(program, applied(program, kind, x, 2), crossing) is None
    square = program.add(program.constant(Fraction(1)), program.mul(x, x))
    inverse = program.inverse(square)
    assert counted(program, inverse, crossing) is not None, "1 + x² ≥ 1"


@pytest.mark.parametrize("first", [True, False], ids=["first", "second"])
def test_a_factor_carries_the_others_error_whichever_comes_first(first: bool) -> None:
    """x − 1/3 next to 1/3 is little but the constant's rounding, and a product keeps that."""
    program = StepProgram()
    if first:
        z = program.input("z", static=False)
    x = program.input("x", static=False)
    near = program.add(x, program.neg(program.constant(Fraction(1, 3))))
    if not first:
        z = program.input("z", static=False)
    root = program.mul(near, z)
    beside = COARSE.exact(COARSE.number(Fraction(1, 3) + Fraction(1, 3 * 2**22)))
    at = {"x": beside, "z": Fraction(7)}  # inputs are exact
    bound = counted(program, root, {n: (v, v) for n, v in at.items()})
    error = abs(value(program, root, at, COARSE) - value(program, root, at, FINE))
    assert bound is not None
    assert error <= bound <= 8 * error
