"""The initial value in float64: its rounding, and an equilibrium with the same float64 numbers."""

from fractions import Fraction

from verify.arithmetic.systems import mpfr
from verify.flows.compiled_functions import functions_at
from verify.hamiltonians.canonical_field import canonical_field
from verify.prose import Number, Prose, prose, read_prose
from verify.studies.stability.trail import StabilityRun

_DIGITS = 120
_NEWTON_STEPS = 12
_NEIGHBOURHOOD = Fraction(1, 10**6)  # an equilibrium counts within this distance of the start


def describe_rounded_start(run: StabilityRun) -> Prose:
    """Describe float64's rounding of the initial value, and an equilibrium that rounds to it."""
    sentences = Prose()
    for name, value in zip(("q", "p"), reversed(run.state), strict=True):
        gap = abs(Fraction(float(value)) - value)
        if gap:
            sentences += prose(f"; it rounds {name}0 by ", Number(f"{float(gap):.1e}"))
    equilibrium = nearest_equilibrium(run)
    if equilibrium is not None and all(
        float(x) == float(y) for x, y in zip(equilibrium, run.state, strict=True)
    ):
        distance = max(abs(x - y) for x, y in zip(equilibrium, run.state, strict=True))
        distance_text = f"`{float(distance):.1e}`"
        sentences += read_prose(
            f" and cannot tell z0 from an equilibrium, which is {distance_text} away"
        )
    return sentences


def nearest_equilibrium(run: StabilityRun) -> tuple[Fraction, Fraction] | None:
    """Find a zero (p, q) of H's gradient very near to the initial value, by Newton's method.

    None if there is none, or H depends on time.
    """
    if run.hamiltonian.time_dependent:
        return None
    field, _ = canonical_field(run.hamiltonian)
    ring, arithmetic = field.ring, mpfr.make(_DIGITS)
    gradient = field.gradient(field.energy)
    hessian = [ring.diff(x, name) for x in gradient for name in ("p", "q")]
    evaluate = functions_at(arithmetic, [(ring, x) for x in (*gradient, *hessian)])
    start = tuple(map(arithmetic.number, run.state))
    near = arithmetic.number(_NEIGHBOURHOOD)
    try:
        with arithmetic.context():
            p, q = start
            for _ in range(_NEWTON_STEPS):
                u, v, a, b, c, d = evaluate(p, q)
                # Newton's step solves the Hessian's 2 × 2 system by Cramer's rule.
                below = a * d - b * c
                dp, dq = (d * u - b * v) / below, (a * v - c * u) / below
                p, q = p - dp, q - dq
            # The last step must be at most 10^−60: the iteration has converged.
            if (
                not max(abs(p - start[0]), abs(q - start[1])) < near
                or max(abs(dp), abs(dq)) > near**10
            ):
                return None
    except (ArithmeticError, ValueError):
        return None
    return arithmetic.exact(p), arithmetic.exact(q)
