"""The same steps done without the toolkit: by Fractions where H is a polynomial, else by balls.

The map and det J − 1 are derived by sympy alone, and then evaluated as they stand, number by number
(`exact`), or in balls of so many bits that their radii do not matter (`enclosed`): what is returned
holds the values of exact arithmetic.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from typing import Any

import flint
import sympy

from tests.helpers.sampled.formulas import H, P, Q, lie_step, plain, plain_delta_j
from verify.arithmetic.arb import is_representable, midpoint_and_radius, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun

OBSERVABLES = frozenset({"lambda", "lambda_max", "mse", "delta_j_max"})
True_ = tuple[Fraction, Fraction]  # a value and the radius around it in which the true one is
_NOTHING = Fraction(1, 2**800)
_FUNCTIONS = ("sin", "cos", "exp", "log", "sinh", "cosh", "atan", "sqrt")


@dataclass(frozen=True)
class Case:
    """An orbit: of which H, by which scheme, from where, how far."""

    text: str
    scheme: str
    q: Fraction
    p: Fraction
    h: Fraction
    steps: int
    parameters: Mapping[str, Fraction] = field(default_factory=dict, hash=False)

    def kernel_run(self, observables: frozenset[str] = OBSERVABLES) -> KernelRun:
        start = {"p": self.p, "q": self.q, "h": self.h}
        h = Hamiltonian.parse(self.text, self.parameters)
        return KernelRun(h, self.scheme, start, self.steps, observables, 0)


def case(text: str, scheme: str, q: Any, p: Any, h: Any, steps: int, **parameters: Any) -> Case:
    exact = {name: Fraction(x) for name, x in parameters.items()}
    return Case(text, scheme, Fraction(q), Fraction(p), Fraction(h), steps, exact)


@cache
def _step(text: str, scheme: str) -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """(p', q', ΔJ) as sympy derives them."""
    if "=" in scheme:
        formulas = dict(part.split("=") for part in scheme.replace(" ", "").split(";"))
        p_next = plain(formulas["p_next"])
        q_next = plain(formulas["q_next"].replace("p_next", f"({p_next})"))
    elif scheme == "symplectic-euler":
        hamiltonian = plain(text)
        p_next = P - H * hamiltonian.diff(Q)
        q_next = Q + H * hamiltonian.diff(P).subs(P, p_next)
    else:
        p_next, q_next = lie_step(plain(text), int(scheme.removeprefix("lie")))
    return p_next, q_next, plain_delta_j(p_next, q_next)


def _function(
    case: Case,
    number: Callable[[Fraction], Any],
    names: Mapping[str, Any],
    of: Sequence[sympy.Expr] = (),
) -> Any:
    """(p, q) ↦ [p', q', ΔJ], or other expressions, in some numbers.

    sympy prints a rational as a quotient of ints, so each is handed over as a number.
    """
    put = {sympy.Symbol(n, real=True): sympy.Rational(x) for n, x in case.parameters.items()}
    put[H] = sympy.Rational(case.h)
    expressions = [x.subs(put) for x in of or _step(case.text, case.scheme)]
    rationals = {
        r: sympy.Symbol(f"r{k}")
        for k, r in enumerate(sorted({r for x in expressions for r in x.atoms(sympy.Rational)}))
        if not r.is_Integer
    }
    numbered = [_with_powers(x.xreplace(rationals)) for x in expressions]
    shared, results = sympy.cse(numbered, order="none")
    known = {str(s): number(Fraction(int(r.p), int(r.q))) for r, s in rationals.items()}
    known["power"] = _power
    return sympy.lambdify(
        (P, Q), results, modules=[{**known, **names}], cse=lambda _: (shared, results)
    )


def _with_powers(x: sympy.Expr) -> sympy.Expr:
    """Powers to integers by `_power`, as Arb's own are not defined around 0."""
    power = sympy.Function("power")
    return x.replace(lambda e: e.is_Pow and e.exp.is_Integer, lambda e: power(e.base, e.exp))


def _power(x: Any, n: int) -> Any:
    if n < 0:
        return 1 / _power(x, -n)
    half = _power(x, n // 2) if n > 1 else 1
    return half * half * x if n % 2 else half * half


def _values(step: Any, p: Any, q: Any, steps: int, zero: Any, greatest: Any) -> dict[str, Any]:
    product, squares, top, highest = zero + 1, zero, zero, zero
    for _ in range(steps):
        after_p, after_q, delta_j = step(p, q)
        product, squares = product * (1 + delta_j), squares + delta_j * delta_j
        top = greatest(top, abs(delta_j))
        highest = greatest(highest, abs(product - 1))
        p, q = after_p, after_q
    return {"p": p, "q": q, "lambda": product - 1, "lambda_max": highest, "mse": squares / steps,
            "delta_j_max": top}  # fmt: skip


def exact(case: Case) -> dict[str, True_]:
    """By rational numbers, which grow: a few steps of a polynomial H."""
    step = _function(case, Fraction, {})
    found = _values(step, case.p, case.q, case.steps, Fraction(0), max)
    return {name: (Fraction(x), Fraction(0)) for name, x in found.items()}


def enclosed(case: Case, bits: int) -> dict[str, True_] | None:
    """By balls of so many bits; None where one of them is not finite."""
    with working_precision(bits):
        names = {n: getattr(flint.arb, n) for n in _FUNCTIONS} | {"pi": flint.arb.pi()}
        step = _function(case, rational_ball, names)
        start = rational_ball(case.p), rational_ball(case.q)
        found = _values(step, *start, case.steps, flint.arb(0), flint.arb.max)
        if not all(is_representable(x) for x in found.values()):
            return None
        return {name: midpoint_and_radius(x) for name, x in found.items()}


def enclosed_finely(case: Case, errors: Mapping[str, Fraction]) -> dict[str, True_]:
    """By balls so narrow that their radii are nothing beside these errors, or beside anything."""
    for bits in (256, 512, 1024, 2048, 4096, 8192, 16384):
        true = enclosed(case, bits)
        if true and all(1000 * true[n][1] <= max(error, _NOTHING) for n, error in errors.items()):
            return true
    raise AssertionError(f"balls blow up: {case}")


def assert_contained(
    found: Mapping[str, Fraction],
    errors: Mapping[str, Fraction],
    true: Mapping[str, True_],
    what: object,
) -> None:
    """Each value is within its error of the true one."""
    for name, error in errors.items():
        middle, radius = true[name]
        off = abs(found[name] - middle)
        assert off <= error + radius, f"{name} is {float(off / error):.4g} of its bound off: {what}"


def jacobian(case: Case, p: Fraction, q: Fraction) -> list[Any]:
    """The four derivatives of one step there, row by row, as balls in the present precision."""
    p_next, q_next, _ = _step(case.text, case.scheme)
    entries = [x.diff(y) for x in (p_next, q_next) for y in (P, Q)]
    names = {n: getattr(flint.arb, n) for n in _FUNCTIONS} | {"pi": flint.arb.pi()}
    values = _function(case, rational_ball, names, entries)(rational_ball(p), rational_ball(q))
    return [flint.arb(0) + x for x in values]
