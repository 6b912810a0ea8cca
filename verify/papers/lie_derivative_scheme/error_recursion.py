"""Eq. 6–8, 10 and 11 apart from Eq. 9: the definitions of the errors, and their recursion.

Eq. 10 and 11 in one norm of the plane; by components:
`verify.papers.lie_derivative_scheme.components`.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction

import sympy

from verify.algebra.symbols import P, Q
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import BALLS, NUMBERS, Argument, ArgumentTexts, Check, vanishes
from verify.papers.differential_polynomials import free_variables
from verify.papers.elementary_identities import bound_of_eq_11, difference, geometric, triangle
from verify.papers.exact_maps import RationalPoint, next_point
from verify.papers.lie_derivative_scheme.convergence import STEPS, local_orders
from verify.papers.lie_derivative_scheme.examples import enclosures
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

_RATES = (Fraction(1, 2), Fraction(1), Fraction(3))  # L
_ORDER = 2
_TIME = sympy.Symbol("t")


def local_error(shift: int = 0) -> Argument:
    """Prove that the local error is C h^(η+1); `shift` is added to the order."""
    return _TEXTS.proof("local_error", local_orders=local_orders(shift))


# -- Eq. 7 -----------------------------------------------------------------------------------------


def eq_7(formula: str = "p**2/2 + q", steps: Sequence[int] = (1, 2)) -> Argument:
    """Refute Eq. 7: |p̃ − p| is 0 after the first step, the global error is not (lie1)."""
    solves, first, later = _after_steps(formula, steps)
    return _TEXTS.refutation("eq_7", solves=solves, first=first, later=later)


def _after_steps(formula: str, steps: Sequence[int]) -> list[Check]:
    """Check Eq. 7 and the global error in q, on the solution p = −t, q = −t²/2 of H = p²/2 + q."""
    hamiltonian = Hamiltonian.parse(formula)
    scheme, h = lie_map(hamiltonian, 1), Fraction(1, 10)
    errors, point = [], RationalPoint(Fraction(0), Fraction(0))
    for n in range(max(steps)):
        exact = [RationalPoint(-t, -t * t / 2) for t in (n * h, (n + 1) * h)]
        # Eq. 7 compares the step from the exact point with the numerical one, the global error the
        # exact point itself.
        from_exact, point = next_point(scheme, exact[0], h), next_point(scheme, point, h)
        errors.append((abs(from_exact.q - point.q), abs(exact[1].q - point.q)))
    (by_eq_7, globally), *_ = errors
    on_it = {P: -_TIME, Q: -(_TIME**2) / 2}
    rates = [sympy.diff(hamiltonian.expression, z).subs(on_it) for z in (Q, P)]
    return [
        Check(
            f"H = `{formula}`: p = −t, q = −t²/2 solves Eq. 1",
            [sympy.diff(on_it[P], _TIME) + rates[0], sympy.diff(on_it[Q], _TIME) - rates[1]]
            == [0, 0],
            f"`H_q` = `{rates[0]}`, `H_p` = `{rates[1]}` there",
        ),
        Check(
            f"H = `{formula}`, lie1, h = {text(h)}, from (0, 0): after one step |q̃ − q| by Eq. 7 "
            "is 0, the global error |q̄ − q| is h²/2",
            by_eq_7 == 0 and globally == h * h / 2,
            f"{text(by_eq_7)} and {text(globally)}",
            NUMBERS,
        ),
        Check(
            "after each step they differ by h²/2, the local error",
            all(abs(b - a) == h * h / 2 for a, b in errors),
            "; ".join(f"{text(a)} and {text(b)}" for a, b in errors),
            NUMBERS,
        ),
    ]


def eq_7_meant(distance: str = "ab") -> Argument:
    """Prove that Eq. 7 is off by the local error at most; `distance`: see `difference`."""
    return _TEXTS.proof("eq_7_meant", difference=difference(distance), local_orders=local_orders(0))


# -- Eq. 8 -----------------------------------------------------------------------------------------


def eq_8(middle_sign: int = 1) -> Argument:
    """Prove Eq. 8 by the triangle inequality; `middle_sign` −1 makes one side wrong."""
    exact, images, run = free_variables("exact step run")
    split = vanishes(
        "(p̄ − p̃) + (p̃ − p) − (p̄ − p)",
        (exact - images) + (middle_sign * images - run) - (exact - run),
    )
    return _TEXTS.proof("eq_8", split=split, triangle=triangle(middle_sign))


# -- Eq. 10 and 11 ---------------------------------------------------------------------------------


def eq_10_meant(slope: int = 1) -> Argument:
    """Prove Eq. 10 with e_k for e_n, from Eq. 8 and a Lipschitz constant; `slope`: of 1 + x."""
    with enclosures():
        sizes = [rational_ball(rate / n) for rate in _RATES for n in STEPS]
        exponentials = [bool(1 + slope * x <= x.exp()) for x in sizes]
    example = Check(
        "1 + hL ≤ `e^(hL)`",
        all(exponentials),
        f"L = {', '.join(map(text, _RATES))}, N = {', '.join(map(str, STEPS))}, enclosed",
        BALLS,
    )
    return _TEXTS.proof("eq_10_meant", local_orders=local_orders(0), example=example)


def eq_11_norm(factor: Callable[[Fraction, int], Fraction] | None = None) -> Argument:
    """Prove Eq. 11 for every sequence with the first inequality of Eq. 10.

    `factor`: used in place of (1 + hL)^k, as a control.
    """
    power = factor or (lambda rate, k: rate**k)
    return _TEXTS.proof(
        "eq_11_norm",
        worst_sequence=[_worst_sequence(rate, power) for rate in _RATES],
        geometric=geometric(),
        bound_of_eq_11=bound_of_eq_11(),
    )


def _worst_sequence(rate: Fraction, power: Callable[[Fraction, int], Fraction]) -> Check:
    """Check the greatest sequence of the recursion, T = 1, against both bounds of Eq. 11."""
    holds, counts = True, (1, 4, 16)
    for count in counts:
        h = Fraction(1, count)
        coefficients = [Fraction(1 + (3 * m) % 5, 5) for m in range(1, count + 1)]  # |C_m|
        error, unit = coefficients[0] * h ** (_ORDER + 1), h ** (_ORDER + 1)
        first = error
        # Equality in every step of the recursion: no sequence that satisfies it is greater.
        for c in coefficients[1:]:
            error = (1 + h * rate) * error + c * unit
        factor = 1 + h * rate
        total = sum(
            (power(factor, count - m) * c for m, c in enumerate(coefficients, 1)), Fraction(0)
        )
        bound = power(factor, count - 1) * first + total * unit
        # e^(LT) stands above (1 + hL)^N; the power is used, so that the comparison is exact.
        limit = max(coefficients) * h**_ORDER * ((factor**count - 1) / rate + h * factor**count)
        holds = holds and error <= bound <= limit
    return Check(
        f"L = {text(rate)}, T = 1, N = {', '.join(map(str, counts))}: the greatest sequence of the "
        "recursion ≤ the sum ≤ C̃ max |`C_m`| `h^n`",
        holds,
        "exactly",
        NUMBERS,
    )
