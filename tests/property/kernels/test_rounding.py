"""The rounding that is counted for each operation of a kernel contains the rounding that it makes.

A kernel's own program is run in the arithmetic at a state in a box, and every operation's value is
held against a ball for that operation at the exact inputs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import polynomials, rationals, trigonometric
from verify.arithmetic.arb import bounds, is_representable, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems import fixed, mpfr, mpmath
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.rounding import (
    PRECISION_BITS,
    Ball,
    RoundedValue,
    Rounding,
    analyse,
    rounding_of,
)
from verify.kernels.step.kinds import Op
from verify.kernels.step.lowering import Lowering
from verify.kernels.stepping import KernelRun


def values(kernel: Kernel, arithmetic: Arithmetic, inputs: dict[str, Any]) -> dict[int, Fraction]:
    """What each operation of the kernel gives."""
    live = kernel.lowering.live(kernel.roots)
    program = kernel.lowering.program
    static, dynamic = Lowering(program, arithmetic.functions).lines(kernel.roots)
    found = [index for index in live if program.ops[index].kind != "const"]
    lines = [*static, *dynamic, "return " + ", ".join(f"v{index}" for index in found) + ", h"]
    names = {**arithmetic.functions, **kernel.lowering.named_constants(arithmetic.number)}
    source = "".join([f"def f({', '.join(inputs)}):\n", *(f"    {line}\n" for line in lines)])
    run = arithmetic.compile(source, "f", names)
    with arithmetic.context():
        given = run(*(arithmetic.number(x) for x in inputs.values()))
    held = {i: op.value for i in live if (op := program.ops[i]).kind == "const"}
    exact = {i: arithmetic.exact(arithmetic.number(x)) for i, x in held.items()}
    return exact | {i: arithmetic.exact(x) for i, x in zip(found, given, strict=False)}


def exactly(op: Op, args: Sequence[Ball], inputs: Mapping[str, Fraction]) -> Ball:
    """The operation's value as a ball."""
    match op.kind:
        case "input":
            return rational_ball(inputs[op.name])
        case "const":
            return rational_ball(op.value)
        case "pi":
            return flint.arb.pi()
        case "add":
            return args[0] + args[1]
        case "sub":
            return args[0] - args[1]
        case "mul":
            return args[0] * args[1]
        case "neg":
            return -args[0]
        case "inverse":
            return 1 / args[0]
        case "root":
            return args[0].root(op.degree)
        case "call":
            return getattr(args[0], op.function.name)()
    raise AssertionError(op.kind)


@dataclass(frozen=True)
class Tried:
    """A kernel's program run at a state: its values, at inputs in the arithmetic's numbers."""

    kernel: Kernel
    arithmetic: Arithmetic
    inputs: dict[str, Fraction]
    state: dict[str, Fraction]
    values: dict[int, Fraction]

    @property
    def ops(self) -> dict[int, Op]:
        program = self.kernel.lowering.program
        return {i: program.ops[i] for i in self.kernel.lowering.live(self.kernel.roots)}

    def counted(self, width: Fraction) -> dict[int, Fraction] | None:
        """The bound of each operation's error, for all states so near; None where there is none."""
        exact, number = self.arithmetic.exact, self.arithmetic.number
        with working_precision(PRECISION_BITS):
            around = rational_ball(width) * flint.arb(0, 1)
            given = {
                n: RoundedValue(rational_ball(x), rational_ball(abs(exact(number(x)) - x)))
                for n, x in self.inputs.items()
            } | {
                n: RoundedValue(rational_ball(x) + around, flint.arb(0))
                for n, x in self.state.items()
            }
            rounding = rounding_of(self.arithmetic)
            found = analyse(self.kernel.lowering.program, [*self.ops], given, rounding)
            if found is None or not all(is_representable(x.error) for x in found.values()):
                return None  # a bound that is too large to be a number is none
            return {i: bounds(x.error)[1] for i, x in found.items()}

    def errors(self) -> dict[int, Fraction]:
        """How far each operation's value is, at least, from its value at the exact inputs."""
        found: dict[int, Ball] = {}
        with working_precision(2 * self.arithmetic.bits + 200):
            for i, op in self.ops.items():
                found[i] = exactly(op, [found[a] for a in op.args], self.inputs | self.state)
            return {i: bounds(abs(found[i] - rational_ball(x)))[0] for i, x in self.values.items()}

    def own(self, count: Rounding) -> dict[int, tuple[Fraction, Fraction]]:
        """What each operation adds: how far its value is from that of the arguments that it had,
        and what is counted."""
        made = {}
        with working_precision(2 * self.arithmetic.bits + 200):
            for i, true in self.true().items():
                apart = abs(true - rational_ball(self.values[i]))
                counted = count(self.ops[i], abs(true))
                if is_representable(apart) and is_representable(
                    counted
                ):  # else they are no numbers here
                    made[i] = bounds(apart)[0], bounds(counted)[1]
        return made

    def true(self) -> dict[int, Ball]:
        """Each operation's value at the arguments that it had."""
        with working_precision(2 * self.arithmetic.bits + 200):
            return {
                i: exactly(op, [rational_ball(self.values[a]) for a in op.args], {})
                for i, op in self.ops.items()
                if op.kind != "input"
            }


