"""Where the defect of each structure begins, and with what, beside steps in mpmath; and what is
proved and refuted of it."""

from typing import Any

import pytest
import sympy

from tests.helpers.sampled.formulas import plain
from tests.helpers.stepping.kept_structures import SCHEMES, Field, Kept, leading_of, mp
from verify.errors import InputError
from verify.hamiltonians.equations import read_system
from verify.proof.structures.structure_order import StructureProof, check_structure, prove_structure
from verify.proof.structures.structures_proof import prove_structures
from verify.schemes import get
from verify.structures.reading import KeepsRequest, read_structures
from verify.verdict import Verdict

PLANE = "p**2/2 + q**4/4"
DRIVEN = "p**2/2 + t*q**3/3"
TWO = "p1**2/2 + p2**2/2 + q1**2*q2"
TURNING = "p1**2/2 + p2**2/2 + q1**4/4 + q1**2*q2**2/2 + q2**4/4"
LOTKA = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
TOP = "x_dot = y*z; y_dot = -2*x*z; z_dot = x*y"
BODIES = "v1_dot = -(x1 - x2)**3/2; v2_dot = (x1 - x2)**3/3; x1_dot = v1; x2_dot = v2"
DAMPED = "v_dot = -x**3 - v/2; x_dot = v"


def prove(
    system: str, scheme: str, request: KeepsRequest, parameters: Any = None
) -> StructureProof:
    hamiltonian = read_system(system, parameters)
    (claim,) = read_structures(request, hamiltonian)
    method = get(scheme)
    return prove_structure(method.step_map(hamiltonian), claim.structure, method, claim.order)


def asked(keeps: str, **refined: Any) -> KeepsRequest:
    return KeepsRequest(keeps=(keeps,), **refined)


p, q, p1, p2, q1, q2, u, v, x, y, z, x1, x2, v1, v2, h = sympy.symbols(
    "p q p1 p2 q1 q2 u v x y z x1 x2 v1 v2 h"
)
ONE = sympy.Integer(1)
VOLUME, SYMMETRIC = Kept("volume", (ONE,)), Kept("symmetric")
CANONICAL = Kept("form", (ONE, ONE), ((0, 2), (1, 3)))
CASES: list[tuple[str, str, dict[str, Any], Kept]] = [
    (PLANE, "energy", {}, Kept("integral", (p**2 / 2 + q**4 / 4,))),
    (PLANE, "volume", {}, VOLUME), (PLANE, "area", {}, VOLUME),
    (PLANE, "symmetric", {}, SYMMETRIC),
    (PLANE, "reversible", {}, Kept("reversible", (-p, q))),
    (DRIVEN, "symmetric", {}, SYMMETRIC), (DRIVEN, "volume", {}, VOLUME),
    (TWO, "symplectic", {}, CANONICAL), (TWO, "volume", {}, VOLUME),
    (TURNING, "angular-momentum", {}, Kept("integral", (q1 * p2 - q2 * p1,))),
    (LOTKA, "volume", {"density": "1/(u*v)"}, Kept("volume", (1 / (u * v),))),
    (LOTKA, "symplectic", {"form": "dv^du/(u*v)"}, Kept("form", (-1 / (u * v),), ((0, 1),))),
    (LOTKA, "poisson", {"poisson": "0, u*v; -u*v, 0"}, Kept("poisson", (u * v,), ((0, 1),))),
    (LOTKA, "u + v - log(u) - 2*log(v)", {},
     Kept("integral", (u + v - sympy.log(u) - 2 * sympy.log(v),))),
    (TOP, "2*x**2 + y**2", {}, Kept("integral", (2 * x**2 + y**2,))), (TOP, "volume", {}, VOLUME),
    (TOP, "poisson", {"poisson": "0, z, -y; -z, 0, x; y, -x, 0"},
     Kept("poisson", (z, -y, x), ((0, 1), (0, 2), (1, 2)))),
    (TOP, "reversible", {"reverses": "-x, y, z"}, Kept("reversible", (-x, y, z))),
    (BODIES, "symplectic", {"form": "2*dv1^dx1 + 3*dv2^dx2"},
     Kept("form", (2 * ONE, 3 * ONE), ((0, 2), (1, 3)))),
    (BODIES, "2*v1 + 3*v2", {}, Kept("integral", (2 * v1 + 3 * v2,))),
    (DAMPED, "conformal", {"form": "dv^dx", "factor": "exp(-h/2)"},
     Kept("form", (ONE,), ((0, 1),), sympy.exp(-h / 2))),
]  # fmt: skip
OF_FIELDS = ("euler", "explicit-midpoint", "rk4", "lie2", "lie3", "implicit-midpoint", "gauss4")
POINT = ("0.43", "0.71", "1.29", "0.87")


