"""Implicit Runge–Kutta steps without the toolkit, and steps of the toolkit's kernels.

By hand the stages' equations are solved in mpmath at many digits, by fixed-point iteration, which
shares nothing with Newton's method, from derivatives that sympy makes.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import sympy
from mpmath.ctx_mp import MPContext

from tests.helpers.sampled.formulas import P, Q, plain
from verify import arithmetic as number_systems
from verify.arithmetic.number_system import interpret
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel, KernelWriter
from verify.schemes import get
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.maps.step_map import StepMap
from verify.schemes.methods.runge_kutta import gauss4, gauss6, implicit_midpoint

TABLEAUS = {
    "implicit-midpoint": implicit_midpoint.TABLEAU,
    "gauss4": gauss4.TABLEAU,
    "gauss6": gauss6.TABLEAU,
}
# Of order 3, and not area-preserving.
_RADAU = (sympy.Rational(3, 4), sympy.Rational(1, 4))
RADAU = ImplicitTableau.from_numbers(
    ((sympy.Rational(5, 12), sympy.Rational(-1, 12)), _RADAU), _RADAU
)
NONLINEAR = {
    "pendulum": "p**2/2 - cos(q)",
    "duffing": "p**2/2 + q**2/2 + q**4/4",
    "not separable": "p**2*(1 + q**2)/2 + q**2/2",
    "exponential": "exp(p) + p*q**2/4 + q**2",
    "quotient": "p**2/(2*(1 + q**2)) + log(1 + q**2)",
}
Pair = tuple[Fraction, Fraction]


def planted(tableau: ImplicitTableau, i: int, j: int, error: sympy.Rational) -> ImplicitTableau:
    """With an error in a_ij; in b_j for i beyond the rows."""
    rows = [list(row) for row in (*tableau.rows, tableau.weights)]
    rows[i][j] += error
    return ImplicitTableau.from_numbers(rows[:-1], rows[-1])


def places(tableau: ImplicitTableau) -> list[tuple[int, int]]:
    """Of all the coefficients."""
    return [(i, j) for i in range(tableau.stages + 1) for j in range(tableau.stages)]


# -- by hand --------------------------------------------------------------------------------------


@cache
def _field(text: str) -> tuple[sympy.Expr, sympy.Expr]:
    return -plain(text).diff(Q), plain(text).diff(P)


def by_hand(text: str, tableau: ImplicitTableau, z: Pair, h: Fraction, digits: int) -> Pair:
    """One step to so many digits and ten more."""
    context = MPContext()
    context.dps = digits + 10
    number: Callable[[Any], Any] = lambda x: context.mpf(x.numerator) / x.denominator  # noqa: E731
    f = [_function(x, context) for x in _field(text)]
    exact = [[context.mpf(sympy.N(x, digits + 20)) for x in row]
             for row in (*tableau.rows, tableau.weights)]  # fmt: skip
    p, q, step = number(z[0]), number(z[1]), number(h)
    count = tableau.stages
    slopes = [(context.mpf(0), context.mpf(0))] * count

    def moved(row: Sequence[Any]) -> tuple[Any, Any]:
        both = (sum(a * k[part] for a, k in zip(row, slopes, strict=True)) for part in (0, 1))
        return p + step * next(both), q + step * next(both)

    for _ in range(10_000):
        new = [(f[0](*moved(row)), f[1](*moved(row))) for row in exact[:-1]]
        pairs = zip(new, slopes, strict=True)
        change = max(abs(x - y) for a, b in pairs for x, y in zip(a, b, strict=True))
        slopes = new
        if change < context.mpf(10) ** -(digits + 8):
            break
    else:
        raise AssertionError("the fixed-point iteration does not converge: take a smaller h")
    return tuple(_exact(x) for x in moved(exact[-1]))  # type: ignore[return-value]


def _function(x: sympy.Expr, context: MPContext) -> Callable[[Any, Any], Any]:
    """With its rational coefficients in the context's precision, which sympy would round to 53."""
    exact = sorted(a for a in x.atoms(sympy.Rational) if not a.is_Integer)
    named = sympy.symbols(f"r:{len(exact)}")
    put = dict(zip(exact, named, strict=True))
    made = sympy.lambdify((P, Q, *named), x.xreplace(put), modules=_functions(context))
    values = [context.mpf(int(a.p)) / int(a.q) for a in exact]
    return lambda p, q: made(p, q, *values)


def _functions(context: MPContext) -> dict[str, Any]:
    return {n: getattr(context, n) for n in ("sin", "cos", "exp", "log", "sqrt", "cosh", "sinh")}


def _exact(x: Any) -> Fraction:
    sign, mantissa, exponent, _ = x._mpf_
    return (-1) ** sign * Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


# -- by kernels -----------------------------------------------------------------------------------


def step_map(name: str, text: str) -> StepMap:
    return get(name).step_map(Hamiltonian.parse(text))


_WRITTEN: dict[tuple[Any, ...], tuple[StepMap, Kernel]] = {}


def kernel(made: StepMap, arithmetic: str, digits: int, *observables: str) -> Kernel:
    """Written once for each map, by identity, arithmetic and observables."""
    at = id(made), arithmetic, digits, observables
    if at not in _WRITTEN:
        own = number_systems.get(arithmetic, digits)
        _WRITTEN[at] = made, KernelWriter(made, own, frozenset(observables), False).kernel()
    return _WRITTEN[at][1]


def steps(
    made: StepMap, arithmetic: str, digits: int, z: Pair, h: Fraction, count: int = 1
) -> Pair:
    """`count` steps from z, in an arithmetic of so many digits."""
    own = number_systems.get(arithmetic, digits)
    number = own.number
    with own.context():
        done, p, q = kernel(made, arithmetic, digits).function(count, number(h), *map(number, z))
    assert done == count
    return own.exact(p), own.exact(q)


def plain_determinant(
    made: StepMap, arithmetic: str, digits: int, z: Pair, h: Fraction
) -> Fraction:
    """det J of one step, from its four entries."""
    own = number_systems.get(arithmetic, digits)
    function = kernel(made, arithmetic, digits, "lambda_plain").function
    with own.context():
        *_, plain = function(1, own.number(h), *map(own.number, z), own.number(Fraction(1)))
    return own.exact(plain)


def counted(made: StepMap, arithmetic: str, digits: int, z: Pair, h: Fraction, count: int) -> int:
    """The greatest number of Newton's updates in a step."""
    most = 0

    def counting(limit: int) -> Any:
        nonlocal most
        for k in range(limit):
            if limit != count:
                most = max(most, k + 1)
            yield k

    own = number_systems.get(arithmetic, digits)

    def compiled(source: str, name: str, scope: Mapping[str, Any]) -> Callable[..., Any]:
        return interpret(source, name, {**scope, "range": counting})

    looked_at = replace(own, compile=compiled)
    function = KernelWriter(made, looked_at, frozenset(), False).kernel().function
    with own.context():
        function(count, own.number(h), *map(own.number, z))
    return most
