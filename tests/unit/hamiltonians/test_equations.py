"""Systems without an H, z' = f(z, t): read, written, compared, sent to a worker, and refused."""

import pickle

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, field_of, require_canonical
from verify.hamiltonians.equations import Equations, are_equations, read_system
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.structures import PLAIN_VOLUME

LOTKA = "u_dot = u*(v - 2); v_dot = v*(1 - u)"


def read(text: str, **parameters: object) -> Equations:
    system = read_system(text, parameters)  # type: ignore[arg-type]
    assert isinstance(system, Equations)
    return system


def test_equations_have_their_names_in_their_order() -> None:
    system = read("w_dot = a*u; u_dot = -w; B2_dot = t")
    assert system.coordinates == ("w", "u", "B2")
    assert system.parameters == ("a",)
    assert system.time_dependent
    assert system.energy is None
    assert system.structure is PLAIN_VOLUME
    assert not system.planar


def test_a_text_without_equations_is_an_h() -> None:
    assert not are_equations("p**2/2 + q**2/2")
    assert not isinstance(read_system("p**2/2 + q**2/2"), Equations)
    assert are_equations(LOTKA)


# -- the text -------------------------------------------------------------------------------------

_LEAVES = st.sampled_from(["u", "v", "a", "t", "2", "3", "1/2", "0.3", "(-1)"])
_SUMS = st.recursive(
    _LEAVES,
    lambda x: st.one_of(
        st.tuples(x, st.sampled_from("+-**"), x).map(lambda y: f"({''.join(y)})"),
        st.tuples(st.sampled_from(["sin", "exp", "atan"]), x).map(lambda y: f"{y[0]}({y[1]})"),
        x.map(lambda y: f"({y})**2"),
    ),
    max_leaves=12,
)


@given(_SUMS, _SUMS)
def test_the_text_is_read_back_as_the_same_equations(first: str, second: str) -> None:
    system = read_system(f"u_dot = {first}; v_dot = {second}")
    again = read_system(system.formula)
    assert again.expression == system.expression
    assert again.formula == system.formula


def test_a_number_before_a_sum_is_settled_before_it_is_written() -> None:
    system = read("v_dot = v*27**2*5*((a - 3)*(v - 1/2))/4; u_dot = 1")
    assert read(system.formula) == system


# -- parameters -----------------------------------------------------------------------------------


def test_values_stand_in_place_of_parameters() -> None:
    system = read("u_dot = a*u + b; v_dot = v", a="1/2")
    assert str(system.exact) == "(b + u/2, v)"
    assert system.symbols == ("b",)
    assert system.texts == {"hamiltonian": "u_dot = a*u + b; v_dot = v", "parameters": {"a": "0.5"}}
    assert read(system.formula, **dict(system.values)) == system
    assert read("u_dot = a*sin(t)", a=0).time_dependent is False
    assert read("u_dot = a*u + v; v_dot = u", a=0).with_symbols().formula == "u_dot = v; v_dot = u"


@pytest.mark.parametrize(
    ("text", "parameters", "problem"),
    [("u_dot = a*u", {"b": 1}, "no such parameter; it has: a"),
     ("u_dot = a*u", {"u": 1}, "no such parameter"),
     ("u_dot = u/a", {"a": 0}, "it is not defined"),
     ("u_dot = a*t", {"t": 1}, "not a parameter name"),
     ("u_dot = a*u", {"a": "x"}, "a=x")],
)  # fmt: skip
def test_bad_values_are_refused(text: str, parameters: dict[str, object], problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        read(text, **parameters)


def test_parameters_that_are_no_mapping_are_refused() -> None:
    with pytest.raises(InputError, match="is not a mapping"):
        read_system("u_dot = a*u", [1])  # type: ignore[arg-type]


# -- what is refused ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "problem"),
    [("u_dot =", "empty"), ("_dot = v", "is no equation"), ("u_dot = 1;; v_dot = 2", "no equation"),
     ("u_dot = v; v = 3", "is no equation"), ("é_dot = 1", "is no equation"),
     ("u _dot = 1", "is no equation"), ("_0_dot = 1", "is no equation"),
     ("u_dot = v; u_dot = u", "stands twice"), ("h_dot = 1", "h is no name of a coordinate"),
     ("t_dot = 1", "t is no name"), ("pi_dot = 1", "pi is no name"), ("sin_dot = 1", "sin is no"),
     ("lambda_dot = 1", "lambda is no name"), ("x_dot_dot = x", "x_dot is no name"),
     ("x_dot = v; v_dot = x_dot", "has x_dot; write its formula"),
     ("u_dot == v; v_dot = u", "a formula has no ="), ("u_dot = v = 3", "a formula has no ="),
     ("u_dot = abs(u)", "abs is not smooth"), ("u_dot = 1/0", "division by zero"),
     ("u_dot = 1/(u - u)", "division by zero"), ("u_dot = u**u", "exponent"),
     ("u_dot = __import__('os')", "unknown function"), ("u_dot = oo", "stands for something else"),
     ("u_dot = u.real", "a name has no point"), ("u_dot = [u]", "write ( )"),
     ("; ".join(f"x{k}_dot = 1" for k in range(129)), "has 129 coordinates; allowed: 1 … 128"),
     ("u_dot = 1; \N{RIGHT-TO-LEFT OVERRIDE}v_dot = 2", "no equation")],
)  # fmt: skip
def test_bad_equations_are_refused_in_one_line(text: str, problem: str) -> None:
    with pytest.raises(InputError) as caught:
        read_system(text)
    assert problem in str(caught.value)
    assert str(caught.value).isprintable()


