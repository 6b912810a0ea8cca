"""Truncation separated from rounding in the area error Λ of a float64 run.

Λ = Π (1 + ΔJ_k) − 1, ΔJ = det J − 1 of one step. A chain of five values leads from exact arithmetic
to what a float64 program prints:

    Λ₀  exact arithmetic at the exact inputs
    Λ₁  exact arithmetic at the inputs (h, parameters, p₀, q₀) rounded to float64
    Λ₂  float64's states z̃_k from the rounded inputs, bit by bit; exact ΔJ at them and exact product
    Λ₃  float64's factors det J(z̃_k) at these states, bit by bit; exact product
    Λ₄  float64's product of these factors: Λ of a float64 program, `lambda_working`

The exact flow has Λ = 0, so Λ₀ is the truncation part, the error of the scheme itself. Each later
link adds rounding of one kind, and the sum telescopes:

    Λ₄ = Λ₀ + (Λ₁ − Λ₀) + (Λ₂ − Λ₁) + (Λ₃ − Λ₂) + (Λ₄ − Λ₃)
       = truncation + input + trajectory + determinant + product

If H depends on time a link after Λ₁ adds a part `clock`: exact arithmetic at the rounded inputs,
but each step at the time of a float64 program's clock, t ← t + h, which differs from t₀ + k h by
the rounding so far. Λ₂ and all links after it read that clock.

The sum is one equation of rationals (`verify.studies.separation.chain`): it holds exactly whatever
the errors of the computed Λ₀ … Λ₃ are, which are bounded. The order of the links is a choice, since
effects interact: a part is what its rounding adds to those before it. Constants in H's formula,
such as the 0.1 of 0.1*q**4, are no inputs; their rounding belongs to `trajectory` and
`determinant`.

Two ways to evaluate Λ in float64 are separated. `plain`: four entries of J, their determinant, the
product of determinants, minus 1; each step's determinant is near 1 and rounded by about 2⁻⁵³,
however small ΔJ is. `closed_form`: ΔJ from a formula of its own, in which nothing cancels, and Λ =
expm1(Σ log1p(ΔJ_k)), with the errors of the sum's additions added at the end. Truncation, input and
trajectory are the same for both.

In n degrees of freedom W = MᵀΩM − Ω, M the product of the steps' Jacobians, is split in the same
way, entry by entry (`verify.studies.separation.matrix_products`). `plain` multiplies the Jacobians
and computes W from M at the end; `closed_form` adds MᵀSM, S = JᵀΩJ − Ω, at every step, as
`verify run` does. The growth of W and of M is the subject of
`verify.studies.separation.growth_fits` and `verify.studies.separation.tangent`.

The error bounds of the parts are in `verify.studies.separation.determinants`,
`verify.studies.separation.matrix_products` and `verify.runs.estimates`; fits to a run's
checkpoints and to a grid of step sizes are in `verify.studies.separation.growth_fits`.
"""

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

from verify import arithmetic as number_systems
from verify.arithmetic import AUTO
from verify.arithmetic.exact import Number, NumberOrList, positive, rational, text
from verify.arithmetic.systems import float64
from verify.errors import NOT_GIVEN, InputError
from verify.execution.keeper import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import check_times, point_of
from verify.lockstep import Course, run_alone
from verify.runs.requested_run import RequestedRun, check
from verify.runs.run_start import Start
from verify.scenes.results import separation
from verify.scenes.results.separation_parts import AnyEvaluation
from verify.schemes import canonical
from verify.studies.separation.growth_fits import find_crossover
from verify.studies.separation.links import Chains, separate_chains, way_for
from verify.studies.separation.mixed_run import Stopped
from verify.studies.separation.result import Split, evaluation
from verify.studies.separation.tangent import tangent_growth

Progress = Callable[[int], None]  # called with the number of steps just done; 3 N are expected
_GRIDS: dict[type[separation.Separation], type[separation.AnyGrid]] = {
    separation.SeparationResult: separation.SeparationGrid,
    separation.SeparationInDegrees: separation.SeparationGridInDegrees,
}
RUNS = 3  # runs of N steps: two in place of exact arithmetic, one in float64 with it beside


def separate(hamiltonian: Hamiltonian, scheme: str, **arguments: Any) -> separation.AnySeparation:
    """Return the result of `separate_in_turn`, which takes the same arguments, done alone."""
    return run_alone(separate_in_turn(hamiltonian, scheme, **arguments))


