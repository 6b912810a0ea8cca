"""What is found of stability as results, with numbers as decimals."""

from collections.abc import Sequence
from fractions import Fraction

from verify.arithmetic.exact import decimal, plain, text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Number, Prose, prose
from verify.scenes.results.stability import (
    LargestStepResult,
    MapCell,
    StabilityMapResult,
    StabilityResult,
)
from verify.studies.stability.limits import frequency, largest_step, linear_limit, stability_map
from verify.studies.stability.trail import Run
from verify.studies.stability.verdict_on_run import Judgement, judge


def run_result(run: Run) -> StabilityResult:
    """The verdict on one run."""
    found = judge(run)
    limit, h_omega = linear_limit(run.scheme), run.step_size * frequency(found.orbit)
    return StabilityResult(
        **run.hamiltonian.texts,
        scheme=run.scheme,
        step_size=text(run.step_size),
        steps=run.steps,
        q=text(run.q),
        p=text(run.p),
        kind=found.kind,
        step=found.step,
        rate=_rounded(found.rate),
        energy_error=_rounded(found.energy_error),
        h_omega=_rounded(h_omega) if h_omega else None,
        linear_limit=_rounded(limit, 6),
        exact_orbit=found.orbit.summary,
        detail=found.detail + _against_theory(found, h_omega, limit),
    )


def _against_theory(found: Judgement, h_omega: Fraction, limit: Fraction | None) -> Prose:
    """What linear theory says of a scheme that is to blame."""
    if found.kind != "unstable: scheme" or limit is None or not h_omega:
        return Prose()
    if limit == 0:
        return prose("; in linear theory it is stable for no step size")
    side = "beyond" if h_omega > limit else "within"
    sizes = Number(plain(h_omega, 3)), Number(plain(limit, 3))
    return prose("; hω = ", sizes[0], f" is {side} its linear limit ", sizes[1])


def largest_step_result(
    hamiltonian: Hamiltonian, scheme: str, *, p: Fraction, q: Fraction, time: Fraction
) -> LargestStepResult:
    """The largest step size with bounded motion from (p, q) until that time."""
    found = largest_step(hamiltonian, scheme, p, q, time)
    h = found.bounded
    return LargestStepResult(
        **hamiltonian.texts,
        scheme=scheme,
        time=text(time),
        q=text(q),
        p=text(p),
        bounded=_rounded(h, 4),
        unbounded=_rounded(found.unbounded, 4),
        linear=_rounded(found.linear, 4),
        h_omega=_rounded(h * frequency(found.orbit), 4) if h else None,
        exact_orbit=found.orbit.summary,
        detail=found.detail,
    )


def map_result(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    parameter: str,
    values: Sequence[Fraction],
    step_sizes: Sequence[Fraction],
    steps: int,
    p: Fraction,
    q: Fraction,
) -> StabilityMapResult:
    """The verdicts for each value of the parameter, a row, with each step size."""
    rows = list(
        stability_map(
            hamiltonian, scheme, parameter=parameter,
            values=values, step_sizes=step_sizes, steps=steps, p=p, q=q,
        )
    )  # fmt: skip
    return StabilityMapResult(
        **hamiltonian.texts,
        scheme=scheme,
        parameter=parameter,
        values=tuple(map(text, values)),
        step_sizes=tuple(map(text, step_sizes)),
        steps=steps,
        q=text(q),
        p=text(p),
        cells=tuple(tuple(MapCell(kind=x.kind, step=x.step) for x in row) for _, row in rows),
        linear=tuple(_rounded(h, 4) for h, _ in rows),
    )


def _rounded(x: Fraction | None, digits: int = 3) -> str | None:
    return None if x is None else decimal(x, digits)