@pytest.mark.sample(40)
@pytest.mark.parametrize(
    ("system", "keeps", "refined", "kept", "scheme"),
    [(*case, scheme) for case in CASES
     for scheme in (*OF_FIELDS, *(() if "_dot" in case[0] else ("stormer-verlet", "ruth3")))],
)  # fmt: skip
def test_the_order_and_the_leading_coefficient_are_those_of_steps_in_mpmath(
    system: str, keeps: str, refined: dict[str, Any], kept: Kept, scheme: str
) -> None:
    hamiltonian = read_system(system)
    names, at = hamiltonian.coordinates, list(map(mp.mpf, POINT))
    field = Field(names, tuple(map(plain_symbols, _slopes(hamiltonian))))
    step = SCHEMES[scheme](field)
    order, row = leading_of(kept, names, step, at[: len(names)], mp.mpf("0.3"))
    proof = prove(system, scheme, asked(keeps, **refined))
    if order is None:
        assert (proof.verdict, proof.is_kept) == (Verdict.PROVED, True)
        return
    assert (proof.verdict, proof.is_kept, proof.order) == (Verdict.REFUTED, False, order)
    if proof.structure.name != "symplectic" or "form" in refined:  # that has the whole form
        values = dict(zip((*names, "t"), (*POINT[: len(names)], "0.3"), strict=True))
        leading = plain_symbols(plain(proof.leading))
        value = leading.subs({sympy.Symbol(n): sympy.Rational(w) for n, w in values.items()})
        assert any(abs(w - mp.mpf(str(value.evalf(30)))) < 1e-7 * abs(w) for w in row if w)
    judged = [prove(system, scheme, asked(f"{keeps}: {k}", **refined)).verdict
              for k in (order - 1, order, order + 1) if k]  # fmt: skip
    assert judged[-2:] == [Verdict.PROVED, Verdict.REFUTED]
    assert judged[:-2] in ([], [Verdict.PROVED])


def plain_symbols(x: Any) -> Any:
    return x.xreplace({s: sympy.Symbol(s.name) for s in x.free_symbols})


def _slopes(system: Any) -> list[Any]:
    if system.energy is None:
        return list(system.exact)
    symbols, half = {w.name: w for w in system.exact.free_symbols}, len(system.coordinates) // 2
    rows = [[system.exact.diff(symbols[n]) for n in names]
            for names in (system.coordinates[half:], system.coordinates[:half])]  # fmt: skip
    return [*(-w for w in rows[0]), *rows[1]]


KEPT: list[tuple[str, str, str, dict[str, Any]]] = [
    (PLANE, "stormer-verlet", "area", {}), (PLANE, "stormer-verlet", "volume", {}),
    (PLANE, "stormer-verlet", "symmetric", {}), (PLANE, "stormer-verlet", "reversible", {}),
    (PLANE, "implicit-midpoint", "symmetric", {}), (PLANE, "gauss4", "reversible", {}),
    ("p**2/2 + q**2/2", "implicit-midpoint", "energy", {}), (DRIVEN, "gauss4", "symmetric", {}),
    (DRIVEN, "implicit-midpoint", "symmetric", {}), (DRIVEN, "stormer-verlet", "symmetric", {}),
    (TURNING, "stormer-verlet", "angular-momentum", {}), (TURNING, "ruth3", "angular-momentum", {}),
    (TURNING, "yoshida4", "angular-momentum", {}), (TURNING, "gauss4", "angular-momentum", {}),
    (TURNING, "implicit-symplectic-euler", "angular-momentum", {}),
    (TOP, "implicit-midpoint", "2*x**2 + y**2", {}), (TOP, "gauss4", "2*x**2 + y**2", {}),
    (TOP, "implicit-midpoint", "reversible", {"reverses": "-x, y, z"}),
    ("x_dot = y**3; y_dot = -x**3", "gauss4", "reversible", {"reverses": "y, x"}),
    ("x_dot = y**3; y_dot = -x**3", "implicit-midpoint", "symplectic", {"form": "dx^dy"}),
    ("x_dot = y**3; y_dot = -x**3", "gauss4", "volume", {}),
    (BODIES, "rk4", "2*v1 + 3*v2", {}), (BODIES, "lie3", "2*v1 + 3*v2", {}),
    (BODIES, "gauss4", "symplectic", {"form": "2*dv1^dx1 + 3*dv2^dx2"}),
    ("S_dot = -b*S*I; I_dot = b*S*I - g*I; R_dot = g*I", "rk4", "S+I+R", {}),
    # Lotka–Volterra by symplectic Euler, and damping by a kick, a drift and the exact decay
    (LOTKA, "u_next = u*(1 + h*(v - 2)); v_next = v/(1 - h*(1 - u_next))", "poisson",
     {"poisson": "0, u*v; -u*v, 0"}),
    (DAMPED, "x_next = x + h*v; v_next = exp(-h/2)*(v - h*x_next**3)", "conformal",
     {"form": "dv^dx", "factor": "exp(-h/2)"}),
]  # fmt: skip


