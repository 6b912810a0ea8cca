"""`verify.separate` and `verify.separate_grid`: truncation and rounding of a float64 run, in Λ or,
where H has more degrees of freedom, in W."""

from collections.abc import Sequence
from typing import Any, overload

from verify.arithmetic.exact import Exact, whole
from verify.calls.given import (
    GivenParameters,
    GivenScheme,
    GivenSystem,
    hamiltonian_from,
    listed,
    scheme_name,
)
from verify.calls.progress import Progress, progress_of
from verify.hamiltonians.start import Given, check_start
from verify.scenes.results.separation import (
    SeparationGrid,
    SeparationGridInDegrees,
    SeparationInDegrees,
    SeparationResult,
)
from verify.scenes.values import AUTO, steps_from
from verify.studies.separation import separate as study


@overload
def separate(
    system: GivenSystem, scheme: GivenScheme, *, q: Exact, p: Exact, step_size: Exact,
    steps: int | None = None, time: Exact | None = None, t0: Exact = 0,
    parameters: GivenParameters = None, digits: int = 17, arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationResult: ...  # fmt: skip


@overload
def separate(
    system: GivenSystem, scheme: GivenScheme, *, q: Given, p: Given, step_size: Exact,
    steps: int | None = None, time: Exact | None = None, t0: Exact = 0,
    parameters: GivenParameters = None, digits: int = 17, arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationResult | SeparationInDegrees: ...  # fmt: skip


def separate(
    system: GivenSystem,
    scheme: GivenScheme,
    *,
    q: Given,
    p: Given,
    step_size: Exact,
    steps: int | None = None,
    time: Exact | None = None,
    t0: Exact = 0,
    parameters: GivenParameters = None,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationResult | SeparationInDegrees:
    """Λ of a float64 run from (q, p), split into truncation and four kinds of rounding, of an
    H in time five. In n degrees of freedom q and p are lists and W = MᵀΩM − Ω, M the product of the
    steps' Jacobians, is split entry by entry: a `SeparationInDegrees`.

    The arguments are those of `verify.run`; `digits`: significant digits wanted of every part;
    `arithmetic` stands for exact arithmetic, and is not float64. Raises InputError, one line.

    >>> found = separate("pendulum", "lie2", q=1.5, p=0, step_size=0.1, steps=10)
    >>> found.plain.parts.truncation > found.plain.parts.total
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
    system: GivenSystem, scheme: GivenScheme, *, q: Exact, p: Exact, step_sizes: Sequence[Exact],
    steps: int | None = None, time: Exact | None = None, t0: Exact = 0,
    parameters: GivenParameters = None, digits: int = 17, arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationGrid: ...  # fmt: skip


@overload
def separate_grid(
    system: GivenSystem, scheme: GivenScheme, *, q: Given, p: Given, step_sizes: Sequence[Exact],
    steps: int | None = None, time: Exact | None = None, t0: Exact = 0,
    parameters: GivenParameters = None, digits: int = 17, arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationGrid | SeparationGridInDegrees: ...  # fmt: skip


def separate_grid(
    system: GivenSystem,
    scheme: GivenScheme,
    *,
    q: Given,
    p: Given,
    step_sizes: Sequence[Exact],
    steps: int | None = None,
    time: Exact | None = None,
    t0: Exact = 0,
    parameters: GivenParameters = None,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationGrid | SeparationGridInDegrees:
    """`separate` for several step sizes, and the one below which rounding is the larger part.

    N = `steps` steps, or N = ⌊time / h⌋ of each h. Raises InputError as `separate` does, and where
    a step size is given twice.
    """
    exact = hamiltonian_from(system, parameters)
    name, sizes = scheme_name(scheme, exact), listed("step_sizes", step_sizes)
    steps = None if steps is None else whole("steps", steps, 1)
    total = study.RUNS * sum(count for _, count in study.grid(sizes, steps, time))
    asked: dict[str, Any] = {"q": q, "p": p, "step_sizes": sizes, "steps": steps, "time": time}
    with progress_of(progress, "separating, steps", total, adding=True) as tell:
        asked |= {"t0": t0, "digits": whole("digits", digits, 1), "arithmetic": arithmetic}
        check_start(exact, q, p, t0)
        return study.separate_grid(exact, name, **asked, progress=tell)
