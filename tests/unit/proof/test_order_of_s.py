"""Proofs in n degrees of freedom, held against steps in mpmath that share no code with them."""

from collections.abc import Callable
from fractions import Fraction
from itertools import product
from typing import Any

import pytest

from tests.helpers.stepping.steps_by_differences import (
    Step,
    change_of_volume,
    defect,
    explicit_midpoint,
    implicit_midpoint,
    lie,
    mp,
    rk4,
    symplectic_euler,
    verlet,
)
from verify.algebra.formula import parse, symbol
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.schemes import get
from verify.verdict import Verdict

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
MIXED = "(p1*q2 + p2)**2/2 + q1*q2*exp(p1/2) + q1**2"
KEPLER = "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)"
CHAIN = "(p1**2 + p2**2 + p3**2)/2 - cos(q1 - q2) - cos(q2 - q3)*q1"
ENERGIES: dict[str, Callable[..., Any]] = {
    HENON: lambda p1, p2, q1, q2: (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3,
    MIXED: lambda p1, p2, q1, q2: (p1 * q2 + p2) ** 2 / 2 + q1 * q2 * mp.exp(p1 / 2) + q1**2,
    KEPLER: lambda p1, p2, q1, q2: (p1**2 + p2**2) / 2 - 1 / mp.sqrt(q1**2 + q2**2),
    CHAIN: lambda p1, p2, p3, q1, q2, q3: (
        (p1**2 + p2**2 + p3**2) / 2 - mp.cos(q1 - q2) - mp.cos(q2 - q3) * q1
    ),
}
STEPS: dict[str, Step] = {
    "lie1": lie(1), "lie2": lie(2), "lie3": lie(3), "rk4": rk4,
    "explicit-midpoint": explicit_midpoint,
}  # fmt: skip
SYMPLECTIC: dict[str, Step] = {
    "stormer-verlet": verlet, "symplectic-euler": symplectic_euler,
    "implicit-midpoint": implicit_midpoint,
}  # fmt: skip
POINT = [Fraction(n, d) for n, d in ((3, 7), (-2, 5), (5, 8), (4, 9), (-7, 11), (1, 3))]
H = mp.mpf(10) ** -9


def proved(formula: str, scheme: str) -> Proof:
    return prove(get(scheme).step_map(Hamiltonian.parse(formula)), get(scheme))


def start(formula: str) -> list[Fraction]:
    return POINT[: len(Hamiltonian.parse(formula).coordinates)]


def numbers(z: list[Fraction]) -> list[Any]:
    return [mp.mpf(x.numerator) / x.denominator for x in z]


def value(ring: Any, x: Any, formula: str) -> Any:
    """An element at the point, by sympy."""
    names = Hamiltonian.parse(formula).coordinates
    put = dict(zip(map(symbol, names), start(formula), strict=True))
    return mp.mpf(str(ring.expression(x).subs(put).evalf(40)))


@pytest.mark.sample(6)
@pytest.mark.parametrize(("formula", "scheme"), [*product(ENERGIES, STEPS)])
def test_the_leading_form_is_that_of_the_step(formula: str, scheme: str) -> None:
    found = proved(formula, scheme)
    assert found.verdict is Verdict.PROVED
    form = found.first.form
    assert form is not None
    assert found.order is not None
    own = defect(STEPS[scheme], ENERGIES[formula], numbers(start(formula)), H)
    for (a, b), entry in own.items():
        expected = value(form.ring, form.entry(a, b), formula)
        assert abs(entry / H**found.order - expected) < 1e-6, (a, b)
    assert max(abs(x) for x in own.values()) > H ** (found.order + 1), "it does not vanish"


@pytest.mark.sample(6)
@pytest.mark.parametrize(("formula", "scheme"), [*product(ENERGIES, STEPS)])
def test_the_change_of_volume_is_that_of_the_step(formula: str, scheme: str) -> None:
    found = proved(formula, scheme)
    assert found.volume_order is not None
    names = Hamiltonian.parse(formula).coordinates
    leading = parse(found.volume_leading, names)
    put = dict(zip(map(symbol, names), start(formula), strict=True))
    own = change_of_volume(STEPS[scheme], ENERGIES[formula], numbers(start(formula)), H)
    expected = mp.mpf(str(leading.subs(put).evalf(40)))
    assert abs(own / H**found.volume_order - expected) < 1e-6


@pytest.mark.sample(5)
@pytest.mark.parametrize(("formula", "scheme"), [*product(ENERGIES, SYMPLECTIC)])
def test_what_is_symplectic_is_so_in_steps_too(formula: str, scheme: str) -> None:
    if formula == MIXED and scheme != "implicit-midpoint":
        with pytest.raises(InputError, match="is explicit only for H = T"):
            proved(formula, scheme)
        return
    found = proved(formula, scheme)
    assert (found.verdict, found.symplectic, found.area_preserving) == ("PROVED", True, True)
    own = defect(SYMPLECTIC[scheme], ENERGIES[formula], numbers(start(formula)), mp.mpf(1) / 10)
    assert max(abs(x) for x in own.values()) < mp.mpf(10) ** -25  # the midpoint's 40 iterations


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("formula", ENERGIES)
def test_every_scheme_has_the_order_that_it_claims(formula: str) -> None:
    for scheme in ("lie1", "lie2", "lie4", "rk4", "explicit-midpoint", "implicit-midpoint",
                   "gauss4", "implicit-symplectic-euler"):  # fmt: skip
        found = proved(formula, scheme)
        assert found.convergence_order == get(scheme).order, scheme
        assert found.verdict is Verdict.PROVED
    if formula != MIXED:
        for scheme in ("stormer-verlet", "ruth3", "blanes-moan4", "symplectic-euler"):
            assert proved(formula, scheme).convergence_order == get(scheme).order, scheme


# -- maps of one's own ----------------------------------------------------------------------------

LINEAR = "(p1**2 + p2**2 + q1**2 + q2**2)/2"
EULER = "p1_next = p1 - h*q1; p2_next = p2 - h*q2; q1_next = q1 + h*{}; q2_next = q2 + h*{}"
SKEW = "p1_next = p1 - h*q1 + h**2*q2; p2_next = p2 - h*q2; q1_next = q1 + h*p1_next; "
# det J ≡ 1: what one plane loses the other gains
EXCHANGED = (
    "p1_next = (p1 - h*q1)*(1 + h**2); q1_next = q1 + h*(p1 - h*q1); "
    "p2_next = (p2 - h*q2)/(1 + h**2); q2_next = q2 + h*(p2 - h*q2)"
)
ROTATION = (
    "p1_next = p1*cos(h) - q1*sin(h); q1_next = q1*cos(h) + p1*sin(h); "
    "p2_next = p2*cos(h) - q2*sin(h); q2_next = q2*cos(h) + p2*sin(h)"
)
# (symplectic, det J ≡ 1, order of S, entry that shows it)
MAPS = {
    EULER.format("p1", "p2"): (False, False, 2, "dp1∧dq1"),
    EULER.format("p1_next", "p2_next"): (True, True, None, ""),
    EULER.format("p1_next", "p2"): (False, False, 2, "dp2∧dq2"),
    SKEW + "q2_next = q2 + h*p2_next": (False, True, 2, "dq1∧dq2"),
    EXCHANGED: (False, True, 2, "dp1∧dq1"),
    ROTATION: (True, True, None, ""),
    ROTATION.replace("q2*cos(h)", "q2*cos(h) + h**3*q1", 1): (False, True, 3, "dp2∧dq1"),
}


@pytest.mark.parametrize("formulas", MAPS)
def test_symplectic_volume_alone_and_neither_are_told_apart(formulas: str) -> None:
    found = proved(LINEAR, formulas)
    symplectic, volume, order, entry = MAPS[formulas]
    assert found.verdict is Verdict.PROVED
    assert (found.symplectic, found.area_preserving) == (symplectic, volume)
    assert (found.order, found.entry) == (order, entry)


@pytest.mark.parametrize(
    ("terms", "more", "kept"),
    [(3, "0", True), (3, "p1*h**9", False), (18, "0", None), (18, "p1*h**9", None)],
)
def test_beyond_the_powers_looked_at_volume_is_kept_only_where_that_is_decided(
    terms: int, more: str, kept: bool | None
) -> None:
    """A kick by what is no gradient has det J ≡ 1, or 1 + h⁹ beyond all powers that are looked at;
    of a long one det J is not multiplied out."""
    kick = f"p1_next = p1 + h*(1 + q1 + q2)**{terms} + {more}"
    found = proved(LINEAR, f"{kick}; p2_next = p2; q1_next = q1; q2_next = q2")
    assert (found.symplectic, found.order) == (False, 1)
    assert (found.area_preserving, found.volume_order) == (kept, None)


def test_a_map_that_does_nothing_is_refuted_though_it_is_symplectic() -> None:
    found = proved(LINEAR, "p1_next = p1; p2_next = p2; q1_next = q1; q2_next = q2")
    assert (found.verdict, found.symplectic, found.convergence_order) == ("REFUTED", True, 0)


def test_one_degree_with_a_number_is_the_plane() -> None:
    numbered = proved("p1**2/2 + q1**2/2 + q1**4/4", "lie2")
    assert numbered.order == 3
    assert numbered.leading_text == "(3*p1*q1)*dp1∧dq1"


def test_parameters_for_which_it_is_smaller_are_named() -> None:
    found = prove(
        get("lie2").step_map(Hamiltonian.parse("(p1**2 + p2**2)/2 + k*q1**2*q2")), get("lie2")
    )
    assert found.order == 3
    assert "k ≠ 0" in str(found.domain.prose)


def test_time_counts() -> None:
    driven = "p1**2/(2*(1 + t**2)) + p2**2/2 + q1**2*q2*cos(t)"
    assert proved(driven, "stormer-verlet").convergence_order == 2
    frozen = proved(driven, "stormer-verlet, clock frozen")
    assert (frozen.verdict, frozen.convergence_order, frozen.symplectic) == ("REFUTED", 1, True)
    assert proved(driven, "lie2").telescopes is True


@pytest.mark.parametrize(
    ("formula", "scheme", "words"),
    [
        (LINEAR, "p1_next = p1; q1_next = q1", "H needs p1_next, p2_next, q1_next, q2_next"),
        (LINEAR, "p_next = p; q_next = q", "H needs p1_next, p2_next, q1_next, q2_next"),
        (LINEAR, "p1_next = p1 + q3; p2_next = p2; q1_next = q1; q2_next = q2", "q3"),
    ],
)
def test_what_does_not_fit_is_one_line(formula: str, scheme: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as error:
        proved(formula, scheme)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("eta", [1, 3])
def test_of_odd_order_an_equilibrium_rules_telescoping_out_where_h_is_without_t(eta: int) -> None:
    """In time a form may change where the motion rests: D of it is ∂/∂t there, and not 0."""
    still = "(p1**2 + p2**2)/2 + {}*(q1**2 + q2**2)/2 + q1**2*q2"
    assert proved(still.format(2), f"lie{eta}").telescopes is False
    assert proved(still.format("(2 + cos(t))"), f"lie{eta}").telescopes is None
