"""Shared strategies, plain-sympy oracles, and a guard against work that does not end.

The oracles share no code with `verify`: formulas go through sympy's own reader, derivatives
through `sympy.diff`, numbers through mpmath.
"""

import math
import multiprocessing
import resource
import signal
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import lru_cache
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import mpmath
import sympy
from hypothesis import strategies as st

P, Q, H = (sympy.Symbol(name, real=True) for name in "pqh")
NAMES = ("p", "q", "h", "a", "b", "delta", "omega")
_LOCALS = {name: sympy.Symbol(name, real=True) for name in NAMES}

# -- strategies -------------------------------------------------------------------------------


def rationals(most: int = 9) -> st.SearchStrategy[Fraction]:
    """Small rationals other than zero."""
    numerators = st.integers(-most, most).filter(bool)
    return st.builds(Fraction, numerators, st.integers(1, most))


def points(*names: str) -> st.SearchStrategy[dict[str, Fraction]]:
    """A rational value for each name, away from the integers and from zero."""
    values = st.builds(lambda n: Fraction(2 * n + 1, 34), st.integers(-40, 40))
    return st.fixed_dictionaries(dict.fromkeys(names, values))


@st.composite
def polynomials(
    draw: st.DrawFn, variables: str = "pq", degree: int = 6, most_terms: int = 4
) -> str:
    """The text of a polynomial that is not constant, with rational coefficients."""
    exponents = st.tuples(*(st.integers(0, degree) for _ in variables))
    fitting = exponents.filter(lambda e: 0 < sum(e) <= degree)
    size = st.integers(1, most_terms)
    monomials = draw(size.flatmap(lambda n: st.lists(fitting, min_size=n, max_size=n, unique=True)))
    terms = (monomial(draw(rationals()), variables, powers) for powers in monomials)
    return " + ".join(terms)


def monomial(coefficient: Fraction, variables: str, powers: tuple[int, ...]) -> str:
    factors = [f"{v}**{n}" for v, n in zip(variables, powers, strict=True) if n]
    return "*".join([f"({coefficient})", *factors])


@st.composite
def trigonometric(draw: st.DrawFn, variables: str = "pq", most_terms: int = 2) -> str:
    """The text of a sum of c·sin or c·cos of integer combinations, and a little polynomial."""
    terms = [draw(polynomials(variables, degree=3, most_terms=2))]
    for _ in range(draw(st.integers(1, most_terms))):
        inner = [f"({draw(st.integers(1, 3))})*{v}" for v in variables]
        shown = draw(st.sampled_from([inner, inner[:1], inner[-1:]]))
        function = draw(st.sampled_from(["sin", "cos"]))
        terms.append(f"({draw(rationals(4))})*{function}({' + '.join(shown)})")
    return " + ".join(terms)


ENTIRE = ("sin", "cos", "exp", "sinh", "cosh")
PARTIAL = (*ENTIRE, "tan", "tanh", "atan", "log", "sqrt")


