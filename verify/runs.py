"""One run: N steps from (q, p) in one arithmetic, each value with its error bound.

The error of a float64 run is estimated
- up to `DIRECT_STEPS` steps by the same run in mpmath at 40 digits from the exact inputs;
- beyond, by a compensated run (see `verify.kernel`), as twice the difference. That leaves the
  rounding of h, the parameters and the initial values aside, which shifts the phase by T·2⁻⁵³ at
  most, while the rounding of N ≥ 20,000 states shifts it by about √N·T·2⁻⁵³/5.
The error of an mpmath run is estimated by a rerun with 15 more digits. An estimate is no
certificate, and is called `estimated`.

What a proof already gives is not run: where ΔJ ≡ 0, ΔJ, MSE and Λ are exactly 0; where ΔJ does not
depend on (p, q), Λ = (1 + ΔJ)^N − 1 is enclosed by ball arithmetic.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint

from verify import arithmetic as number_systems
from verify.enclosure import enclose
from verify.errors import InputError
from verify.exact import Exact, known_digits, positive, rational, text
from verify.formula import to_text
from verify.hamiltonian import Hamiltonian
from verify.number_system import Arithmetic
from verify.results import RunResult, Value
from verify.schemes import get
from verify.step_map import StepMap
from verify.stepping import Job, Outcome, Progress

DIRECT_STEPS = 20_000
MAX_STEPS = 10**12
MAX_DIGITS = 10_000
CLOSED_FORM = ("delta_j_max", "mse", "lambda")
ASKED = (*CLOSED_FORM, "lambda_plain")
_REFERENCE_DIGITS = 40
_MORE_DIGITS = 15

Bounded = dict[str, tuple[Fraction, Fraction]]  # values with their bounds


def run(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    q: Exact,
    p: Exact,
    step_size: Exact,
    steps: int,
    arithmetic: str = "float64",
    digits: int = 17,
    observables: Sequence[str] = CLOSED_FORM,
    points: int = 0,
    progress: Progress | None = None,
) -> RunResult:
    """Run `steps` steps of `step_size` from (q, p) and report p, q and the observables.

    `digits`: significant digits wanted (float64 gives what it knows). `points`: at most so many
    points of a thinned series are kept. `progress` is called with the number of steps done.
    Raises InputError for h ≤ 0, N < 1, a parameter without a value, unknown names.
    """
    start = {"p": rational(p, "p"), "q": rational(q, "q"), "h": positive(step_size, "step_size")}
    _check(hamiltonian, steps, digits, observables)
    step_map = get(scheme).step_map(hamiltonian)
    known = _proved(step_map, start["h"], steps, digits)
    needed = frozenset(o for o in observables if o not in known) | _series_needs(known, points)
    job = Job(hamiltonian, scheme, start, steps, needed, points)

    own = number_systems.get(arithmetic, _working_digits(digits, steps))
    first = job.go(own, progress=progress)
    common: dict[str, Any] = {
        "hamiltonian": to_text(hamiltonian.expression),
        "parameters": {name: text(value) for name, value in hamiltonian.values},
        "scheme": scheme,
        "arithmetic": arithmetic,
        "digits": digits,
        "step_size": text(start["h"]),
        "steps": steps,
        "q": text(start["q"]),
        "p": text(start["p"]),
        "exact": tuple(o for o in observables if o in known),
        "seconds": first.seconds,
    }
    if first.done < steps:
        return RunResult(
            **common, status="left range", failed_step=first.done + 1, values={},
            error_kind="estimated", error_method="none", series=first.series,
        )  # fmt: skip
    found, method = _with_bounds(job, own, first, known)
    most = min(digits, 17) if own.name == "float64" else digits
    values = {n: _printed(*found[n], most) for n in ("p", "q", *observables) if n in found}
    values |= {n: _printed(*known[n], digits) for n in observables if n in known}
    return RunResult(
        **common, status="finished", failed_step=None, values=values,
        error_kind="estimated", error_method=method, series=first.series,
    )  # fmt: skip


def _check(hamiltonian: Hamiltonian, steps: int, digits: int, observables: Sequence[str]) -> None:
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "has no value; a run needs one")
    for name, value, most in (("steps", steps, MAX_STEPS), ("digits", digits, MAX_DIGITS)):
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= most:
            raise InputError(name, value, f"must be a whole number, 1 … {most}")
    for name in observables:
        if name not in ASKED:
            raise InputError("observable", name, f"unknown; allowed: {', '.join(ASKED)}")


def _working_digits(digits: int, steps: int) -> int:
    """Digits enough that rounding, growing at most like N² on a bounded orbit, stays below."""
    return digits + 10 + 2 * len(str(steps))


def _series_needs(known: dict[str, Any], points: int) -> frozenset[str]:
    return frozenset({"extremes"}) if points and "lambda" not in known else frozenset()


# -- what a proof gives ---------------------------------------------------------------------------


def _proved(step_map: StepMap, h: Fraction, steps: int, digits: int) -> Bounded:
    """max |ΔJ|, MSE and Λ with their bounds, where no run is needed for them."""
    zero = Fraction(0), Fraction(0)
    if step_map.preserves_area:
        return dict.fromkeys(CLOSED_FORM, zero)
    if len(step_map.substeps) > 1:
        return {}
    step = step_map.substeps[0]
    if any(step.ring.depends(step.delta_j, name) for name in ("p", "q")):
        return {}
    bits = int(4 * digits) + 64 + 2 * steps.bit_length()
    delta_j = enclose(step.ring, step.delta_j, {"h": h}, bits)
    if delta_j is None:
        return {}
    with flint.ctx.workprec(bits):
        lam = (1 + delta_j) ** steps - 1
        balls = {"delta_j_max": abs(delta_j), "mse": delta_j**2, "lambda": lam}
        return {name: _rational_ball(ball) for name, ball in balls.items()}


def _rational_ball(ball: Any) -> tuple[Fraction, Fraction]:
    mid, rad = (flint.arb(x).man_exp() for x in (ball.mid(), ball.rad()))
    middle, radius = (Fraction(int(m)) * Fraction(2) ** int(e) for m, e in (mid, rad))
    return middle, radius


# -- bounds ---------------------------------------------------------------------------------------


def _with_bounds(job: Job, own: Arithmetic, first: Outcome, known: Bounded) -> tuple[Bounded, str]:
    """Each value with the estimate of its error, and how that was got."""
    if own.name == "float64":
        return _float64_bounds(job, own, first, known)
    finer = number_systems.get(own.name, own.bits * 30103 // 100000 + _MORE_DIGITS)
    second = job.go(finer)
    unit = Fraction(1, 2 ** (own.bits - 2))
    found = {
        n: (second.values[n], abs(x - second.values[n]) + unit * abs(x))
        for n, x in first.values.items()
    }
    return found, f"rerun with {_MORE_DIGITS} more digits"


def _float64_bounds(
    job: Job, own: Arithmetic, first: Outcome, known: Bounded
) -> tuple[Bounded, str]:
    if job.steps <= DIRECT_STEPS:
        reference = number_systems.get("mpmath", _working_digits(_REFERENCE_DIGITS, job.steps))
        second, factor, method = job.go(reference), 1, "rerun in mpmath with 40 digits"
    else:
        second, factor, method = job.go(own, compensated=True), 2, "twice the difference from a "
        method += "compensated run"
    if second.done < job.steps:  # float64 stayed in range where the finer run did not
        return {n: (x, abs(x)) for n, x in first.values.items()}, f"{method}, which left the range"
    unit = Fraction(1, 2**51)
    found = {
        n: (x, factor * abs(x - second.values[n]) + unit * abs(second.values[n]))
        for n, x in first.values.items()
    }
    better = (known | found).get("lambda")
    if "lambda_plain" in found and better:
        # The closed form is the better value of the same product, up to its own error.
        plain, (closed, bound) = found["lambda_plain"][0], better
        found["lambda_plain"] = plain, abs(plain - closed) + bound
    return found, method


def _printed(value: Fraction, bound: Fraction, digits: int) -> Value:
    shown, within = known_digits(value, bound, digits)
    return Value(value=shown, bound=within)
