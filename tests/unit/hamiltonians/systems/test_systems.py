"""The named systems, found by themselves, and every exact flow held against its equation."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
from flint import arb, fmpq

from tests.helpers.flow_checks import (
    Case,
    energy_defect,
    example,
    group_defect,
    motion_defect,
    start_defect,
)
from verify.errors import InputError
from verify.flows.ball_evaluation import blow_up
from verify.flows.extrapolation import NumericalFlow
from verify.hamiltonians import elliptic, systems
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.named_system import Motion
from verify.hamiltonians.systems.plane import morse, pendulum
from verify.hamiltonians.systems.plane import twist as twist_module

ALL = systems.all_systems()
REGIMES = [(name, regime) for name, system in ALL.items() for regime in system.regimes]
CLOSED = [(name, regime) for name, regime in REGIMES if ALL[name].flow is not None]
every_regime = pytest.mark.parametrize(("name", "regime"), CLOSED, ids=map("-".join, CLOSED))
TIMES = [Fraction(-9, 4), Fraction(-1, 7), Fraction(1, 1000), Fraction(1, 3), Fraction(17, 5)]
PAIRS = [(Fraction(1, 3), Fraction(5, 7)), (Fraction(-11, 5), Fraction(3, 8))]
KNOWN = 1e-50


def within(case: Case, times: list[Fraction]) -> list[Fraction]:
    """The times, drawn together where the solution ends before them."""
    ends = {sign: blow_up(case.motion, sign, 10) for sign in (1, -1)}

    def reached(time: Fraction) -> Fraction:
        end = ends[1 if time > 0 else -1]
        return time if end is None else time * min(1, end * Fraction(9, 40))

    return [reached(time) for time in times]


# -- discovery ------------------------------------------------------------------------------------


def test_each_file_holds_one_system_of_its_name() -> None:
    files = set(systems.names())
    assert files == {system.name for system in systems.all_systems(None).values()}, (
        "a file is named as its system"
    )
    assert {"harmonic", "duffing", "pendulum", "morse", "double-well", "quartic", "cubic"} <= files
    assert {"toda", "toda-oscillator", "lennard-jones", "twist"} <= files


@pytest.mark.parametrize("name", ALL)
def test_a_system_explains_its_parameters_and_shows_its_orbits(name: str) -> None:
    system = ALL[name]
    assert system.title
    assert system.source
    assert set(system.hamiltonian().parameters) == set(system.parameters)
    assert system.regimes
    for regime in system.regimes.values():
        assert set(regime) == {"p", "q", *system.parameters}
    assert not (system.flow and system.goes), "a closed form says itself where it goes"


@pytest.mark.parametrize(("name", "regime"), REGIMES, ids=map("-".join, REGIMES))
def test_h_is_defined_in_every_example(name: str, regime: str) -> None:
    values, p, q = ALL[name].regime(regime)
    field, _ = canonical_field(ALL[name].hamiltonian(values))
    flow = NumericalFlow(field, 20)
    flow.slope(tuple(flow.number(Fraction(x)) for x in (p, q, *([0] if field.timed else []))))


@every_regime
def test_what_is_called_a_separatrix_is_one(name: str, regime: str) -> None:
    elementary = "elementary" in example(ALL[name], regime).motion.method
    if "near-" in regime:
        assert not elementary or name == "morse"
    elif "separatrix" in regime:
        assert elementary


# -- what an exact flow satisfies -----------------------------------------------------------------


@pytest.mark.sample(20)
@every_regime
def test_h_is_constant_to_50_digits(name: str, regime: str) -> None:
    case = example(ALL[name], regime)
    assert energy_defect(case, within(case, TIMES)) < KNOWN


@every_regime
def test_the_equation_of_motion_holds_to_50_digits(name: str, regime: str) -> None:
    case = example(ALL[name], regime)
    assert start_defect(case) < KNOWN
    assert motion_defect(case, within(case, TIMES)) < KNOWN


@every_regime
def test_the_flow_is_a_group_to_45_digits(name: str, regime: str) -> None:
    case = example(ALL[name], regime)
    for s, t in PAIRS:
        s, t, _ = (*within(case, [s, t]), None)
        assert group_defect(case, s, t) < 1e-45


@pytest.mark.sample(10)
@every_regime
def test_the_numerical_flow_agrees(name: str, regime: str) -> None:
    case = example(ALL[name], regime)
    flow = NumericalFlow(canonical_field(ALL[name].hamiltonian(case.values))[0], 40)
    for time in within(case, [Fraction(-7, 3), Fraction(11, 4)]):
        z = flow.follow((flow.number(case.p), flow.number(case.q)), time, 10_000)
        found = case.at(time, 50)
        for ours, theirs in zip(found, z, strict=True):
            apart = abs(ours - flow.arithmetic.exact(theirs))
            assert apart <= Fraction(1, 10**33) * (1 + abs(ours))


def test_no_evaluation_changes_the_global_precision_of_mpmath() -> None:
    before = mpmath.mp.prec
    example(ALL["pendulum"], "libration").at(Fraction(3), 200)
    assert mpmath.mp.prec == before


# -- planted errors -------------------------------------------------------------------------------

Checked = Callable[[Case], Any]


def energy(case: Case) -> Any:
    return energy_defect(case, within(case, TIMES))


def equation(case: Case) -> Any:
    return motion_defect(case, within(case, TIMES))


def slightly_wrong_modulus(m: Any) -> Any:
    return RIGHT(m * (1 + TINY))


def wrong_sign_of_cn(m: Any) -> Any:
    def functions(u: Any) -> Any:
        sn, cn, dn = RIGHT(m)(u)
        return sn, -cn, dn

    return functions


def wrong_period(m: Any) -> Any:
    return lambda u: RIGHT(m)(u * (1 + TINY))


RIGHT = elliptic.jacobi
TINY = fmpq(1, 10**35)
JACOBI = [
    ("pendulum", "libration", pendulum), ("pendulum", "rotation", pendulum),
    ("pendulum", "near-separatrix", pendulum), ("duffing", "hard", elliptic),
    ("duffing", "soft-inside", elliptic), ("duffing", "soft-outside", elliptic),
    ("cubic", "escape", elliptic), ("toda", "oscillation", elliptic),
    ("double-well", "left-well", elliptic), ("double-well", "near-separatrix", elliptic),
    ("quartic", "oscillation", elliptic),
]  # fmt: skip


@pytest.mark.sample(14)
@pytest.mark.parametrize("wrong", [slightly_wrong_modulus, wrong_sign_of_cn, wrong_period])
@pytest.mark.parametrize(
    ("name", "regime", "module"), JACOBI, ids=[f"{n}-{r}" for n, r, _ in JACOBI]
)
def test_a_wrong_modulus_and_a_wrong_sign_are_seen(
    name: str, regime: str, module: Any, wrong: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "jacobi", wrong)
    case = example(ALL[name], regime)
    assert max(energy(case), equation(case)) > KNOWN


def altered(case: Case, change: Callable[[Any, Motion], Any]) -> Case:
    """The case with its state changed: `change` takes t and the motion."""

    class Wrong(Case):
        @property
        def motion(self) -> Motion:
            true = super().motion
            return Motion(lambda t: change(t, true), true.method)

    return Wrong(case.system, case.values, case.p, case.q)


def late(t: Any, true: Motion) -> Any:
    return true.state(t * (1 + TINY))


def reflected(t: Any, true: Motion) -> Any:
    p, q = true.state(t)
    return -p, q


def backwards(t: Any, true: Motion) -> Any:
    return true.state(-t)


def accelerated(t: Any, true: Motion) -> Any:
    return true.state(t + fmpq(1, 10**40) * t**2)


def turned_once_more(t: Any, true: Motion) -> Any:
    p, q = true.state(t)
    return p, q + 2 * arb.pi() * int(t > 1)


PLANTED = [late, reflected, backwards, accelerated]
EXAMPLES = [("harmonic", "oscillation"), ("morse", "bound"), ("twist", "rotation"),
            ("pendulum", "rotation"), ("duffing", "hard"), ("toda", "oscillation")]  # fmt: skip


@pytest.mark.parametrize("planted", PLANTED)
@pytest.mark.parametrize(("name", "regime"), EXAMPLES, ids=map("-".join, EXAMPLES))
def test_a_clock_or_a_sign_that_is_wrong_is_seen_by_the_equation_of_motion(
    name: str, regime: str, planted: Any
) -> None:
    wrong = altered(example(ALL[name], regime), planted)
    assert equation(wrong) > KNOWN


@pytest.mark.parametrize(("name", "regime"), EXAMPLES, ids=map("-".join, EXAMPLES))
def test_a_clock_that_accelerates_is_seen_by_the_group_property(name: str, regime: str) -> None:
    case = example(ALL[name], regime)
    wrong = altered(case, accelerated)

    class Moved(type(wrong)):  # type: ignore[misc]
        def moved(self, p: Fraction, q: Fraction) -> Case:
            return altered(case.moved(p, q), accelerated)

    moved = Moved(case.system, case.values, case.p, case.q)
    assert group_defect(moved, Fraction(1, 3), Fraction(5, 7)) > 1e-45


def test_a_turn_too_many_is_seen_by_the_numerical_flow_alone() -> None:
    case = example(ALL["pendulum"], "rotation")
    wrong = altered(case, turned_once_more)
    assert equation(wrong) < KNOWN
    assert abs(wrong.at(Fraction(3))[1] - case.at(Fraction(3))[1]) > 6


def test_the_planted_modules_are_those_that_the_systems_use() -> None:
    assert pendulum.jacobi is elliptic.jacobi  # type: ignore[attr-defined]
    assert morse.SYSTEM.flow is not None
    assert twist_module.SYSTEM.flow is not None


@pytest.mark.parametrize("text", ["pendulum", "double_well", "Toda oscillator"])
def test_a_systems_name_is_no_formula(text: str) -> None:
    with pytest.raises(InputError, match="is no formula but a system; write system"):
        systems.check_is_formula(text)
    systems.check_is_formula(f"{text}*q")
