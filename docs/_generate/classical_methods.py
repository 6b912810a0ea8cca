"""Twelve methods of the field with a system for each, and what a step keeps of it, as is proved."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import sympy

from verify.hamiltonians.equations import read_system
from verify.proof.structures.structure_order import StructureProof
from verify.proof.structures.structures_proof import prove_structures
from verify.schemes import get
from verify.structures.reading import KeepsRequest, read_structures

ENERGY, SYMMETRIC, REVERSIBLE = "energy", "symmetric", "reversible"
_x, _y, _z, _u, _v, _w, _h = sympy.symbols("x y z u v w h")


@dataclass(frozen=True)
class Method:
    """A method for a system. `agrees`: the theorem that says the same."""

    name: str
    system: str
    scheme: str
    keeps: tuple[str, ...]
    agrees: str
    of: str  # the system in words
    refined: Mapping[str, Any] = field(default_factory=dict)

    def proofs(self) -> Sequence[StructureProof]:
        """Return what is proved of each structure."""
        system, scheme = read_system(self.system), get(self.scheme)
        request = KeepsRequest(keeps=self.keeps, **self.refined)
        claims = read_structures(request, system)
        return prove_structures(scheme.step_map(system), claims, scheme).keeps


def next_texts(ends: Mapping[str, sympy.Expr | str]) -> str:
    """Return a step as formulas."""
    return "; ".join(f"{name}_next = {x}" for name, x in ends.items())


# -- formulas that a person would not write out ---------------------------------------------------


def kahan() -> str:
    """Return Kahan's step of u' = u (v − 2), v' = v (1 − u): products are polarized."""
    new_u, new_v = sympy.symbols("new_u new_v")
    mixed = (_u * new_v + new_u * _v) / 2
    equations = [
        new_u - _u - _h * (mixed - (_u + new_u)),
        new_v - _v - _h * ((_v + new_v) / 2 - mixed),
    ]
    solution = sympy.solve(equations, [new_u, new_v])
    return next_texts({"u": sympy.factor(solution[new_u]), "v": sympy.factor(solution[new_v])})


def boris(field_strength: str = "(1 + x**2)") -> str:
    """Return half a drift, half a kick, a turn by Cayley's formula, and back."""
    half = {"x": "(x + h/2*v)", "y": "(y + h/2*w)"}
    b = field_strength.replace("x", half["x"])
    a, c = f"(v - h/2*{half['x']})", f"(w - h*{half['y']})"  # −x and −2y are the electric field
    t = f"(h/2*{b})"
    return next_texts({
        "v": f"((1 - {t}**2)*{a} + 2*{t}*{c})/(1 + {t}**2) - h/2*{half['x']}",
        "w": f"((1 - {t}**2)*{c} - 2*{t}*{a})/(1 + {t}**2) - h*{half['y']}",
        "x": f"{half['x']} + h/2*v_next", "y": f"{half['y']} + h/2*w_next",
    })  # fmt: skip


def vay() -> str:
    """Return Vay's relativistic push in the fields E = (1, 0), B = 1, with c = 1."""
    g = "sqrt(1 + u**2 + w**2)"
    a, c = f"(u + h + h/2*w/{g})", f"(w - h/2*u/{g})"
    sigma = f"(1 + {a}**2 + {c}**2 - h**2/4)"
    t = f"(h/(2*sqrt(({sigma} + sqrt({sigma}**2 + h**2))/2)))"
    return next_texts({"u": f"({a} + {c}*{t})/(1 + {t}**2)", "w": f"({c} - {a}*{t})/(1 + {t}**2)"})


def rigid_body(*parts: tuple[int, str]) -> str:
    """Return exact turns about the axes 0, 1, 2, each for a part of h; moments 1, 2, 3."""
    state: list[sympy.Expr] = [_x, _y, _z]
    for k, size in parts:
        i, j = (k + 1) % 3, (k + 2) % 3
        angle = _h * sympy.Rational(size) * state[k] / (k + 1)
        c, s, a, b = sympy.cos(angle), sympy.sin(angle), state[i], state[j]
        state[i], state[j] = c * a + s * b, c * b - s * a
    return next_texts(dict(zip("xyz", state, strict=True)))


# -- the methods ----------------------------------------------------------------------------------

QUARTIC = "(p1**2 + p2**2)/2 + (q1**2 + q2**2)**2/4"
_ALL = ("symplectic", "volume", ENERGY, "angular-momentum", SYMMETRIC, REVERSIBLE)
_CUBE = "(x + h*v - h**2*x**2/6)"
_ROOT = f"sqrt((1 + h**2*x/6)**2 + 2*h**2/3*{_CUBE})"
LOTKA = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
LOTKA_H = "u + v - log(u) - 2*log(v)"
LOG_FORM = {"form": "du^dv/(u*v)"}
_HLW = "Hairer, Lubich, Wanner"

