"""H(p, q, t): D in place of X, right clocks, and wrong ones that are refuted."""

from fractions import Fraction

import pytest
import sympy

from verify import schemes
from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import potential_of
from verify.proof.proof_for_one_h import Proof
from verify.verdict import Verdict

DRIVEN = {
    "pendulum": "p**2/2 - (1 + cos(2*t)/2)*cos(q)",
    "polynomial": "p**2/2 + q**2/2 + t*q**3",
    "mass": "p**2/(2*(1 + t**2)) + q**4*exp(-t)",
    "general": "p**4*(1 + t) + q**3*t**2 + p**2",
    "mixed": "p**2*(1 + q**2)/2 + q**2*sin(t)",
}
SEPARABLE = ("pendulum", "polynomial", "mass", "general")
SPLITTINGS = [
    name
    for name in schemes.names()
    if schemes.get(name).needs_separable and schemes.get(name).order <= 4
]
VERLET = "kick 1/2 at {}; drift 1{}; kick 1/2 at {}; order 2"


def hamiltonian(name: str) -> Hamiltonian:
    return Hamiltonian.parse(DRIVEN[name])


def proof(scheme: str, name: str) -> Proof:
    found = schemes.get(scheme)
    return prove(found.step_map(hamiltonian(name)), found)


# -- lieη -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", DRIVEN)
@pytest.mark.parametrize("eta", [1, 2, 3, 4])
def test_lie_is_of_its_order_and_of_even_order_its_error_telescopes(eta: int, name: str) -> None:
    found = proof(f"lie{eta}", name)
    assert (found.verdict, found.order, found.convergence_order) == (Verdict.PROVED, eta + 1, eta)
    potential = potential_of(found, schemes.get(f"lie{eta}"))
    assert potential.holds is (True if eta % 2 == 0 else potential.holds)
    assert "t" in found.witness or found.enclosure


def test_the_map_of_lie2_is_written_with_the_derivative_by_t() -> None:
    """H = p²/2 + f(t) q: D²p = −f'(t), which X²p = 0 lacks."""
    step = schemes.get("lie2").step_map(Hamiltonian.parse("p**2/2 + sin(t)*q"))
    p, q, t, h = map(symbol, "pqth")
    assert step.p_next - (p - h * sympy.sin(t) - h**2 / 2 * sympy.cos(t)) == 0
    assert sympy.expand(step.q_next - (q + h * p - h**2 / 2 * sympy.sin(t))) == 0


def test_without_the_derivative_by_t_it_does_not_telescope() -> None:
    """The planted error: X·G in place of D·G."""
    found = proof("lie2", "pendulum")
    potential = potential_of(found, schemes.get("lie2"))
    assert potential.element is not None
    assert found.first.element is not None
    ring, g = potential.element
    leading = found.first.element[1]
    force, speed = found.step_map.field.slopes
    along = speed * ring.diff(g, "q") + force * ring.diff(g, "p")
    assert ring.decide(along - leading).zero is False
    assert ring.decide(along + ring.diff(g, "t") - leading).zero is True


def test_a_parameter_and_not_t_is_what_a_proof_leaves_out() -> None:
    found = prove(
        schemes.get("lie2").step_map(Hamiltonian.parse("p**2/2 + a*q**4*cos(t)")),
        schemes.get("lie2"),
    )
    assert found.verdict is Verdict.PROVED
    assert found.domain.names <= {"a"}


# -- clocks ---------------------------------------------------------------------------------------


@pytest.mark.sample(14)
@pytest.mark.parametrize("name", SEPARABLE)
@pytest.mark.parametrize("scheme", SPLITTINGS)
def test_with_its_two_clocks_a_splitting_keeps_its_order(scheme: str, name: str) -> None:
    found = proof(scheme, name)
    assert (found.verdict, found.area_preserving) == (Verdict.PROVED, True)
    assert found.convergence_order is not None
    assert found.convergence_order >= schemes.get(scheme).order


