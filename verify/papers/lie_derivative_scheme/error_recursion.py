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
from verify.papers.argument import BALLS, NUMBERS, Argument, Check, proof, refutation, vanishes
from verify.papers.differential_polynomials import free_variables
from verify.papers.elementary_identities import bound_of_eq_11, difference, geometric, triangle
from verify.papers.exact_maps import RationalPoint, next_point
from verify.papers.lie_derivative_scheme.convergence import STEPS, local_orders
from verify.papers.lie_derivative_scheme.examples import enclosures
from verify.schemes.methods.taylor.lie import lie_map

_RATES = (Fraction(1, 2), Fraction(1), Fraction(3))  # L
_ORDER = 2
_TIME = sympy.Symbol("t")


def local_error(shift: int = 0) -> Argument:
    """Prove that the local error is C h^(η+1); `shift` is added to the order."""
    return proof(
        """
        one step from the exact solution, Eq. 6, is its Taylor polynomial of degree η, so that the
        local error is C `h^(η+1)` with |C| ≤ max |`X^(η+1)` z|/(η+1)!, of that order exactly for
        both systems and η = 1 … 4

        - Eq. 6 is Eq. 2 from a point of the exact solution. By Eq. 2, 4 and 5 its right side is the
          Taylor polynomial of degree η of the exact flow from `z̄_k` to `z̄_{k+1}`, ``Σ_{n=0}^{η}
          h^n/n! X^n z``, and off by C `h^(η+1)` at most. [Theorems.flow_has_taylor_series]
        - Taylor’s remainder bounds what is left by ``M h^(η+1)/(η+1)!`` for each component, with M
          the maximum of |`X^(η+1)` z| along the solution: these are the coefficients C of the local
          truncation error, bounded on [t₀, `t_end`].
        - For both systems and η = 1 … 4 it is of no higher order. [local_orders]

        η stands in the exponent where Eq. 10 and 11 write n.
        """,
        local_orders=local_orders(shift),
    )


# -- Eq. 7 -----------------------------------------------------------------------------------------


def eq_7(formula: str = "p**2/2 + q", steps: Sequence[int] = (1, 2)) -> Argument:
    """Refute Eq. 7: |p̃ − p| is 0 after the first step, the global error is not (lie1)."""
    solves, first, later = _after_steps(formula, steps)
    return refutation(
        """
        `p̃_1` is one step from the exact initial value, and so is `p_1`: Eq. 7 is 0 after the first
        step, where the global error, `z̄_1` − `z_1`, is the local error (h²/2 in q for H = p²/2 + q
        and η = 1)

        The global error at step k + 1 is `z̄_{k+1}` − `z_{k+1}`, the exact solution less the
        computed one; it stands on the left of Eq. 8. In Eq. 7 stands `z̃_{k+1}`, by Eq. 6 one step
        from the exact solution, in place of `z̄_{k+1}`.

        - For H = p²/2 + q the solution from (0, 0) is ``p = −t, q = −t^2/2``. [solves]
        - lie1 gives (−h, 0) after one step. It begins where the step of Eq. 6 begins, so that Eq. 7
          is 0; the global error in q is h²/2. [first]
        - After each step the two differ by h²/2, the local error. [later]

        For k = 0 both steps begin at the same point whatever the scheme, its order and H are, so
        that Eq. 7 is always 0 there, and the global error is the local one.
        """,
        solves=solves,
        first=first,
        later=later,
    )


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
    return proof(
        """
        by the triangle inequality Eq. 7 and the global error differ by |`z̄_{k+1}` − `z̃_{k+1}`|,
        one local error, `O(h^(η+1))`: the one is `O(h^η)` where the other is

        - For each component ``| |z̃ − z| − |z̄ − z| | ≤ |z̄ − z̃|``, by the triangle inequality.
          [difference]
        - z̄ − z̃ is the local error of the last step, `O(h^(η+1))`.
          [Theorems.flow_has_taylor_series, local_orders]

        So in every estimate up to `O(h^η)`, as Eq. 11 is, one may stand for the other.
        """,
        difference=difference(distance),
        local_orders=local_orders(0),
    )


