"""Tasks on stability → their results, with numbers as decimals."""

from fractions import Fraction

from verify.arithmetic.exact import decimal, plain, text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.stability import (
    LargestStepResult,
    MapCell,
    StabilityMapResult,
    StabilityResult,
)
from verify.scenes.tasks import LargestStepTask, StabilityMapTask, StabilityTask
from verify.studies.stability.limits import frequency, largest_step, linear_limit, stability_map
from verify.studies.stability.trail import Case
from verify.studies.stability.verdict_on_run import Judgement, judge


def judged(hamiltonian: Hamiltonian, task: StabilityTask) -> StabilityResult:
    case = Case(hamiltonian, task.scheme, task.step_size, task.steps, task.p, task.q)
    found = judge(case)
    limit, h_omega = linear_limit(task.scheme), task.step_size * frequency(found.orbit)
    return StabilityResult(
        **hamiltonian.written,
        scheme=task.scheme,
        step_size=text(task.step_size),
        steps=task.steps,
        q=text(task.q),
        p=text(task.p),
        kind=found.kind,
        step=found.step,
        rate=_rounded(found.rate),
        energy_error=_rounded(found.energy_error),
        h_omega=_rounded(h_omega) if h_omega else None,
        linear_limit=_rounded(limit, 6),
        exact_orbit=found.orbit.told,
        detail=found.detail + _against_theory(found, h_omega, limit),
    )


def _against_theory(found: Judgement, h_omega: Fraction, limit: Fraction | None) -> str:
    """What linear theory says of a scheme that is to blame."""
    if found.kind != "unstable: scheme" or limit is None or not h_omega:
        return ""
    if limit == 0:
        return "; in linear theory it is stable for no step size"
    side = "beyond" if h_omega > limit else "within"
    return f"; hω = {plain(h_omega, 3)} is {side} its linear limit {plain(limit, 3)}"


def largest(hamiltonian: Hamiltonian, task: LargestStepTask) -> LargestStepResult:
    found = largest_step(hamiltonian, task.scheme, task.p, task.q, task.time)
    h = found.bounded
    return LargestStepResult(
        **hamiltonian.written,
        scheme=task.scheme,
        time=text(task.time),
        q=text(task.q),
        p=text(task.p),
        bounded=_rounded(h, 4),
        unbounded=_rounded(found.unbounded, 4),
        linear=_rounded(found.linear, 4),
        h_omega=_rounded(h * frequency(found.orbit), 4) if h else None,
        exact_orbit=found.orbit.told,
        detail=found.detail,
    )


def mapped(hamiltonian: Hamiltonian, task: StabilityMapTask) -> StabilityMapResult:
    rows = list(
        stability_map(
            hamiltonian,
            task.scheme,
            parameter=task.parameter,
            values=task.values,
            step_sizes=task.step_sizes,
            steps=task.steps,
            p=task.p,
            q=task.q,
        )
    )
    return StabilityMapResult(
        **hamiltonian.written,
        scheme=task.scheme,
        parameter=task.parameter,
        values=tuple(map(text, task.values)),
        step_sizes=tuple(map(text, task.step_sizes)),
        steps=task.steps,
        q=text(task.q),
        p=text(task.p),
        cells=tuple(tuple(MapCell(kind=x.kind, step=x.step) for x in row) for _, row in rows),
        linear=tuple(_rounded(h, 4) for h, _ in rows),
    )


def _rounded(x: Fraction | None, digits: int = 3) -> str | None:
    return None if x is None else decimal(x, digits)
