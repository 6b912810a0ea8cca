"""`verify.separate` and `verify.separate_grid`: truncation and rounding of a float64 run.

Both are parts of the run's area error Λ or, in n degrees of freedom, of its symplectic defect W.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, overload

from verify.arithmetic.exact import Number, NumberOrList, whole
from verify.calls import inputs
from verify.calls.progress import Progress, progress_of
from verify.hamiltonians.run_domain import check_start
from verify.scenes.results import separation
from verify.scenes.values import AUTO, steps_from
from verify.studies.separation import truncation_and_rounding as study


@overload
def separate(
    system: inputs.SystemLike, scheme: inputs.SchemeLike, *, q: Number, p: Number,
    step_size: Number, steps: int | None = None, time: Number | None = None, t0: Number = 0,
    parameters: inputs.ParametersLike = None, digits: int = 17, arithmetic: str = AUTO,
    progress: Progress = None,
) -> separation.SeparationResult: ...  # fmt: skip


@overload
def separate(
    system: inputs.SystemLike, scheme: inputs.SchemeLike, *, q: NumberOrList, p: NumberOrList,
    step_size: Number, steps: int | None = None, time: Number | None = None, t0: Number = 0,
    parameters: inputs.ParametersLike = None, digits: int = 17, arithmetic: str = AUTO,
    progress: Progress = None,
) -> separation.SeparationResult | separation.SeparationInDegrees: ...  # fmt: skip


def separate(
    system: inputs.SystemLike,
    scheme: inputs.SchemeLike,
    *,
    q: NumberOrList,
    p: NumberOrList,
    step_size: Number,
    steps: int | None = None,
    time: Number | None = None,
    t0: Number = 0,
    parameters: inputs.ParametersLike = None,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress = None,
) -> separation.SeparationResult | separation.SeparationInDegrees:
    """Split Λ of a float64 run from (q, p) into truncation and four kinds of rounding.

    An H that depends on time has five kinds. In n degrees of freedom q and p are lists of n
    numbers, and each entry of W = MᵀΩM − Ω is split; M is the product of the steps' Jacobians.

    Parameters
    ----------
    system, scheme, q, p, step_size, steps, time, t0, parameters, progress: as in `verify.run`.
    digits: the requested significant digits of every part.
    arithmetic: the number system that stands for exact arithmetic; not float64.

    Returns a SeparationResult, or for lists q and p a SeparationInDegrees. Its `plain` and
    `closed_form` are two ways to evaluate Λ or W; the `parts` of each have bounds, and add up to
    float64's value. Both are None if the run left its range. Raises InputError, one line.

    >>> result = separate("pendulum", "lie2", q=1.5, p=0, step_size=0.1, steps=10)
    >>> result.plain.parts.truncation > result.plain.parts.total
    True
    """
    count = steps_from(steps, time, step_size)
    grid = separate_grid(
        system, scheme, q=q, p=p, step_sizes=[step_size], steps=count, t0=t0,
        parameters=parameters, digits=digits, arithmetic=arithmetic, progress=progress,
    )  # fmt: skip
    return grid.points[0]


@overload
def separate_grid(
    system: inputs.SystemLike, scheme: inputs.SchemeLike, *, q: Number, p: Number,
    step_sizes: Sequence[Number], steps: int | None = None, time: Number | None = None,
    t0: Number = 0, parameters: inputs.ParametersLike = None, digits: int = 17,
    arithmetic: str = AUTO, progress: Progress = None,
) -> separation.SeparationGrid: ...  # fmt: skip


@overload
def separate_grid(
    system: inputs.SystemLike, scheme: inputs.SchemeLike, *, q: NumberOrList, p: NumberOrList,
    step_sizes: Sequence[Number], steps: int | None = None, time: Number | None = None,
    t0: Number = 0, parameters: inputs.ParametersLike = None, digits: int = 17,
    arithmetic: str = AUTO, progress: Progress = None,
) -> separation.SeparationGrid | separation.SeparationGridInDegrees: ...  # fmt: skip


def separate_grid(
    system: inputs.SystemLike,
    scheme: inputs.SchemeLike,
    *,
    q: NumberOrList,
    p: NumberOrList,
    step_sizes: Sequence[Number],
    steps: int | None = None,
    time: Number | None = None,
    t0: Number = 0,
    parameters: inputs.ParametersLike = None,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress = None,
) -> separation.SeparationGrid | separation.SeparationGridInDegrees:
    """Separate for several step sizes, and find the one below which rounding is the larger part.

    The arguments are those of `verify.separate`, with a list of step sizes; each h has `steps` or
    ⌊time / h⌋ steps. Returns a SeparationGrid, or for lists q and p a SeparationGridInDegrees:
    `points` has a separation for each step size, in the order of the list; `plain` and
    `closed_form` are the step sizes at which the parts cross, in these two evaluations. Raises
    InputError as `separate` does, and for a repeated step size.
    """
    hamiltonian = inputs.hamiltonian_from(system, parameters)
    name, sizes = inputs.scheme_name(scheme, hamiltonian), inputs.as_list("step_sizes", step_sizes)
    steps = None if steps is None else whole("steps", steps, 1)
    # A separation takes several runs of N steps; the bar counts the steps of all of them.
    total = study.RUNS * sum(count for _, count in study.count_steps(sizes, steps, time))
    options: dict[str, Any] = {"q": q, "p": p, "step_sizes": sizes, "steps": steps, "time": time}
    with progress_of(progress, "separating, steps", total, adding=True) as report:
        options |= {"t0": t0, "digits": whole("digits", digits, 1), "arithmetic": arithmetic}
        check_start(hamiltonian, q, p, t0)
        return study.separate_grid(hamiltonian, name, **options, progress=report)
