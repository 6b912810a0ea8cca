"""Truncation separated from rounding in the area error Λ of a float64 run.

A chain of five values leads from exact arithmetic to what a float64 program prints:

    Λ₀  exact arithmetic at the exact inputs
    Λ₁  exact arithmetic at the inputs (h, parameters, p₀, q₀) rounded to float64
    Λ₂  the states z̃_k that float64 steps to from the rounded inputs, bit by bit; ΔJ at them and
        the product exactly
    Λ₃  the factors det J(z̃_k) as float64 computes them, bit by bit; their product exactly
    Λ₄  the product in float64, too: Λ as a float64 program finds it, `lambda_working`

The exact flow has Λ = 0, so Λ₀ is the truncation part, all that the scheme itself does wrong. What
each later link adds is rounding of one kind, and the sum telescopes:

    Λ₄ = Λ₀ + (Λ₁ − Λ₀) + (Λ₂ − Λ₁) + (Λ₃ − Λ₂) + (Λ₄ − Λ₃)
       = truncation + input + trajectory + determinant + product

Where H depends on time a link `clock` stands after Λ₁: exact arithmetic at the rounded inputs, but
each step at the time that a float64 program's clock has, t ← t + h, which is off t₀ + k h by what
was rounded so far. The clock is read by Λ₂ and all links after it.

That is one equation of rationals (`verify.studies.separation.chain`), and holds exactly whatever
error is left in Λ₀ … Λ₃, which is bounded. The order of the links is a choice, as effects interact:
a part is what its rounding adds to those before it. Constants in H's formula, such as the 0.1 of
0.1*q**4, are no inputs; their rounding belongs to `trajectory` and `determinant`.

Two ways to evaluate Λ in float64 are separated. `plain`: four entries of J, their determinant, the
product of determinants, minus one; each step's determinant is rounded at 1, by 2⁻⁵³ or so, however
small ΔJ is. `closed_form`: ΔJ from its own closed form, where nothing cancels, and
Λ = expm1(Σ log1p(ΔJ_k)) with the sum's own errors added at the end. Truncation, input and
trajectory are the same for both.

In n degrees of freedom W is split so, entry by entry (`verify.studies.separation.ways.matrices`):
`plain` is what a program does that multiplies the steps' Jacobians and takes MᵀΩM − Ω at the end,
`closed_form` is that of `verify run`. How W and the tangent map grow is told in
`verify.studies.separation.growth` and `verify.studies.separation.tangent`.

How far the parts are known is told in `verify.studies.separation.ways.determinants`,
`verify.studies.separation.ways.matrix_bounds` and `verify.runs.estimated`, what is made of a run's
checkpoints and of a grid of step sizes in `verify.studies.separation.growth`.
"""

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

from verify import arithmetic as number_systems
from verify.arithmetic import AUTO
from verify.arithmetic.exact import Exact, positive, rational, text
from verify.arithmetic.systems import float64
from verify.errors import NOT_GIVEN, InputError
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import Given, point_of
from verify.hamiltonians.times_on_the_way import check_times
from verify.lockstep import Course, alone
from verify.runs.run import AskedRun, check
from verify.runs.start import Start
from verify.scenes.results.separation import (
    WAYS,
    AnyGrid,
    AnySeparation,
    CrossoverResult,
    Separation,
    SeparationGrid,
    SeparationGridInDegrees,
    SeparationInDegrees,
    SeparationResult,
)
from verify.scenes.results.separation_parts import AnyEvaluation
from verify.schemes import canonical
from verify.studies.separation.growth import crossover
from verify.studies.separation.links import Chains, separated_chains, way_of
from verify.studies.separation.result import Split, evaluation
from verify.studies.separation.stepper.run import Stopped
from verify.studies.separation.tangent import tangent_growth

Progress = Callable[[int], None]  # called with a number of steps just done, of 3 N in all
_GRIDS: dict[type[Separation], type[AnyGrid]] = {
    SeparationResult: SeparationGrid,
    SeparationInDegrees: SeparationGridInDegrees,
}
RUNS = 3  # of N steps each: two in exact arithmetic's stead and one in both


def separate(hamiltonian: Hamiltonian, scheme: str, **asked: Any) -> AnySeparation:
    """The same as `separate_in_turn`, which takes the same arguments, alone."""
    return alone(separate_in_turn(hamiltonian, scheme, **asked))


