"""A scheme by formulas whose second force is read at a point made with the first one.

What sympy is asked about such formulas, the sign of a divisor above all, may never be answered.
"""

import time

import pytest

from verify.algebra import formula as formulas
from verify.algebra.domain import FormulaDomain
from verify.algebra.expressions.function_nodes import Requirement
from verify.algebra.formula import parse, read, symbol
from verify.effort import limit_effort
from verify.errors import LimitError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.schemes import get

FORCES = {
    "lennard-jones": (
        "1/(q1**2 + q2**2)**6 - 1/(q1**2 + q2**2)**3",
        "12*{x}/({s})**7 - 6*{x}/({s})**4",
        "({q1})**2 + ({q2})**2",
    ),
    "quartic": (
        "1/(q1**2 + q1*q2 + q2**2)**2",
        "2*(2*{x} + {y})/({s})**3",
        "({q1})**2 + ({q1})*({q2}) + ({q2})**2",
    ),
    "softened": ("-1/sqrt(1 + q1**2 + q2**2)", "-{x}/({s})**(3/2)", "1 + ({q1})**2 + ({q2})**2"),
}


def force(name: str, k: int, q1: str, q2: str) -> str:
    _, slope, size = FORCES[name]
    x, y = (q1, q2) if k == 1 else (q2, q1)
    return slope.format(x=f"({x})", y=f"({y})", s=size.format(q1=q1, q2=q2))


def nystroem(name: str) -> str:
    """Two forces a step, one within the other."""
    first = [f"q{i} + h/3*p{i}" for i in (1, 2)]
    second = [f"q{i} + 2*h/3*p{i} + h**2*2/9*({force(name, i, *first)})" for i in (1, 2)]
    p = [
        f"p{i}_next = p{i} + h/2*({force(name, i, *first)}) + h/2*({force(name, i, *second)})"
        for i in (1, 2)
    ]
    q = [f"q{i}_next = q{i} + h*p{i} + h**2/2*({force(name, i, *second)})" for i in (1, 2)]
    return "; ".join(p + q)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", FORCES)
def test_one_step_of_two_nested_forces_takes_seconds(name: str) -> None:
    hamiltonian = Hamiltonian.parse(f"p1**2/2 + p2**2/2 + {FORCES[name][0]}")
    begun = time.process_time()
    found = run(hamiltonian, nystroem(name), q=[1, "0.1"], p=["0.1", 1], step_size="0.01",
                steps=1, digits=12, t0=0, observables=["lambda"])  # fmt: skip
    assert time.process_time() - begun < 30
    assert found.status == "finished"
    assert abs(float(found.values["q1"].value) - 1.001) < 0.01


def test_what_is_not_simplified_in_time_is_asked_for_as_it_is_written() -> None:
    hamiltonian = Hamiltonian.parse(f"p1**2/2 + p2**2/2 + {FORCES['lennard-jones'][0]}")
    domain = get(nystroem("lennard-jones")).step_map(hamiltonian).domain
    assert "q1**2 + q2**2 != 0" in domain.texts
    long = [r for r in domain.requirements if len(str(r.expression)) > 100]
    assert long
    assert {r.relation for r in long} == {"!="}


def test_a_sign_that_is_seen_in_time_is_still_seen() -> None:
    q, h = symbol("q"), symbol("h")
    assert FormulaDomain.from_requirements([Requirement(1 + q**2 + h**4, "!=")]) == FormulaDomain()
    assert (
        FormulaDomain.from_requirements([Requirement(parse("q**4 + 2*q**2 + 3"), ">")])
        == FormulaDomain()
    )
    assert FormulaDomain.from_requirements([Requirement(parse("q**2 - 1"), ">")]).texts == (
        "q**2 - 1 > 0",
    )


def test_a_formula_that_is_not_read_in_time_is_refused_by_its_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert read("sin(q)/(1 + cos(q)**2)", source="made")
    monkeypatch.setattr(formulas, "limit_effort", lambda *of: limit_effort(*of, most=20))
    with pytest.raises(LimitError, match=r"made=tanh.*: to read it takes too long"):
        read("tanh(q/7)/(1 + cos(3*q)**2)", source="made")