METHODS = (
    Method("Störmer–Verlet", QUARTIC, "stormer-verlet", _ALL,
           f"{_HLW}, theorems VI.3.4 and IV.2.3, V.1", "a central force in the plane"),
    Method("RK4", QUARTIC, "rk4", _ALL, f"{_HLW}, IV.1.5: linear integrals alone",
           "a central force in the plane"),
    Method("implicit midpoint", QUARTIC, "implicit-midpoint", _ALL,
           f"{_HLW}, theorems VI.4.2, IV.2.1, V.2", "a central force in the plane"),
    Method("Gauss 4", QUARTIC, "gauss4", _ALL, f"{_HLW}, theorems VI.4.2, IV.2.1, V.2",
           "a central force in the plane"),
    Method("average vector field", "v_dot = -x**2; x_dot = v",
           f"x_next = 2*{_CUBE}/(1 + h**2*x/6 + {_ROOT});"
           " v_next = v - h*(x**2 + x*x_next + x_next**2)/3",
           ("v**2/2 + x**3/3", "symplectic", "volume"),
           "Quispel, McLaren 2008: energy; Chartier, Faou, Murua 2006: not both",
           "a cubic H, whose equations a root solves", {"form": "dv^dx"}),
    Method("Kahan", LOTKA, kahan(), ("symplectic", LOTKA_H, SYMMETRIC),
           "Sanz-Serna 1994: the form du∧dv/(uv)", "Lotka–Volterra", LOG_FORM),
    Method("Boris", "v_dot = -x + (1 + x**2)*w; w_dot = -2*y - (1 + x**2)*v; x_dot = v; y_dot = w",
           boris(), ("volume", "symplectic", "v**2/2 + w**2/2 + x**2/2 + y**2", SYMMETRIC,
                     REVERSIBLE),
           "Qin and others 2013: volume; Ellison, Burby, Qin 2015: not symplectic",
           "a charge in a magnetic field 1 + x²",
           {"form": "dv^dx + dw^dy + (1 + x**2)*dx^dy", "reverses": "-v, w, x, -y"}),
    Method("Vay", "u_dot = 1 + w/sqrt(1 + u**2 + w**2); w_dot = -u/sqrt(1 + u**2 + w**2)", vay(),
           ("volume",), "Higuera, Cary 2017: not volume",
           "a relativistic charge in constant fields"),
    Method("leapfrog of Hamiltonian Monte Carlo",
           "(p1**2 + p2**2)/2 + q1**2/2 + (q2 - q1**2)**2", "stormer-verlet",
           ("volume", REVERSIBLE, ENERGY), "Duane and others 1987; Neal 2011",
           "a bent normal distribution"),
    Method("symplectic Euler for Lotka–Volterra", LOTKA,
           "u_next = u*(1 + h*(v - 2)); v_next = v/(1 - h*(1 - u_next))",
           ("symplectic", "poisson", LOTKA_H, SYMMETRIC), f"{_HLW}, VII.4",
           "Lotka–Volterra", {**LOG_FORM, "poisson": "0, u*v; -u*v, 0"}),
    Method("rigid body by splitting",
           "x_dot = -y*z/6; y_dot = 2*z*x/3; z_dot = -x*y/2",
           rigid_body((0, "1/2"), (1, "1/2"), (2, "1"), (1, "1/2"), (0, "1/2")),
           ("poisson", "volume", "x**2/2 + y**2/4 + z**2/6"),
           f"McLachlan 1993; Reich 1994; {_HLW}, VII.5", "a free rigid body",
           {"poisson": "0, z, -y; -z, 0, x; y, -x, 0", "casimirs": ("x**2 + y**2 + z**2",)}),
    Method("Störmer–Verlet for Kepler", "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)",
           "stormer-verlet", _ALL, f"{_HLW}, I.2.3 and IV.2.3", "Kepler's problem"),
)  # fmt: skip


@cache
def proved() -> Mapping[str, Sequence[StructureProof]]:
    """Return the proofs for each method."""
    return {method.name: method.proofs() for method in METHODS}


def label_of(proof: StructureProof) -> str:
    """Return a structure's name in a table."""
    name = proof.structure.name
    if name == "casimir":
        return proof.structure.label
    return {"symplectic": "the form", "area": "area", "poisson": "the bracket"}.get(name, name)


def kept_exactly(proofs: Sequence[StructureProof]) -> Iterator[str]:
    """Yield the structures that are kept exactly."""
    return (label_of(x) for x in proofs if x.is_kept)


def kept_up_to(proofs: Sequence[StructureProof]) -> Iterator[str]:
    """Yield the others, with the power of h at which the defect of one step begins."""
    for x in proofs:
        if not x.is_kept:
            power = "not decided" if x.order is None else f"h^{x.order}"
            telescopes = ", telescopes" if x.telescopes else ""
            yield f"{label_of(x)}: {power}{telescopes}"
