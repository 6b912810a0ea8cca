"""The Jacobian that a step's own operations give, where equations are solved too, against one of
differences in mpmath."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.stepping.steps_by_differences import (
    Field,
    State,
    Step,
    explicit_midpoint,
    field,
    implicit_midpoint,
    jacobian,
    lie,
    moved,
    mp,
    rk4,
    verlet,
)
from verify.arithmetic.systems import mpfr
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.computation import StepRequest, computation_of
from verify.kernels.step.lowering import Lowering, newton_constants
from verify.schemes import get

PLANE = "p**2*(1 + q**2)/2 + q**4/4 + p*q/3"
COUPLED = "(p1*q2 + p2)**2/2 + p1**2/2 + q1*q2**2/3 + q1**2"
SEPARATE = "p1**2/2 + p2**4/4 + q1**2*q2 + q2**2/3"
ENERGIES: dict[str, Callable[..., Any]] = {
    PLANE: lambda p, q: p**2 * (1 + q**2) / 2 + q**4 / 4 + p * q / 3,
    COUPLED: lambda p1, p2, q1, q2: (p1 * q2 + p2) ** 2 / 2 + p1**2 / 2 + q1 * q2**2 / 3 + q1**2,
    SEPARATE: lambda p1, p2, q1, q2: p1**2 / 2 + p2**4 / 4 + q1**2 * q2 + q2**2 / 3,
}
POINT = [Fraction(n, d) for n, d in ((3, 7), (-2, 5), (5, 8), (4, 9))]
H, DIGITS, ITERATIONS = Fraction(1, 50), 60, 60
ASKED = StepRequest(pipelined=False, scaled=False, tangent=False, slopes=True)


def number(x: Fraction) -> Any:
    return mp.mpf(x.numerator) / x.denominator


def implicit_euler(f: Field, z: State, h: Any) -> State:
    """p' and then q' at (p', q)."""
    n, after = len(z) // 2, z
    for _ in range(ITERATIONS):
        after = moved(z, (h, f([*after[:n], *z[n:]])))
    return after


def gauss4(f: Field, z: State, h: Any) -> State:
    root = mp.sqrt(3) / 6
    one = other = f(z)
    for _ in range(ITERATIONS):
        quarter = mp.mpf(1) / 4
        first = moved(z, (h * quarter, one), (h * (quarter - root), other))
        second = moved(z, (h * (quarter + root), one), (h * quarter, other))
        one, other = f(first), f(second)
    return moved(z, (h / 2, one), (h / 2, other))


STEPS: dict[str, Step] = {
    "lie2": lie(2), "rk4": rk4, "explicit-midpoint": explicit_midpoint,
    "implicit-midpoint": implicit_midpoint, "implicit-symplectic-euler": implicit_euler,
    "gauss4": gauss4,
}  # fmt: skip
CASES = [
    *((text, name) for text in (PLANE, COUPLED) for name in STEPS),
    *((SEPARATE, name) for name in ("stormer-verlet", "implicit-midpoint")),
]


def slopes_of(text: str, name: str) -> list[Fraction]:
    """J − 1 at `POINT`, row by row, by the step's program."""
    made = computation_of(get(name).step_map(Hamiltonian.parse(text)), ASKED)
    arithmetic, names = mpfr.make(DIGITS), made.coordinates
    roots = [x for row in made.slopes for x in row]
    lowering = Lowering(made.program, arithmetic.functions, guard=arithmetic.guard)
    static, dynamic = lowering.lines(roots)
    shown = ", ".join(map(lowering.name, roots))
    lines = [f"def at({', '.join(names)}, h):", *static, "for _ in range(1):"]
    lines += [*(f"    {line}" for line in dynamic), f"return {shown},"]
    scope = {
        **arithmetic.functions,
        **lowering.named_constants(arithmetic.number),
        **newton_constants(arithmetic.bits, arithmetic.number),
    }
    function = arithmetic.compile("\n    ".join(lines) + "\n", "at", scope)
    with arithmetic.context():
        found = function(*map(arithmetic.number, (*POINT[: len(names)], H)))
    return [arithmetic.exact(x) for x in found]


def apart(text: str, name: str, step: Step) -> float:
    size = len(Hamiltonian.parse(text).coordinates)
    columns = jacobian(step, ENERGIES[text], list(map(number, POINT[:size])), number(H))
    true = [columns[b][a] - (a == b) for a in range(size) for b in range(size)]
    pairs = zip(slopes_of(text, name), true, strict=True)
    return float(max(abs(number(x) - y) for x, y in pairs))


@pytest.mark.sample(4)
@pytest.mark.parametrize(("text", "name"), CASES)
def test_the_jacobian_is_that_of_differences(text: str, name: str) -> None:
    step = verlet if name == "stormer-verlet" else STEPS[name]
    assert apart(text, name, step) < 1e-50


@pytest.mark.parametrize("text", [PLANE, COUPLED])
def test_an_error_of_a_coefficient_is_seen_in_it(text: str) -> None:
    """The planted error: a stage at 1/2 + 10⁻²⁰ of the way."""

    def planted(f: Field, z: State, h: Any) -> State:
        after = z
        for _ in range(ITERATIONS):
            share = mp.mpf(1) / 2 + mp.mpf(10) ** -20
            after = moved(z, (h, f([x + share * (y - x) for x, y in zip(z, after, strict=True)])))
        return after

    assert 1e-26 < apart(text, "implicit-midpoint", planted) < 1e-18


def test_the_energies_are_those_of_the_formulas() -> None:
    """By the slopes of both at the point."""
    for text, energy in ENERGIES.items():
        hamiltonian = Hamiltonian.parse(text)
        size = len(hamiltonian.coordinates)
        mine = field(energy)(list(map(number, POINT[:size])))
        n = size // 2
        p, q = (list(map(float, part)) for part in (POINT[:n], POINT[n:size]))
        theirs = hamiltonian.gradient()(*((p[0], q[0]) if n == 1 else (p, q)))
        flat = [*theirs] if n == 1 else [*theirs[0], *theirs[1]]
        wanted = [*(-x for x in flat[n:]), *flat[:n]]
        assert all(abs(float(x) - y) < 1e-12 for x, y in zip(mine, wanted, strict=True))