def tried(text: str, scheme: str, arithmetic: Arithmetic, at: Sequence[Fraction]) -> Tried | None:
    """None where a function has no value there, or the arithmetic does not have it."""
    q, p, h, a = at
    parameters = {"a": a} if "a*" in text or "/a" in text else {}
    observables = frozenset({"lambda", "mse", "tangent"})
    start = {"q": q, "p": p, "h": h}
    try:
        kernel_run = KernelRun(
            Hamiltonian.parse(text, parameters), scheme, start, 1, observables, 0
        )
        kernel = kernel_for(kernel_run.hamiltonian, scheme, arithmetic, observables)
        inputs = kernel_run.inputs(kernel, 0)
        state = {n: arithmetic.exact(arithmetic.number(x)) for n, x in (("p", p), ("q", q))}
        found = values(kernel, arithmetic, inputs | state)
    except (InputError, UnsupportedError, ArithmeticError, ValueError):
        return None
    made = Tried(kernel, arithmetic, inputs, state, found)
    if arithmetic.absolute and not all(abs(x) < 2**14 for x in made.true().values()):
        return None  # beyond the range, where what is left of a number is kept; a run watches it
    return made


INVOLVED = ["a*p**2/2 + exp(-q**2)", "sqrt(1 + p**2)/a + log(2 + q**2)", "p**2/(2 + q**2) + pi*q",
            "cosh(p) + sinh(a*q)", "(3 + q**2 + p)**(1/3) + atan(q)",
            "p**2/2 + 1/(2 - q**2)", "1/q + p**2", "log(q) + p", "sqrt(a*q) + p**2"]  # fmt: skip
hamiltonians = st.one_of(
    polynomials(degree=5, most_terms=3),
    st.builds("a*({})".format, polynomials(degree=4, most_terms=3)),
    trigonometric(most_terms=1),
    st.sampled_from(INVOLVED),
)


def one_of(*numbers: str) -> st.SearchStrategy[Fraction]:
    return st.sampled_from([Fraction(x) for x in numbers])


# Denominators, and what is under logarithms and roots, well below 1 as well as above.
near = one_of("1.41", "-1.414", "1e-3", "-1/70", "1/9")
places = st.one_of(rationals(5), near)
points = st.tuples(places, rationals(5), one_of("1/7", "3", "1e-9"), rationals(30))
widths = one_of("0", "1e-6", "1/10")
schemes = st.sampled_from(["lie1", "lie2", "symplectic-euler"])


def check(text: str, scheme: str, arithmetic: Arithmetic, at: Any, width: Fraction) -> None:
    found = tried(text, scheme, arithmetic, at)
    assume(found is not None)
    assert found
    for index, (error, counted) in found.own(rounding_of(arithmetic)).items():
        assert error <= counted, f"v{index}, {found.ops[index].kind}, is rounded more: {error}"
    every = found.counted(width)
    for index, error in found.errors().items() if every else ():
        assert error <= every[index], f"v{index}, {found.ops[index].kind}, is off more: {error}"


@drawn(80)
@given(hamiltonians, schemes, st.integers(4, 200), st.booleans(), points, widths)
def test_floating_point_rounds_no_more_than_is_counted(
    text: str, scheme: str, bits: int, other: bool, at: Any, width: Fraction
) -> None:
    check(text, scheme, (mpmath if other else mpfr).at_bits(bits), at, width)


@pytest.mark.left_to_ci
@drawn(10)
@given(hamiltonians, schemes, st.sampled_from([112, 176, 304]), points, widths)
def test_fixed_point_rounds_no_more_than_is_counted(
    text: str, scheme: str, bits: int, at: Any, width: Fraction
) -> None:
    check(text, scheme, fixed.at_bits(bits), at, width)


AT = (Fraction(11, 7), Fraction(-4, 3), Fraction(1, 7), Fraction(5, 3))
ALL = "p**4/7 + a*cos(q) + sqrt(1 + q**2) + exp(q/3) + 1/(3 + p**2) + pi*q**3"
MORE = "cosh(p) + sinh(a*q) + q*log(3 + q**2) + sin(p)"
FLOATING, WIDE = mpfr.at_bits(60), fixed.at_bits(112)
KINDS = [
    *((ALL, kind, FLOATING) for kind in ("add", "mul", "const", "sin", "cos", "root")),
    *((ALL, kind, FLOATING) for kind in ("inverse", "exp", "pi")),
    *((MORE, kind, FLOATING) for kind in ("sinh", "cosh", "log")),
    *((ALL, kind, WIDE) for kind in ("mul", "const", "sin", "cos", "root", "inverse", "exp", "pi")),
    *((MORE, kind, WIDE) for kind in ("sinh", "cosh", "log")),
]


def _shown(x: Any) -> str:
    return {ALL: "", MORE: ""}.get(x, x) if isinstance(x, str) else str(x.name)


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("text", "kind", "arithmetic"), KINDS, ids=_shown)
def test_an_operation_that_is_taken_for_exact_is_caught(
    text: str, kind: str, arithmetic: Arithmetic
) -> None:
    found = tried(text, "lie1", arithmetic, AT)
    assert found
    count = rounding_of(arithmetic)

    def lying(op: Op, size: Ball) -> Ball:
        name = op.function.name if op.kind == "call" else op.kind
        return flint.arb(0) if name == kind else count(op, size)

    assert all(error <= counted for error, counted in found.own(count).values())
    assert any(error > counted for error, counted in found.own(lying).values())
