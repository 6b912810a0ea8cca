"""Lies planted in the certificate, on orbits where each of them matters: every one is caught.

The orbits are such that the bound is nearly reached: in `LOST` an increment just below half a unit
is lost at every step, so that each rounding is as large as rounding can be, and all of one sign.
That is where a bound that is half of what it should be shows. Its twin is in the same test: without
the lie what is certified holds.

Of p, q and max |ΔJ| the bounds so come within a few per cent of the error. Those of Λ and MSE do
not, for any orbit: errors of the state that are made at every step grow at least like k, and the
bound takes the greatest for all of them, which is twice their mean; there the planted lies are
larger. Two lies cannot show in any orbit. In floating point a product's rounding hides behind those
of the sums, since it is like a change in the last bit of a factor, which was rounded when it was
stored; `tests/property/kernels/test_rounding.py` sees it operation by operation. And the rounding
of the tangent map, ρ, enters by e^Q with Q about 10⁻¹²; `test_a_posteriori_edges.py` counts it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from typing import Any

import flint
import pytest

from tests.helpers.exact_orbits import Case, True_, case, enclosed_finely
from verify import arithmetic as systems
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import fixed, mpfr
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels import rounding
from verify.kernels.rounding import rounding_of
from verify.kernels.stepping import KernelRun, RunOutcome
from verify.runs import matrix_growth, step_bounds
from verify.runs.a_posteriori_bound import _Certificate, certify
from verify.runs.step_bounds import StepDerivatives, StepRounding

ZERO = flint.arb(0)


@dataclass(frozen=True)
class TwoDegrees:
    """Errors grow like e^t along p1, q1, while p2, q2 turn around and are coupled to them."""

    steps: int
    observables: frozenset[str]

    def kernel_run(self) -> KernelRun:
        saddle = Hamiltonian.parse("p1**2/2 - q1**2/2 + p2**2/2 + q2**2/2 + q1**2*q2/5")
        start = {"p1": Fraction(0), "p2": Fraction(1, 3), "q1": Fraction(1, 10**9),
                 "q2": Fraction(1, 7), "h": Fraction(1, 10), "t": Fraction(0)}  # fmt: skip
        return KernelRun(saddle, "lie2", start, self.steps, self.observables, 0)


def true_values(case: Case | TwoDegrees, errors: Mapping[str, Fraction]) -> dict[str, True_]:
    """By fine balls; in two degrees by a run of many digits."""
    if isinstance(case, Case):
        return enclosed_finely(case, errors)
    values = case.kernel_run().run(systems.get("mpfr", 120)).values
    return {name: (x, Fraction(0)) for name, x in values.items()}


@dataclass(frozen=True)
class Orbit:
    case: Case | TwoDegrees
    arithmetic: Arithmetic

    @cache  # noqa: B019 - a few orbits
    def run(self) -> RunOutcome:
        return self.again()

    def again(self) -> RunOutcome:
        run = self.case.kernel_run().run(self.arithmetic, tangent=True)
        assert run.done == self.case.steps
        return run

    def outside(self, run: RunOutcome | None = None) -> set[str]:
        """The names of values that are not within what is certified; of none without one."""
        run = run or self.run()
        errors = certify(self.case.kernel_run(), self.arithmetic, run) or {}
        true = true_values(self.case, errors)
        return {n for n, e in errors.items() if abs(run.values[n] - true[n][0]) > e + true[n][1]}

    def certified(self) -> dict[str, Fraction]:
        return certify(self.case.kernel_run(), self.arithmetic, self.run()) or {}


FREE = "p**2/2"  # an H for maps that are written down
SINGLE, WIDE = mpfr.at_bits(24), fixed.at_bits(112)
HALF = Fraction(1, 2) - Fraction(1, 2**10)  # of a unit, and a little less
ULP, UNIT = Fraction(1, 2**23), Fraction(1, 2**112)  # of 1 in SINGLE; of every number in WIDE


def shift(increment: Any) -> str:
    return f"p_next = p; q_next = q + {increment}"


LOST = Orbit(case(FREE, shift(HALF * ULP), 1, 0, 1, 2000), SINGLE)
LOST_WIDE = Orbit(case(FREE, shift(HALF * UNIT), 1, 0, 1, 2000), WIDE)
CURVED = Orbit(
    case(FREE, shift(f"{HALF * ULP} + (q - 1)**2/1024"), 1, 0, 1, 46_000), SINGLE
)  # an error e is made e + e²/1024
TOO_CURVED = Orbit(
    case(FREE, shift(f"{HALF * ULP} + (q - 1)**2/32"), 1, 0, 1, 30_000), SINGLE
)  # more than twice what it would be without the square
CUBIC = Orbit(
    case(FREE, shift(f"{HALF / 2**11} + (q - 1)**3/256"), 1, 0, 1, 1500), mpfr.at_bits(12)
)  # no second derivative at 1, where the computed orbit stays
FIRST = Orbit(case(FREE, shift(HALF * ULP), 1 + HALF * ULP, 0, 1, 1), SINGLE)
FIRST_WIDE = Orbit(case(FREE, "p_next = p; q_next = q + p", 1, HALF * UNIT, 1, 100), WIDE)
DUFFING = Orbit(case("p**2/2 + q**2/2 + q**4/4", "lie2", "3/2", 0, Fraction(1, 1024), 200), WIDE)
SADDLE = Orbit(
    case("p**2/2 + cos(q)", "lie2", Fraction(1, 2**20) + HALF * UNIT, 0, "1/8", 112), WIDE
)  # from near q = 0, where errors grow like e^T
SADDLE_FLOATING = Orbit(
    case("p**2/2 - cos(q)", "lie2", Fraction(3141592, 10**6), 0, "1/8", 112), mpfr.at_bits(100)
)
SQUEEZED = Orbit(case(FREE, "p_next = p + 1/64; q_next = q + p*q/2", 1, -1, 1, 128), WIDE)
TIMES = Orbit(case(FREE, "p_next = p; q_next = q + h*1000", 0, 0, HALF * UNIT, 100), WIDE)
STEADY = Orbit(case(FREE, "p_next = p; q_next = q + 3*h*q/4", 0, 0, "1/1048576", 2000), WIDE)
STALLED = Orbit(case(FREE, shift("q/1024"), 0, 0, 1, 10_000), mpfr.at_bits(8))
OF_STEPS = frozenset({"symplectic_defect_max", "lambda", "delta_j_max", "mse"})
FAR, NEAR = TwoDegrees(130, OF_STEPS), TwoDegrees(55, OF_STEPS | {"symplectic_defect"})
FIXED, FLOATING = systems.get("fixed", 33), systems.get("mpfr", 25)
COUPLED, COUPLED_FLOATING = Orbit(FAR, FIXED), Orbit(FAR, FLOATING)
# M leaves the range of fixed point beyond.
SHORT, SHORT_FLOATING = Orbit(NEAR, FIXED), Orbit(NEAR, FLOATING)
ORBITS = {name: orbit for name, orbit in globals().items() if isinstance(orbit, Orbit)}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", ORBITS)
def test_without_a_lie_the_values_are_within_what_is_certified(name: str) -> None:
    orbit = ORBITS[name]
    assert orbit.outside() == set()
    certified = set() if orbit in (TOO_CURVED, CUBIC) else set(orbit.run().values)
    assert set(orbit.certified()) == certified


# -- lies that the run does not know of -----------------------------------------------------------

Patch = pytest.MonkeyPatch
_errors, _orbit = StepRounding.errors, _Certificate.orbit


def half_a_step(patch: Patch) -> None:
    """The rounding of one step is half of what it is."""

    def halved(self: StepRounding) -> Any:
        found = _errors(self)
        return found and replace(found, state=found.state / 2)

    patch.setattr(StepRounding, "errors", halved)


def half_an_error(patch: Patch) -> None:
    """The error of the state is half of what it is."""

    def halved(self: _Certificate, *given: Any) -> Any:
        found = _orbit(self, *given)
        return found and tuple(x / 2 for x in found)

    patch.setattr(_Certificate, "orbit", halved)


def free_products(patch: Patch) -> None:
    """A product is not rounded."""

    def lying(arithmetic: Arithmetic) -> rounding.Rounding:
        own = rounding_of(arithmetic)
        return lambda op, size: ZERO if op.kind == "mul" else own(op, size)

    patch.setattr(step_bounds, "rounding_of", lying)


def free_constants(patch: Patch) -> None:
    """A constant is held exactly."""

    def lying(arithmetic: Arithmetic) -> rounding.Rounding:
        own = rounding_of(arithmetic)
        return lambda op, size: ZERO if op.kind == "const" else own(op, size)

    patch.setattr(step_bounds, "rounding_of", lying)


def exact_inputs(patch: Patch) -> None:
    """h and the parameters are held exactly."""
    inputs = StepRounding.inputs

    def lying(self: StepRounding) -> Any:
        return {name: replace(x, error=ZERO) for name, x in inputs(self).items()}

    patch.setattr(StepRounding, "inputs", lying)


def straight(patch: Patch) -> None:
    """The map has no second derivatives."""
    patch.setattr(StepDerivatives, "second", lambda *_: ZERO)


def narrow(patch: Patch) -> None:
    """The true orbit is where the computed one is."""
    box = StepRounding.box
    patch.setattr(StepRounding, "box", lambda self, _: box(self, ZERO))


def level(patch: Patch) -> None:
    """ΔJ is the same everywhere."""
    patch.setattr(StepDerivatives, "gradient", lambda *_: ZERO)


def exact_start(patch: Patch) -> None:
    """The initial values are held exactly."""
    patch.setattr(_Certificate, "first_error", lambda _: ZERO)


def free_product_of_factors(patch: Patch) -> None:
    """Λ ← Λ + ΔJ + Λ ΔJ is not rounded."""
    patch.setattr(_Certificate, "of_product", lambda *_: ZERO)


LIES = [
    (half_a_step, LOST, "q"),
    (half_a_step, LOST_WIDE, "q"),
    (half_an_error, LOST, "q"),
    (half_an_error, LOST_WIDE, "q"),
    (half_an_error, FIRST_WIDE, "q"),
    (half_an_error, CURVED, "delta_j_max"),
    (free_products, DUFFING, "p q mse delta_j_max"),
    (free_constants, LOST_WIDE, "q"),
    (exact_inputs, TIMES, "q"),
    (straight, CURVED, "q"),
    (straight, TOO_CURVED, "q"),
    (narrow, CUBIC, "q"),
    (level, SADDLE, "lambda mse delta_j_max"),
    (level, SADDLE_FLOATING, "lambda mse delta_j_max"),
    (exact_start, FIRST, "q"),
    (exact_start, FIRST_WIDE, "p q"),
    (free_product_of_factors, STALLED, "lambda"),
    (free_product_of_factors, STEADY, "lambda"),
]


@pytest.mark.parametrize(("lie", "orbit", "names"), LIES)
def test_a_lie_shows_in_values_outside_their_bounds(
    lie: Callable[[Patch], None], orbit: Orbit, names: str, monkeypatch: Patch
) -> None:
    lie(monkeypatch)
    assert orbit.outside() >= set(names.split())


@pytest.mark.parametrize("orbit", [SHORT, SHORT_FLOATING], ids=["fixed", "mpfr"])
def test_a_defect_without_the_rounding_of_its_matrix_is_caught(
    orbit: Orbit, monkeypatch: Patch
) -> None:
    bound: Callable[..., flint.arb] = matrix_growth.bound_total_defect
    nothing = dict.fromkeys(("second", "slope", "matrix_rounding", "entry_rounding"), ZERO)
    lying = lambda motion, **terms: bound(motion, **terms | nothing)  # noqa: E731
    monkeypatch.setattr(matrix_growth, "bound_total_defect", lying)
    assert orbit.outside() == {"symplectic_defect"}


# -- how near the bounds are ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("orbit", "name", "most"),
    [(LOST, "q", 1.05), (LOST_WIDE, "q", 1.05), (FIRST_WIDE, "q", 1.05), (CURVED, "q", 1.6),
     (CURVED, "delta_j_max", 1.6)],
)  # fmt: skip
def test_where_every_rounding_is_as_large_as_can_be_the_bound_is_nearly_the_error(
    orbit: Orbit, name: str, most: float
) -> None:
    errors = orbit.certified()
    true = enclosed_finely(orbit.case, errors)
    assert errors[name] <= most * abs(orbit.run().values[name] - true[name][0])