def separate_in_turn(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    q: Given,
    p: Given,
    step_size: Exact,
    steps: int,
    t0: Exact = 0,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress | None = None,
    keeper: Keeper = NOTHING,
    run: AskedRun | None = None,
) -> Course[AnySeparation]:
    """Λ of a float64 run of `steps` steps from (q, p), split into truncation and rounding; in n
    degrees of freedom, where q and p are lists, W.

    `t0`: when it starts, of an H that depends on time. `digits`: significant digits wanted of every
    part. `arithmetic` stands for exact arithmetic; `auto` takes the fastest that can. `run`: one of
    the same steps in the plane that is asked for too, and done once for both. Raises InputError for
    h ≤ 0, N < 1, a parameter without a value, unknown names, more than 4 degrees of freedom, and
    for float64, which is what is examined.
    """
    scheme, h, way = canonical(scheme), positive(step_size, "step_size"), way_of(hamiltonian)
    begun = Start(hamiltonian, scheme, h, point_of(hamiltonian, q, p), rational(t0, "t0"))
    start = {**begun.point, "h": h}
    if hamiltonian.time_dependent:
        start["t"] = begun.t0
    check_times(hamiltonian, begun.t0, h, steps)
    check(hamiltonian, steps, digits, (way.observable,))
    check_reference(arithmetic)
    asked = hamiltonian, scheme, start, steps, digits, arithmetic, progress or (lambda _: None)
    told: dict[str, Any] = {
        **hamiltonian.texts, "scheme": scheme, "arithmetic": arithmetic, "digits": digits,
        "step_size": text(h), "steps": steps, "q": begun.text("q"), "p": begun.text("p"),
        "t0": text(start.get("t", Fraction(0))), "status": "finished", "failed_step": None,
        "reason": "", "plain": None, "closed_form": None, "error_method": "none", "seconds": 0.0,
        "coordinates": hamiltonian.coordinates, "tangent": None,
    }  # fmt: skip
    try:
        chains = yield from separated_chains(*asked, keeper, run)
        told |= _split(chains, begun, steps, digits)
    except Stopped as stopped:
        told |= {"status": stopped.status, "failed_step": stopped.step, "reason": stopped.reason}
    return way.result(**{name: told[name] for name in way.result.model_fields})


def _split(chains: Chains, begun: Start, steps: int, digits: int) -> dict[str, Any]:
    """What the chains give of a result."""
    sizes, closed = chains.sizes, chains.closed_form and Split(chains.closed_form)
    methods = dict.fromkeys(x for chain in chains.plain for x in chain.methods)
    return {
        "arithmetic": chains.arithmetic,
        "plain": evaluation(Split(chains.plain), digits, sizes),
        "closed_form": closed and evaluation(closed, digits, sizes),
        "tangent": tangent_growth(closed, sizes, begun, steps) if closed and sizes else None,
        "error_method": "; ".join(methods),
        "seconds": chains.seconds,
    }


def separate_grid(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    step_sizes: Sequence[Exact],
    steps: int | None = None,
    time: Exact | None = None,
    digits: int = 17,
    **asked: Any,
) -> AnyGrid:
    """`separate` for several step sizes, over N = `steps` steps or N = ⌊time / h⌋ each.

    Raises InputError as `separate` does, and where a step size is given twice, or not exactly one
    of `steps` and `time` is given.
    """
    counts = grid(step_sizes, steps, time)
    for _, count in counts:
        check(hamiltonian, count, digits, ())  # before the first of them is run
    asked |= {"digits": digits}
    return as_grid(
        [separate(hamiltonian, scheme, step_size=h, steps=count, **asked) for h, count in counts]
    )


def as_grid(points: Sequence[Separation]) -> AnyGrid:
    """Separations for several step sizes, with the crossover of each way to evaluate Λ, or W."""
    crossed = {way: crossing((x.step_size, getattr(x, way)) for x in points) for way in WAYS}
    return _GRIDS[type(points[0])].model_validate({"points": tuple(points), **crossed})


def crossing(ways: Iterable[tuple[str, AnyEvaluation | None]]) -> CrossoverResult:
    """Where rounding overtakes truncation, of step sizes with what was found of each, one way."""
    parts = ((h, way.largest["truncation"], way.largest["total"]) for h, way in ways if way)
    at = crossover([(Fraction(h), Fraction(x), Fraction(y)) for h, x, y in parts])
    size = None if at.step_size is None else f"{at.step_size:.3e}"
    ends = at.bracket and (text(at.bracket[0]), text(at.bracket[1]))
    return CrossoverResult(step_size=size, bracket=ends, reason=at.reason)


def grid(
    step_sizes: Sequence[Exact], steps: int | None, time: Exact | None
) -> list[tuple[Fraction, int]]:
    """Each step size with its number of steps; see `separate_grid`."""
    if (steps is None) == (time is None):
        raise InputError("steps, time", NOT_GIVEN, "give one of the two")
    if not step_sizes:
        raise InputError("step_sizes", step_sizes, "give one at least")
    counts: dict[Fraction, int] = {}
    for size in step_sizes:
        h = positive(size, "step_size")
        if h in counts:
            raise InputError("step_size", size, "is given twice")
        if steps is None:
            count = int(positive(time if time is not None else 0, "time") / h)
            if count < 1:
                raise InputError("time", time, f"is shorter than the step size {text(h)}")
            counts[h] = count
        else:
            counts[h] = steps
    return list(counts.items())


def check_reference(arithmetic: str) -> None:
    """InputError for what cannot stand for exact arithmetic."""
    allowed = [AUTO, *(name for name in number_systems.names() if name != float64.NAME)]
    if arithmetic not in allowed:
        wrong = "is what is examined" if arithmetic == float64.NAME else "unknown"
        raise InputError("arithmetic", arithmetic, f"{wrong}; allowed: {', '.join(allowed)}")