@pytest.mark.parametrize(("system", "scheme", "keeps", "refined"), KEPT)
def test_what_is_kept_exactly_is_proved_with_and_without_an_order(
    system: str, scheme: str, keeps: str, refined: dict[str, Any]
) -> None:
    for text in (keeps, f"{keeps}: 20"):
        proof = prove(system, scheme, asked(text, **refined))
        assert (proof.verdict, proof.is_kept, proof.order) == (Verdict.PROVED, True, None)
        assert (proof.telescopes, proof.potential, proof.leading) == (True, "0", "")


NOT_KEPT: list[tuple[str, str, str, dict[str, Any]]] = [
    (PLANE, "symplectic-euler", "symmetric", {}), (PLANE, "ruth3", "reversible", {}),
    (DRIVEN, "stormer-verlet, clock frozen", "symmetric", {}),
    (DRIVEN, "stormer-verlet, clock at the end", "symmetric", {}),
    ("p**2/2 + q**2/2", "stormer-verlet", "energy", {}), (TURNING, "rk4", "angular-momentum", {}),
    (TOP, "implicit-midpoint", "volume", {}), (TOP, "gauss4", "volume", {}),
    (TOP, "implicit-midpoint", "poisson", {"poisson": "0, z, -y; -z, 0, x; y, -x, 0"}),
    (BODIES, "rk4", "symplectic", {"form": "2*dv1^dx1 + 3*dv2^dx2"}),
    (LOTKA, "u_next = u*(1 + h*(v - 2)); v_next = v*(1 + h*(1 - u))", "volume",
     {"density": "1/(u*v)"}),
    (DAMPED, "x_next = x + h*v; v_next = (1 - h/2)*(v - h*x_next**3)", "conformal",
     {"form": "dv^dx", "factor": "exp(-h/2)"}),
]  # fmt: skip


@pytest.mark.parametrize(("system", "scheme", "keeps", "refined"), NOT_KEPT)
def test_its_twin_that_is_not_kept_is_refuted_where_the_defect_begins(
    system: str, scheme: str, keeps: str, refined: dict[str, Any]
) -> None:
    proof = prove(system, scheme, asked(keeps, **refined))
    assert (proof.verdict, proof.is_kept) == (Verdict.REFUTED, False)
    assert proof.order is not None
    assert f"h^{proof.order}" in str(proof.reason)
    assert prove(system, scheme, asked(f"{keeps}: {proof.order}", **refined)).verdict == "PROVED"
    higher = asked(f"{keeps}: {proof.order + 1}", **refined)
    assert prove(system, scheme, higher).verdict == "REFUTED"


# -- high powers, and maps that do not begin with z ------------------------------------------------


@pytest.mark.parametrize("power", [2, 4, 5, 8, 11, 12, 13, 17])
def test_a_term_of_any_power_is_seen_in_a_polynomial_map(power: int) -> None:
    """The energy of a free body; with a claim one too high, which is not taken on trust."""
    scheme = f"p_next = p + h**{power}; q_next = q + h*p"
    proof = prove("p**2/2", scheme, asked("energy"))
    assert (proof.order, proof.leading) == (power, "p")
    assert prove("p**2/2", scheme, asked(f"energy: {power + 1}")).verdict == "REFUTED"
    assert prove("p**2/2", scheme, asked(f"energy: {power}")).verdict == "PROVED"


