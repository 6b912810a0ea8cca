"""The manual's table of twelve methods: what is proved of each is what the literature says, and the
orders are those that steps in mpmath have."""

import re
from dataclasses import replace
from typing import Any

import pytest
import sympy

from docs._generate.classical_methods import METHODS, Method, boris, label_of, proved, rigid_body
from docs._generate.parts.classical_methods import text
from tests.helpers.stepping.kept_structures import (
    SCHEMES,
    Field,
    Kept,
    Step,
    by_formulas,
    mp,
    order_of,
)
from verify.hamiltonians.equations import read_system

BY_NAME = {method.name: method for method in METHODS}
# True where a theorem says that it is kept exactly, False where one says that it is not.
LITERATURE = {
    "Störmer–Verlet": {"the form": True, "volume": True, "angular-momentum": True,
                       "symmetric": True, "reversible": True, "energy": False},
    "RK4": {"the form": False, "volume": False, "angular-momentum": False, "symmetric": False,
            "reversible": False, "energy": False},
    "implicit midpoint": {"the form": True, "volume": True, "angular-momentum": True,
                          "symmetric": True, "reversible": True, "energy": False},
    "Gauss 4": {"the form": True, "volume": True, "angular-momentum": True, "symmetric": True,
                "reversible": True, "energy": False},
    "average vector field": {"v**2/2 + x**3/3": True, "the form": False, "volume": False},
    "Kahan": {"the form": True, "symmetric": True, "u + v - log(u) - 2*log(v)": False},
    "Boris": {"volume": True, "the form": False, "symmetric": True, "reversible": True,
              "v**2/2 + w**2/2 + x**2/2 + y**2": False},
    "Vay": {"volume": False},
    "leapfrog of Hamiltonian Monte Carlo": {"volume": True, "reversible": True, "energy": False},
    "symplectic Euler for Lotka–Volterra": {"the form": True, "the bracket": True,
                                            "symmetric": False,
                                            "u + v - log(u) - 2*log(v)": False},
    "rigid body by splitting": {"the bracket": True, "Casimir x**2 + y**2 + z**2": True,
                                "volume": True, "x**2/2 + y**2/4 + z**2/6": False},
    "Störmer–Verlet for Kepler": {"the form": True, "volume": True, "angular-momentum": True,
                                  "symmetric": True, "reversible": True, "energy": False},
}  # fmt: skip


def test_there_are_twelve_and_the_literature_speaks_of_each() -> None:
    assert len(METHODS) == 12
    assert list(LITERATURE) == list(BY_NAME)


@pytest.mark.parametrize("name", LITERATURE)
def test_no_row_differs_from_the_literature_and_none_is_left_open(name: str) -> None:
    assert {label_of(x): x.is_kept for x in proved()[name]} == LITERATURE[name]


def test_the_table_has_what_is_proved() -> None:
    rows = {row.split(" | ")[0].removeprefix("| "): row for row in text().splitlines()[2:]}
    assert list(rows) == list(BY_NAME)
    assert "energy: h^3, telescopes" in rows["Störmer–Verlet"]
    assert "volume: h^3" in rows["Vay"]
    assert "`v**2/2 + x**3/3` | the form: h^3" in rows["average vector field"]
    assert not [row for row in rows.values() if "not decided" in row]


# -- the orders, by steps that share no code ------------------------------------------------------


def plain(formula: str, names: tuple[str, ...]) -> sympy.Expr:
    extra = {f"{n}_next": sympy.Symbol(f"{n}_next") for n in names}
    return sympy.sympify(formula, {**{n: sympy.Symbol(n) for n in (*names, "h")}, **extra})


def field_of(method: Method) -> Field:
    system = read_system(method.system)
    names = system.coordinates
    if system.energy is None:
        pairs = (x.split("=") for x in method.system.split(";"))
        slopes = {left.strip().removesuffix("_dot"): plain(right, names) for left, right in pairs}
        return Field(names, tuple(slopes[n] for n in names))
    energy, half = plain(method.system, names), len(names) // 2
    z = [sympy.Symbol(n) for n in names]
    return Field(names, (*(-energy.diff(q) for q in z[half:]), *(energy.diff(p) for p in z[:half])))


