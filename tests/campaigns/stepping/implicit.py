"""Implicit methods in the plane as Python files, with the iteration and the tolerance written."""

from dataclasses import dataclass
from functools import cache

import sympy

SYSTEMS = {
    "pendulum": "p**2/2 - cos(q)",
    "quartic": "p**2/2 + q**4/4",
    "double-well": "p**2/2 - q**2/2 + q**4/4",
    "toda": "p**2/2 + exp(q) - q",
    "morse": "p**2/2 + (1 - exp(-q))**2",
    "relativistic": "sqrt(1 + p**2) + q**2/2",
    "swung": "p**2/(2*(1 + q**2/4)) - cos(q)",
    "product": "(1 + p**2)*(1 + q**2)/2",
    "steep": "p**4/4 + p**2/2 + q**2/2",
    "magnetic": "(p + q**2/3)**2/2 + q**2/2",
}
SOLVERS = ("fixed-point", "newton", "frozen", "scipy")
# Where derivatives of H are taken; the right sides of a and b; and what the step returns.
METHODS = {
    "midpoint": (("(p + a)/2, (q + b)/2",), "p - h*{hq0}", "q + h*{hp0}", "a", "b"),
    "symplectic-euler": (("a, q",), "p - h*{hq0}", "q + h*{hp0}", "a", "b"),
    "generalized-leapfrog": (
        ("a, q", "a, b"), "p - h/2*{hq0}", "q + h/2*({hp0} + {hp1})", "a - h/2*{hq1}", "b",
    ),
    "conjugate-trapezoid": (
        ("a, b",), "p - h/2*{hq0}", "q + h/2*{hp0}", "a - h/2*{hq0}", "b + h/2*{hp0}",
    ),
}  # fmt: skip

_LOOP = {
    "fixed-point": """
    for _ in range(200):
        r, s = g(p, q, h, a, b)
        a, b = a - r, b - s
        if abs(r) + abs(s) < TOLERANCE:
            break
""",
    "newton": """
    for _ in range(50):
        r, s = g(p, q, h, a, b)
        j, k, l, m = jacobian(p, q, h, a, b)
        u, v = (m*r - k*s)/(j*m - k*l), (j*s - l*r)/(j*m - k*l)
        a, b = a - u, b - v
        if abs(u) + abs(v) < TOLERANCE:
            break
""",
    "frozen": """
    j, k, l, m = jacobian(p, q, h, a, b)
    for _ in range(200):
        r, s = g(p, q, h, a, b)
        u, v = (m*r - k*s)/(j*m - k*l), (j*s - l*r)/(j*m - k*l)
        a, b = a - u, b - v
        if abs(u) + abs(v) < TOLERANCE:
            break
""",
    "scipy": """
    a, b = fsolve(lambda x: g(p, q, h, x[0], x[1]), [a, b], xtol=TOLERANCE)
    a, b = float(a), float(b)
""",
}


@dataclass(frozen=True)
class Implicit:
    """A method, its solver, and the tolerance 10^-digits, for an H by its name."""

    method: str
    solver: str
    digits: int
    system: str

    @property
    def name(self) -> str:
        return f"{self.method}_{self.solver}_{self.digits}_{self.system}".replace("-", "_")

    @property
    def traceable(self) -> bool:
        """Whether it is made of operations alone, which other numbers can do."""
        return self.solver != "scipy"

    def __str__(self) -> str:
        return f"{self.method} by {self.solver} to 1e-{self.digits} of {self.system}"


def source_of(step: Implicit) -> str:
    """The program; it calls `g` once for each iteration."""
    right, jacobian, ends = _formulas(step.method, step.system)
    library = "from scipy.optimize import fsolve\n" if step.solver == "scipy" else ""
    return f'''"""{step}."""

from math import cos, exp, log, sin, sqrt
{library}
TOLERANCE = 1e-{step.digits}


def g(p, q, h, a, b):
    return a - ({right[0]}), b - ({right[1]})


def jacobian(p, q, h, a, b):
    return {", ".join(jacobian)}


def step(p, q, h):
    a, b = p, q
{_LOOP[step.solver].strip(chr(10))}
    return {ends[0]}, {ends[1]}
'''


@cache
def _formulas(method: str, system: str) -> tuple[list[str], list[str], list[str]]:
    """The right side, the Jacobian of g by rows, and p' and q', all as Python has them."""
    p, q, _, a, b = names = sympy.symbols("p q h a b", real=True)
    known = {str(x): x for x in names}
    energy = sympy.sympify(SYSTEMS[system], locals=known)
    states, *texts = METHODS[method]
    put = {}
    for k, state in enumerate(states):
        x, y = (sympy.sympify(text, locals=known) for text in state.split(", "))
        at = {p: x, q: y}
        put[f"hp{k}"] = energy.diff(p).subs(at, simultaneous=True)
        put[f"hq{k}"] = energy.diff(q).subs(at, simultaneous=True)
    written = {name: f"({x})" for name, x in put.items()}
    formulas = [sympy.sympify(text.format(**written), locals=known) for text in texts]
    g = [x - y for x, y in zip((a, b), formulas[:2], strict=True)]
    jacobian = [str(x.diff(y)) for x in g for y in (a, b)]
    return [str(x) for x in formulas[:2]], jacobian, [str(x) for x in formulas[2:]]