@pytest.mark.parametrize("power", [8, 9])
def test_every_power_up_to_the_last_is_examined_in_more_coordinates(power: int) -> None:
    """By a map with a quotient, whose series is examined to h⁸ alone."""
    system = "x_dot = y; y_dot = 0; z_dot = 0"
    scheme = f"x_next = x + h*y; y_next = y + h**{power}*sqrt(1 + h*x**2 + y**2); z_next = z"
    proof = prove(system, scheme, asked("y: 9"))
    assert (proof.order, proof.verdict) == ((8, "REFUTED") if power == 8 else (None, "PROVED"))
    assert prove(system, scheme, asked("y: 10")).verdict == ("REFUTED" if power == 8 else
                                                             "UNDECIDED")  # fmt: skip


def test_a_step_that_turns_p_at_its_end_is_judged_all_the_same() -> None:
    scheme = "p_next = -p + h*q; q_next = q + h*p"
    oscillator = "p**2/2 + q**2/2"
    assert prove(oscillator, scheme, asked("energy")).order == 2
    area = prove(oscillator, scheme, asked("area"))
    assert (area.order, area.leading) == (0, "-2")
    assert prove(oscillator, scheme, asked("symmetric")).order == 1
    kept = "p_next = -p*cos(h) + q*sin(h); q_next = q*cos(h) + p*sin(h)"
    assert prove(oscillator, kept, asked("energy")).is_kept is True
    assert prove(oscillator, kept, asked("area: 1")).verdict == "REFUTED"


# -- parameters and domains -----------------------------------------------------------------------


def test_the_domain_has_the_parameters_for_which_the_order_is_higher() -> None:
    proof = prove("p**2/2 + a*q**2/2", "rk4", asked("energy"))
    assert proof.order == 6
    assert proof.domain.texts == ("a != 0",)
    at_zero = prove("p**2/2 + a*q**2/2", "rk4", asked("energy"), {"a": 0})
    assert at_zero.is_kept is True


def test_the_domain_has_where_the_structure_is_smooth() -> None:
    proof = prove(LOTKA, "rk4", asked("volume", density="1/(u*v)"))
    assert set(proof.domain.texts) == {"u != 0", "v != 0"}
    implicit = prove(PLANE, "implicit-midpoint", asked("symmetric"))
    assert any("stages have a solution" in text for text in implicit.domain.texts)


def test_a_factor_s_parameter_may_have_the_value_0() -> None:
    request = asked("conformal", form="dv^dx", factor="exp(-g*h)")
    damped = "v_dot = -x - g*v; x_dot = v"
    assert prove(damped, "rk4", request).order == 5
    assert prove(damped, "rk4", request, {"g": 0}).order == 6
    assert prove(damped, "implicit-midpoint", request).order == 3


# -- the check of the flow ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("system", "request_", "shown"),
    [(PLANE, asked("energy"), True), (LOTKA, asked("u + v - log(u) - 2*log(v)"), True),
     ("x_dot = 1; y_dot = t", asked("y - t**2/2"), True)],
)  # fmt: skip
def test_a_structure_of_the_flow_is_shown_to_be_one(
    system: str, request_: KeepsRequest, shown: bool
) -> None:
    hamiltonian = read_system(system)
    (claim,) = read_structures(request_, hamiltonian)
    assert check_structure(hamiltonian, claim.structure) is shown


@pytest.mark.parametrize(
    ("system", "request_", "term"),
    [(PLANE, asked("p*q"), "(p - q**2)*(p + q**2)"), (LOTKA, asked("volume"), "-u + v - 1"),
     ("x_dot = 1; y_dot = t", asked("y - t**2"), "-t"),
     (PLANE, asked("symplectic", form="q*dp^dq"), "dp∧dq: p")],
)  # fmt: skip
def test_what_the_flow_does_not_keep_is_refused_with_its_slope(
    system: str, request_: KeepsRequest, term: str
) -> None:
    with pytest.raises(InputError, match="not kept by the exact flow") as caught:
        prove(system, "rk4", request_)
    assert str(caught.value).endswith(f"h^1, times {term}")


# -- several claims -------------------------------------------------------------------------------


def all_of(system: str, scheme: str, *keeps: str) -> Any:
    hamiltonian, method = read_system(system), get(scheme)
    claims = read_structures(KeepsRequest(keeps=keeps), hamiltonian)
    return prove_structures(method.step_map(hamiltonian), claims, method)