def test_names_of_sympy_are_plain_names() -> None:
    system = read("S_dot = -N*S*I; E_dot = Q; I_dot = E; N_dot = 0; Q_dot = beta")
    assert system.coordinates == ("S", "E", "I", "N", "Q")
    assert str(system.exact[0]) == "-I*N*S"


@pytest.mark.parametrize("ask", [lambda x: x.halves([1, 2]), lambda x: x.gradient()])
def test_what_takes_p_and_q_is_refused(ask: object) -> None:
    with pytest.raises(InputError, match="has no p and q"):
        ask(read(LOTKA))  # type: ignore[operator]
    field, _ = field_of(read(LOTKA))
    with pytest.raises(InputError, match="has no H"):
        require_canonical(field)


# -- equality -------------------------------------------------------------------------------------


def test_equal_equations_are_equal_and_have_one_hash() -> None:
    same = read("u_dot = (v - 2)*u; v_dot = (1 - u)*v")
    assert same == read(LOTKA)
    assert hash(same) == hash(read(LOTKA))


@pytest.mark.parametrize(
    "other",
    ["v_dot = v*(1 - u); u_dot = u*(v - 2)", "a_dot = a*(v - 2); v_dot = v*(1 - a)",
     "u_dot = u*(v - 2); v_dot = v*(2 - u)", "u_dot = sqrt(u)*sqrt(u)*(v - 2); v_dot = v*(1 - u)"],
)  # fmt: skip
def test_other_equations_are_not_equal(other: str) -> None:
    assert read(other) != read(LOTKA)


def test_an_h_is_no_equations_though_the_field_is_the_same() -> None:
    equations = read("p_dot = -q; q_dot = p")
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2")
    assert equations != hamiltonian
    assert hamiltonian != equations
    field, _ = field_of(equations)
    assert not isinstance(field, CanonicalField)
    canonical, _ = field_of(hamiltonian)
    assert list(map(str, field.slopes)) == list(map(str, canonical.slopes))


def test_values_and_domains_are_kept_apart_in_caches() -> None:
    wide, narrow = read("x_dot = a*x"), read("x_dot = a*sqrt(x)*sqrt(x)")
    assert [x.with_values({"a": 2}).domain.texts for x in (wide, narrow)] == [(), ("x >= 0",)]
    assert field_of(read("x_dot = a*x", a=2))[0] is not field_of(read("x_dot = a*x", a=3))[0]
    assert field_of(read("x_dot = a*x", a=2))[0] is field_of(read("x_dot = x*a", a=2))[0]


@pytest.mark.parametrize(
    "system", [read(LOTKA), read("x_dot = a*sqrt(x)*sqrt(x) + t", a="1/3")], ids=repr
)
def test_equations_are_sent_to_a_worker(system: Equations) -> None:
    sent = pickle.loads(pickle.dumps(system))  # noqa: S301 - our own bytes
    assert sent == system
    assert sent.names == system.names
    assert sent.domain == system.domain


def test_equations_are_shown() -> None:
    system = read("u_dot = a*v1/2; v1_dot = -u", a=2)
    assert repr(system) == "Equations(u_dot = a*v1/2; v1_dot = -u, a = 2)"
    assert r"\dot{u} &= \frac{a v_{1}}{2}" in system._repr_latex_()
    assert "a &= 2" in system._repr_latex_()


# -- the field ------------------------------------------------------------------------------------


def test_derivatives_along_the_field_are_sympy_s() -> None:
    system = read("x_dot = y*z + t; y_dot = x*exp(x); z_dot = -a*x**2")
    field, (extra,) = field_of(system, system.exact[0] * 3)
    x, y, z, t = (sympy.Symbol(n, real=True) for n in "xyzt")
    slopes, rows = list(system.exact), [[x, y, z]]
    for _ in range(4):
        rows.append([e.diff(t) + sum(f * e.diff(w) for f, w in zip(slopes, (x, y, z), strict=True))
                     for e in rows[-1]])  # fmt: skip
    for n, row in enumerate(rows):
        for element, expected in zip(field.power(n), row, strict=True):
            assert sympy.expand(field.ring.expression(element) - expected) == 0
    assert sympy.expand(field.ring.expression(extra) - 3 * slopes[0]) == 0