def separate_in_turn(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    q: NumberOrList,
    p: NumberOrList,
    step_size: Number,
    steps: int,
    t0: Number = 0,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress | None = None,
    keeper: Keeper = NOTHING,
    run: RequestedRun | None = None,
) -> Course[separation.AnySeparation]:
    """Split Λ of a float64 run of `steps` steps from (q, p) into truncation and rounding.

    In n degrees of freedom, where q and p are lists, it splits W.

    `t0`: the time at which it starts, if H depends on time. `digits`: significant digits of every
    part. `arithmetic` stands for exact arithmetic; `auto` takes the fastest that can. `run`: a
    requested run of the same steps in the plane, which is done once for both. Raises InputError for
    h ≤ 0, N < 1, a parameter without a value, unknown names, more than 4 degrees of freedom, and
    for `arithmetic` float64, which is examined itself.
    """
    scheme, h, way = canonical(scheme), positive(step_size, "step_size"), way_for(hamiltonian)
    run_start = Start(hamiltonian, scheme, h, point_of(hamiltonian, q, p), rational(t0, "t0"))
    start = {**run_start.point, "h": h}
    if hamiltonian.time_dependent:
        start["t"] = run_start.t0
    check_times(hamiltonian, run_start.t0, h, steps)
    check(hamiltonian, steps, digits, (way.observable,))
    check_reference(arithmetic)
    arguments = hamiltonian, scheme, start, steps, digits, arithmetic, progress or (lambda _: None)
    fields: dict[str, Any] = {
        **hamiltonian.texts, "scheme": scheme, "arithmetic": arithmetic, "digits": digits,
        "step_size": text(h), "steps": steps, "q": run_start.text("q"), "p": run_start.text("p"),
        "t0": text(start.get("t", Fraction(0))), "status": "finished", "failed_step": None,
        "reason": "", "plain": None, "closed_form": None, "error_method": "none", "seconds": 0.0,
        "coordinates": hamiltonian.coordinates, "tangent": None,
    }  # fmt: skip
    try:
        chains = yield from separate_chains(*arguments, keeper, run)
        fields |= _chain_fields(chains, run_start, steps, digits)
    except Stopped as stopped:
        fields |= {"status": stopped.status, "failed_step": stopped.step, "reason": stopped.reason}
    return way.result(**{name: fields[name] for name in way.result.model_fields})


def _chain_fields(chains: Chains, run_start: Start, steps: int, digits: int) -> dict[str, Any]:
    """Return the fields of a result that depend on the chains."""
    sizes, closed_form = chains.sizes, chains.closed_form and Split(chains.closed_form)
    methods = dict.fromkeys(x for chain in chains.plain for x in chain.methods)
    return {
        "arithmetic": chains.arithmetic,
        "plain": evaluation(Split(chains.plain), digits, sizes),
        "closed_form": closed_form and evaluation(closed_form, digits, sizes),
        "tangent": tangent_growth(closed_form, sizes, run_start, steps)
        if closed_form and sizes
        else None,
        "error_method": "; ".join(methods),
        "seconds": chains.seconds,
    }


def separate_grid(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    step_sizes: Sequence[Number],
    steps: int | None = None,
    time: Number | None = None,
    digits: int = 17,
    **arguments: Any,
) -> separation.AnyGrid:
    """Return `separate` for several step sizes, over N = `steps` steps or N = ⌊time / h⌋ each.

    Raises InputError as `separate` does, if a step size occurs twice, and unless exactly one of
    `steps` and `time` is set.
    """
    counts = count_steps(step_sizes, steps, time)
    # A bad number of steps is reported at once, not after hours of runs for other step sizes.
    for _, count in counts:
        check(hamiltonian, count, digits, ())
    arguments |= {"digits": digits}
    return as_grid(
        [
            separate(hamiltonian, scheme, step_size=h, steps=count, **arguments)
            for h, count in counts
        ]
    )


def as_grid(points: Sequence[separation.Separation]) -> separation.AnyGrid:
    """Join separations for several step sizes, with the crossover of each way to evaluate them."""
    crossovers = {
        way: find_crossing((x.step_size, getattr(x, way)) for x in points)
        for way in separation.WAYS
    }
    return _GRIDS[type(points[0])].model_validate({"points": tuple(points), **crossovers})


def find_crossing(ways: Iterable[tuple[str, AnyEvaluation | None]]) -> separation.CrossoverResult:
    """Find where rounding overtakes truncation, from each step size's evaluation by one way."""
    parts = ((h, way.largest["truncation"], way.largest["total"]) for h, way in ways if way)
    # The greatest sizes along the run stand for it: a last value may be small by chance.
    overtaking = find_crossover([(Fraction(h), Fraction(x), Fraction(y)) for h, x, y in parts])
    size = None if overtaking.step_size is None else f"{overtaking.step_size:.3e}"
    ends = overtaking.bracket and (text(overtaking.bracket[0]), text(overtaking.bracket[1]))
    return separation.CrossoverResult(step_size=size, bracket=ends, reason=overtaking.reason)


def count_steps(
    step_sizes: Sequence[Number], steps: int | None, time: Number | None
) -> list[tuple[Fraction, int]]:
    """Return each step size with its number of steps; see `separate_grid`."""
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
    """Raise InputError for an arithmetic that cannot stand for exact arithmetic."""
    names = [AUTO, *(name for name in number_systems.names() if name != float64.NAME)]
    if arithmetic not in names:
        wrong = "is what is examined" if arithmetic == float64.NAME else "unknown"
        raise InputError("arithmetic", arithmetic, f"{wrong}; allowed: {', '.join(names)}")