def step_of(method: Method, field: Field) -> Step:
    if method.scheme in SCHEMES:
        return SCHEMES[method.scheme](field)
    pairs = (x.split("=") for x in method.scheme.split(";"))
    ends = {a.strip().removesuffix("_next"): plain(b, field.names) for a, b in pairs}
    return by_formulas(field.names, ends)


def kept_of(method: Method, label: str, field: Field) -> Kept:
    names, one = field.names, sympy.Integer(1)
    z, half = [sympy.Symbol(n) for n in names], len(names) // 2
    if label == "reversible":
        text = method.refined.get("reverses") or ", ".join(
            f"-{n}" if k < half else n for k, n in enumerate(names)
        )
        return Kept("reversible", tuple(plain(x, names) for x in text.split(",")))
    if label == "the form":
        form = method.refined.get("form")
        if form is None:
            return Kept("form", (one,) * half, tuple((k, half + k) for k in range(half)))
        pairs = re.findall(r"d(\w)\^d(\w)", form)
        marks = {f"m{k}": sympy.Symbol(f"m{k}") for k in range(len(pairs))}
        for k, (a, b) in enumerate(pairs):
            form = form.replace(f"d{a}^d{b}", f"m{k}", 1)
        x = sympy.sympify(form, {**{n: sympy.Symbol(n) for n in names}, **marks})
        return Kept("form", tuple(x.diff(m) for m in marks.values()),
                    tuple((names.index(a), names.index(b)) for a, b in pairs))  # fmt: skip
    integrals = {"angular-momentum": "q1*p2 - q2*p1", "energy": method.system}
    kinds = {"volume": Kept("volume", (one,)), "symmetric": Kept("symmetric")}
    if label == "the bracket":
        rows = [[plain(x, names) for x in row.split(",")]
                for row in method.refined["poisson"].split(";")]  # fmt: skip
        places = [(a, b) for a in range(len(z)) for b in range(a + 1, len(z)) if rows[a][b] != 0]
        return Kept("poisson", tuple(rows[a][b] for a, b in places), tuple(places))
    formula = integrals.get(label, label.removeprefix("Casimir "))
    return kinds.get(label) or Kept("integral", (plain(formula, names),))


@pytest.mark.parametrize("name", BY_NAME)
def test_every_order_is_that_of_a_step_in_mpmath(name: str) -> None:
    method = BY_NAME[name]
    field = field_of(method)
    step, at = step_of(method, field), list(map(mp.mpf, ("0.62", "0.35", "0.81", "0.47")))
    for proof in proved()[name]:
        kept = kept_of(method, label_of(proof), field)
        order = order_of(kept, field.names, step, at[: len(field.names)], mp.mpf(0))
        assert proof.order == order, label_of(proof)
        assert proof.is_kept is (order is None)


# -- a mistake in a method is seen -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "scheme", "lost"),
    [
        ("Boris", boris().replace("v_next = ((1 - ", "v_next = ((1 + "), "volume"),
        ("Boris", boris().replace("y_next = (y + h/2*w)", "y_next = (y + h*w)"), "symmetric"),
        ("Kahan", "u_next = u*(1 + h*(v - 2)); v_next = v*(1 + h*(1 - u))", "the form"),
        ("rigid body by splitting", rigid_body((0, "1")).replace("sin", "2*sin"), "the bracket"),
        ("average vector field", "x_next = x + h*v; v_next = v - h*x_next**2", "v**2/2 + x**3/3"),
        ("symplectic Euler for Lotka–Volterra",
         "u_next = u*(1 + h*(v - 2)); v_next = v/(1 - h*(1 - u))", "the form"),
    ],
)  # fmt: skip
def test_a_method_with_a_mistake_keeps_less(name: str, scheme: str, lost: str) -> None:
    assert scheme != BY_NAME[name].scheme
    proofs = replace(BY_NAME[name], scheme=scheme).proofs()
    answers: dict[str, Any] = {label_of(x): x.is_kept for x in proofs}
    assert LITERATURE[name][lost] is True
    assert answers[lost] is False