@pytest.mark.parametrize("name", DRIVEN)
@pytest.mark.parametrize("scheme", ["rk4", "explicit-midpoint", "implicit-midpoint", "gauss4"])
def test_stages_at_their_times_keep_the_order(scheme: str, name: str) -> None:
    found, claims = proof(scheme, name), schemes.get(scheme)
    assert found.verdict is Verdict.PROVED
    assert found.convergence_order == claims.order
    assert found.area_preserving is claims.area_preserving


@pytest.mark.parametrize(
    ("kicks", "verdict", "order"),
    [((0, 1), "PROVED", 2), ((0, 0), "REFUTED", 1), ((1, 1), "REFUTED", 1),
     (("1/2", "1/2"), "PROVED", 2), ((1, 0), "PROVED", 2), ((0, "1/2"), "REFUTED", 1)],
)  # fmt: skip
def test_the_clock_of_the_kicks_decides(
    kicks: tuple[object, object], verdict: str, order: int
) -> None:
    found = proof(VERLET.format(kicks[0], "", kicks[1]), "pendulum")
    assert (found.verdict, found.convergence_order) == (verdict, order)
    assert found.area_preserving is True


@pytest.mark.parametrize("time", ["0", "1/2", "1", "7/3"])
def test_a_drifts_time_is_judged_only_where_t_is_in_the_kinetic_energy(time: str) -> None:
    scheme = VERLET.format("0", f" at {time}", "1")
    assert proof(scheme, "pendulum").verdict is Verdict.PROVED
    of_mass = proof(scheme, "mass").verdict
    assert of_mass is (Verdict.PROVED if time == "1/2" else Verdict.REFUTED)


def test_a_method_for_a_quadratic_t_loses_an_order_where_the_mass_depends_on_time() -> None:
    """McLachlan and Atela's method of order 4 for T = p²/2, which is of order 3 for another T."""
    a = (Fraction("0.5153528374311229364"), Fraction("-0.085782019412973646"),
         Fraction("0.4415830236164665242"), Fraction("0.1288461583653841854"))  # fmt: skip
    b = (Fraction("0.1344961992774310892"), Fraction("-0.2248198030794208058"),
         Fraction("0.7563200005156682911"), Fraction("0.3340036032863214255"))  # fmt: skip
    text = "; ".join(f"kick {k}; drift {d}" for d, k in zip(a, b, strict=True))
    own = schemes.get(f"{text}; order 1")
    errors = {}
    for name, formula in {"force": "p**2/2 + q**3*(1 + t)", "mass": "p**2*(1 + t) + q**3"}.items():
        step = own.step_map(Hamiltonian.parse(formula))
        expanded = step.series(4)
        assert expanded is not None
        field, series = expanded
        for n in (3, 4):
            gaps = [
                x.coefficients[n] - y / sympy.factorial(n).p
                for x, y in zip(series, field.power(n), strict=True)
            ]
            sizes = [abs(Fraction(int(c.p), int(c.q))) for gap in gaps for c in gap.coeffs()]
            errors[name, n] = max(sizes, default=Fraction(0))
    tiny = Fraction(1, 10**12)  # the coefficients are decimals
    assert errors["force", 3] < tiny
    assert errors["force", 4] < tiny
    assert errors["mass", 3] < tiny
    assert errors["mass", 4] > Fraction(1, 1000)


# -- an H without t, and what does not take one that has it ----------------------------------------


def test_an_h_without_t_has_no_t_in_its_ring() -> None:
    for formula in ("p**2/2 + q**4", "p**2/2 - cos(q)"):
        found = Hamiltonian.parse(formula)
        assert not found.time_dependent
        assert "t" not in canonical_field(found)[0].ring.places


def test_t_is_no_parameter_and_the_gradient_takes_it() -> None:
    driven = Hamiltonian.parse("p**2/2 + a*q**2*t", {"a": 2})
    assert driven.parameters == ("a",)
    assert driven.gradient()(1.0, 3.0, 0.5) == (1.0, 6.0)
    with pytest.raises(InputError, match="parameter"):
        Hamiltonian.parse("p**2/2 + q**2*t", {"t": 1})
