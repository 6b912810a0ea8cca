"""`verify.separate` and `verify.separate_grid`: truncation and rounding in Λ of a float64 run."""

from collections.abc import Sequence

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
from verify.scenes.results.separation import SeparationGrid, SeparationResult
from verify.scenes.values import AUTO, steps_from
from verify.studies.separation import separate as study


def separate(
    system: GivenSystem,
    scheme: GivenScheme,
    *,
    q: Exact,
    p: Exact,
    step_size: Exact,
    steps: int | None = None,
    time: Exact | None = None,
    t0: Exact = 0,
    parameters: GivenParameters = None,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationResult:
    """Λ of a float64 run from (q, p), split into truncation and four kinds of rounding, of an
    H in time five.

    The arguments are those of `verify.run`; `digits`: significant digits wanted of every part;
    `arithmetic` stands for exact arithmetic, and is not float64. Raises InputError, one line.

    >>> found = separate("pendulum", "lie2", q=1.5, p=0, step_size=0.1, steps=10)
    >>> found.plain.parts.truncation > found.plain.parts.total
    True
    """
    exact = hamiltonian_from(system, parameters)
    name, count = scheme_name(scheme, exact), steps_from(steps, time, step_size)
    with progress_of(progress, "separating, steps", study.RUNS * count, adding=True) as tell:
        return study.separate(
            exact,
            name,
            q=q,
            p=p,
            step_size=step_size,
            steps=count,
            t0=t0,
            digits=whole("digits", digits, 1),
            arithmetic=arithmetic,
            progress=tell,
        )


def separate_grid(
    system: GivenSystem,
    scheme: GivenScheme,
    *,
    q: Exact,
    p: Exact,
    step_sizes: Sequence[Exact],
    steps: int | None = None,
    time: Exact | None = None,
    t0: Exact = 0,
    parameters: GivenParameters = None,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress = None,
) -> SeparationGrid:
    """`separate` for several step sizes, and the one below which rounding is the larger part.

    N = `steps` steps, or N = ⌊time / h⌋ of each h. Raises InputError as `separate` does, and where
    a step size is given twice.
    """
    exact = hamiltonian_from(system, parameters)
    name, sizes = scheme_name(scheme, exact), listed("step_sizes", step_sizes)
    steps = None if steps is None else whole("steps", steps, 1)
    total = study.RUNS * sum(count for _, count in study.grid(sizes, steps, time))
    with progress_of(progress, "separating, steps", total, adding=True) as tell:
        return study.separate_grid(
            exact,
            name,
            q=q,
            p=p,
            step_sizes=sizes,
            steps=steps,
            time=time,
            t0=t0,
            digits=whole("digits", digits, 1),
            arithmetic=arithmetic,
            progress=tell,
        )