def test_the_verdict_is_the_worst_of_all() -> None:
    proof = all_of(PLANE, "stormer-verlet", "area", "energy: 3", "symmetric")
    assert (proof.verdict, proof.convergence_order) == (Verdict.PROVED, 2)
    worse = all_of(PLANE, "stormer-verlet", "area", "energy: 4", "symmetric")
    assert worse.verdict is Verdict.REFUTED
    assert str(worse.reason).startswith("energy: ")
    assert [x.verdict for x in worse.keeps] == ["PROVED", "REFUTED", "PROVED"]


def test_a_step_that_does_nothing_keeps_everything_and_proves_nothing() -> None:
    proof = all_of(PLANE, "p_next = p; q_next = q", "area", "energy", "symmetric")
    assert [x.verdict for x in proof.keeps] == ["PROVED"] * 3
    assert proof.verdict is Verdict.UNDECIDED
    assert "it does not agree up to h" in str(proof.reason)


def test_rounded_coefficients_refute_nothing_exact() -> None:
    """Gauss's numbers with ten digits, as kicks and drifts of a splitting."""
    third, fourth = "1.3512071919", "-1.7024143839"
    scheme = "; ".join(f"{kind} {size}" for kind, size in zip(
        ["kick", "drift", "kick", "drift", "kick", "drift", "kick"],
        ["0.67560359595", third, "-0.175603596", fourth, "-0.175603596", third, "0.67560359595"],
        strict=True))  # fmt: skip
    system = "p**2/2 + q**4/4"
    assert prove(system, scheme, asked("area")).verdict is Verdict.PROVED
    # Taken exactly, they have terms in h^1, h^2, …, and exact ones near them the order 3 at least.
    assert prove(system, scheme, asked("energy: 4")).verdict is Verdict.ENCLOSED
    assert prove(system, scheme, asked("energy: 5")).verdict is Verdict.UNDECIDED
    assert prove(system, f"{scheme}; order 4", asked("energy: 5")).verdict is Verdict.ENCLOSED


GAUSS = ("0.2113248654051871 | 0.25 -0.0386751345948129; "
         "0.7886751345948129 | 0.5386751345948129 0.25; | {b}; order 4")  # fmt: skip


@pytest.mark.parametrize(
    ("scheme", "keeps", "verdict"),
    [
        ("kick 0.50000000001; drift 1; kick 0.49999999999", "symmetric", Verdict.UNDECIDED),
        ("kick 0.50000100001; drift 1; kick 0.49999899999", "symmetric", Verdict.REFUTED),
        ("kick 0.50000000001; drift 1; kick 0.49999999999", "energy", Verdict.REFUTED),
        ("kick 0.50000000001; drift 1; kick 0.49999999999", "energy: 3", Verdict.ENCLOSED),
        ("kick 0.50000100001; drift 1; kick 0.49999899999", "energy: 3", Verdict.REFUTED),
        ("p_next = p - 0.99999999999*h*q**3; q_next = q + h*p_next", "energy: 2", Verdict.ENCLOSED),
        ("p_next = p - 0.99999899999*h*q**3; q_next = q + h*p_next", "energy: 2", Verdict.REFUTED),
        (GAUSS.format(b="0.5 0.5"), "energy: 5", Verdict.UNDECIDED),
        (GAUSS.format(b="0.5 0.5"), "energy: 6", Verdict.REFUTED),
        (GAUSS.format(b="0.5 0.5"), "symmetric", Verdict.PROVED),
        (GAUSS.format(b="0.4 0.6"), "symmetric", Verdict.REFUTED),
        ("0 |; 0.33333333333 | 0.33333333333; 0.66666666667 | 0 0.66666666667; | 0.25 0 0.75",
         "energy: 4", Verdict.UNDECIDED),
        ("p_next = p - h*q**3 + 0.00000000001*h; q_next = q + 0.90000000001*h*p_next", "energy: 2",
         Verdict.REFUTED),
    ],
)  # fmt: skip
def test_what_no_rounding_of_printed_coefficients_explains_is_refuted(
    scheme: str, keeps: str, verdict: Verdict
) -> None:
    assert prove("p**2/2 + q**4/4", scheme, asked(keeps)).verdict is verdict


def test_decimals_that_are_exact_in_one_reading_are_judged_in_all() -> None:
    """Of 0.5 and a long decimal the short one is exact in one reading, and rounded in another."""
    scheme = "kick 0.5; drift 1.00000000001; kick 0.5"
    kept = prove("p**2/2 + q**4/4", scheme, asked("energy"))
    assert (kept.verdict, kept.order) == (Verdict.REFUTED, 3)