def formulas(
    functions: tuple[str, ...] = PARTIAL, leaves: int = 5, division: bool = True
) -> st.SearchStrategy[str]:
    """Formula text in p, q and a parameter a, by recursion over the grammar."""
    atoms = st.sampled_from(["p", "q", "q", "p", "a", "2", "1/3", "0.5", "pi"])
    operators = st.sampled_from(["+", "-", "*", "/"] if division else ["+", "-", "*"])
    exponents = ["2", "3", "(1/2)", "-1", "(2/3)"] if division else ["2", "3"]

    def extend(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        return st.one_of(
            st.builds("({}) {} ({})".format, inner, operators, inner),
            st.builds("{}({})".format, st.sampled_from(functions), inner),
            st.builds("({})**{}".format, inner, st.sampled_from(exponents)),
            st.builds("-({})".format, inner),
        )

    return st.recursive(atoms, extend, max_leaves=leaves)


# -- oracles ----------------------------------------------------------------------------------


@lru_cache(maxsize=256)  # of a claim that is changed in one formula the others stay
def plain(text: str) -> sympy.Expr:
    """The formula by sympy's own reader, on exact rationals."""
    return sympy.sympify(text.replace("^", "**"), locals=_LOCALS, rational=True)


def lie_step(hamiltonian: sympy.Expr, eta: int) -> tuple[sympy.Expr, sympy.Expr]:
    """Eq. 2–5 of the paper to the letter: two operators, each applied to the one before."""
    p_next, q_next = P, Q
    for n in range(1, eta + 1):
        l_p, l_q = _lie_terms(hamiltonian, n)
        p_next += H**n / math.factorial(n) * l_p
        q_next += H**n / math.factorial(n) * l_q
    return p_next, q_next


@lru_cache(maxsize=64)  # a test may want one order more too, or the same of many mutants
def _lie_terms(hamiltonian: sympy.Expr, n: int) -> tuple[sympy.Expr, sympy.Expr]:
    """Every derivative is expanded, for sympy's would else grow beyond what it can evaluate."""
    h_p, minus_h_q = hamiltonian.diff(P), -hamiltonian.diff(Q)

    def l_hp(y: sympy.Expr) -> sympy.Expr:
        return h_p * y.diff(Q)

    def l_hq(y: sympy.Expr) -> sympy.Expr:
        return minus_h_q * y.diff(P)

    if n == 1:
        return minus_h_q, h_p  # Eq. 3
    l_p, l_q = _lie_terms(hamiltonian, n - 1)
    return sympy.expand(l_hq(l_p) + l_hp(l_p)), sympy.expand(l_hp(l_q) + l_hq(l_q))  # Eq. 4


def plain_delta_j(p_next: sympy.Expr, q_next: sympy.Expr) -> sympy.Expr:
    """Eq. 12–14: the determinant of the four derivatives, minus one."""
    return p_next.diff(P) * q_next.diff(Q) - p_next.diff(Q) * q_next.diff(P) - 1


def evaluate(expression: sympy.Expr, point: Mapping[str, Fraction], digits: int = 60) -> Any:
    """The value at a point by mpmath; complex or not finite where it is not defined."""
    known: dict[sympy.Expr, Any] = {}

    def value(node: sympy.Expr) -> Any:
        if node not in known:
            known[node] = _apply(node, [value(argument) for argument in node.args])
        return known[node]

    with mpmath.workdps(digits):
        for name, at in point.items():
            known[sympy.Symbol(name, real=True)] = mpmath.mpf(at.numerator) / at.denominator
        try:
            return value(expression)
        except (ZeroDivisionError, OverflowError, ValueError):
            return mpmath.nan


_CONSTANTS = {sympy.pi: lambda: +mpmath.pi, sympy.E: lambda: +mpmath.e}


def _apply(node: sympy.Expr, arguments: list[Any]) -> Any:
    if node.is_Rational:
        return mpmath.mpf(int(node.p)) / int(node.q)
    if node in _CONSTANTS:
        return _CONSTANTS[node]()
    if node.is_Add:
        return mpmath.fsum(arguments)
    if node.is_Mul:
        return mpmath.fprod(arguments)
    if node.is_Pow:
        return mpmath.power(*arguments)
    if not node.is_Function:
        return mpmath.nan
    return getattr(mpmath, node.func.__name__)(*arguments)


def zero_there(x: sympy.Expr) -> bool:
    """Whether an expression in p, q and h is 0 at one point, to 30 digits."""
    at = {P: sympy.Rational(3, 7), Q: sympy.Rational(-5, 11), H: sympy.Rational(2, 9)}
    return bool(abs(sympy.N(x.subs(at), 40)) < 1e-30)


def is_real(value: Any) -> bool:
    """A finite real number, and neither so large nor so small that nothing can be compared."""
    return isinstance(value, mpmath.mpf) and bool(
        mpmath.isfinite(value) and abs(value) < mpmath.mpf(10) ** 30
    )


def close(x: Any, y: Any, digits: int) -> bool:
    """Equality to that many digits, relative to numbers beyond 1 and absolute below."""
    return bool(abs(x - y) <= mpmath.mpf(10) ** -digits * max(1, abs(x), abs(y)))


# -- what must end ----------------------------------------------------------------------------

_MEMORY = 2 << 30  # more than there is when it begins
_WAITING = 20  # times as long as the processor may be busy


def outcome(work: Callable[[], object], seconds: int = 6) -> str:
    """What becomes of `work` in a process of its own, with limits on its memory and on its seconds
    of processor time, which a busy machine does not use up.

    "done", the name of the exception it raised, "hangs" or "dies".
    """
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_attempt, args=(work, seconds, sender))
    process.start()
    sender.close()
    try:
        return receiver.recv() if receiver.poll(_WAITING * seconds) else "hangs"
    except EOFError:
        process.join()
        return "hangs" if process.exitcode == -signal.SIGXCPU else "dies"
    finally:
        process.kill()
        process.join()


def _address_space() -> int:
    """What this process, a copy of the one that tests, has of it already, in bytes."""
    pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[0]
    return int(pages) * resource.getpagesize()


def _attempt(work: Callable[[], object], seconds: int, sender: Connection) -> None:
    most = _address_space() + _MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, 2 * seconds))
    try:
        work()
    except Exception as error:
        sender.send(type(error).__name__)
    else:
        sender.send("done")