# -- Eq. 8 -----------------------------------------------------------------------------------------


def eq_8(middle_sign: int = 1) -> Argument:
    """Prove Eq. 8 by the triangle inequality; `middle_sign` −1 makes one side wrong."""
    exact, images, run = free_variables("exact step run")
    split = vanishes(
        "(p̄ − p̃) + (p̃ − p) − (p̄ − p)",
        (exact - images) + (middle_sign * images - run) - (exact - run),
    )
    return proof(
        """
        it is the triangle inequality: p̄ − p = (p̄ − p̃) + (p̃ − p), the local error of the last
        step and what the step makes of the error before it

        - Identically ``p̄ − p = (p̄ − p̃) + (p̃ − p)``. [split]
        - |x + y| ≤ |x| + |y| for real numbers. The left side is the global error. [triangle,
          Sums.size_of_sum]
        """,
        split=split,
        triangle=triangle(middle_sign),
    )


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
    return proof(
        """
        with `e_k` for `e_n` and the plane’s norm for the two components, the first inequality is
        Eq. 8 with the local error, the second 1 + hL ≤ `e^(hL)`

        Let e be the norm of the error of (p, q), and Φ have the Lipschitz constant 1 + hL near the
        exact solution (Eq. 9 for both components together).

        - The local error is at most C `h^(η+1)`. [Theorems.flow_has_taylor_series, local_orders]
        - So Eq. 8 reads, and this is the first inequality, ``e_{k+1} ≤ C h^(η+1) + |Φ(z̄_k) −
          Φ(z_k)| ≤ C h^(η+1) + (1 + hL) e_k``.
        - The second follows from ``1 + x ≤ e^x`` for x = hL. [Product.one_plus_below_exp; tried
          example]
        """,
        local_orders=local_orders(0),
        example=example,
    )


def eq_11_norm(factor: Callable[[Fraction, int], Fraction] | None = None) -> Argument:
    """Prove Eq. 11 for every sequence with the first inequality of Eq. 10.

    `factor`: used in place of (1 + hL)^k, as a control.
    """
    power = factor or (lambda rate, k: rate**k)
    return proof(
        """
        for every sequence with `e_{k+1}` ≤ (1 + hL) `e_k` + C `h^(n+1)`, n = η, both inequalities
        hold, with C̃ = (`e^(LT)` − 1)/L + h `e^(LT)` (the term m = 1 of the sum counts the first
        step twice, which only weakens it)

        Let `e_{k+1}` ≤ (1 + hL) `e_k` + |`C_{k+1}`| `h^(n+1)`.

        - Iterated from `e_1` the recursion gives ``e_{k+1} ≤ (1 + hL)^k e_1 + Σ_{m=2}^{k+1} (1 +
          hL)^(k+1−m) |C_m| h^(n+1)``. The term m = 1 that Eq. 11 has besides is not negative, so
          its first inequality holds. [Product.errors_sum_up; tried worst_sequence]
        - `e_1` ≤ |`C_1`| `h^(n+1)`, and ``(1 + hL)^j ≤ e^(LT)`` for jh ≤ T.
          [Product.power_below_exp]
        - The powers add up to ``((1 + hL)^(k+1) − 1)/(hL)``. [geometric]
        - So the right side is at most max |`C_m`| times ``h^(n+1) (e^(LT) + (e^(LT) − 1)/(hL)) = C̃
          h^n`` with C̃ = (`e^(LT)` − 1)/L + h `e^(LT)`. [bound_of_eq_11]

        C̃ depends on the length of the interval and on L alone, as the paper says (and, for h ≤ h₀,
        not on h). The recursion itself is the first inequality of Eq. 10, which needs both
        components together.
        """,
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
