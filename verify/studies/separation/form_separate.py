"""Truncation separated from rounding in W of a float64 run, in n degrees of freedom.

The chain is told in `verify.studies.separation.form_chain`, the two ways to evaluate W in float64
in `verify.studies.separation.form_run`, how W and the tangent map grow in
`verify.studies.separation.form_growth`; `plain` is what a program does that multiplies the steps'
Jacobians and takes MᵀΩM − Ω at the end, `closed_form` is that of `verify run`.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import partial

from verify.arithmetic import AUTO
from verify.arithmetic.exact import Exact, positive, rational, text
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import Given, point_of
from verify.hamiltonians.times_on_the_way import check_times
from verify.runs.run import check
from verify.runs.start import Start
from verify.scenes.results.separation_in_degrees import (
    SeparationGridInDegrees,
    SeparationInDegrees,
)
from verify.schemes import canonical
from verify.studies.separation.form_chain import FormChains, form_chains
from verify.studies.separation.form_growth import motion_of
from verify.studies.separation.form_motion import halved
from verify.studies.separation.form_result import FormWay
from verify.studies.separation.separate import check_reference, crossing, grid
from verify.studies.separation.working import Stopped

Progress = Callable[[int], None]  # called with a number of steps just done


def separate_in_degrees(
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
) -> SeparationInDegrees:
    """W of a float64 run of `steps` steps from (q, p), lists, split into truncation and rounding.

    Arguments as in `verify.studies.separation.separate.separate`. Raises InputError as that does,
    for lists of another length, more than 4 degrees of freedom, and a scheme that solves equations.
    """
    scheme = canonical(scheme)
    h = positive(step_size, "step_size")
    begun = Start(hamiltonian, scheme, h, point_of(hamiltonian, q, p), rational(t0, "t0"))
    start = {**begun.point, "h": h}
    if hamiltonian.time_dependent:
        start["t"] = begun.t0
        check_times(hamiltonian, begun.t0, h, steps)
    check(hamiltonian, steps, digits, ("symplectic_defect",))
    check_reference(arithmetic)
    found: FormChains | None = None
    stopped = None
    try:
        advance = progress or (lambda _: None)
        found = form_chains(hamiltonian, scheme, start, steps, digits, arithmetic, advance, keeper)
    except Stopped as answer:
        stopped = answer
    motion = motion_of(found.marks, [x.norm for x in found.sizes]) if found else "undecided"
    plain = FormWay(found.plain, found.sizes, motion) if found else None
    closed = FormWay(found.closed_form, found.sizes, motion) if found else None
    return SeparationInDegrees(
        **hamiltonian.texts,
        scheme=scheme,
        arithmetic=found.arithmetic if found else arithmetic,
        digits=digits,
        step_size=text(h),
        steps=steps,
        coordinates=hamiltonian.coordinates,
        q=tuple(begun.text("q")),
        p=tuple(begun.text("p")),
        t0=text(start.get("t", Fraction(0))),
        status=stopped.status if stopped else "finished",
        failed_step=stopped.step if stopped else None,
        reason=stopped.reason if stopped else "",
        plain=plain.evaluation(digits) if plain else None,
        closed_form=closed.evaluation(digits) if closed else None,
        tangent=closed.tangent(h * steps, partial(halved, hamiltonian, scheme, start, steps))
        if closed
        else None,
        error_method="; ".join(_methods(found)) if found else "none",
        seconds=found.seconds if found else 0.0,
    )


def separate_grid_in_degrees(
    hamiltonian: Hamiltonian,
    scheme: str,
    *,
    q: Given,
    p: Given,
    step_sizes: Sequence[Exact],
    steps: int | None = None,
    time: Exact | None = None,
    t0: Exact = 0,
    digits: int = 17,
    arithmetic: str = AUTO,
    progress: Progress | None = None,
) -> SeparationGridInDegrees:
    """`separate_in_degrees` for several step sizes, over N = `steps` steps or N = ⌊time / h⌋ each.

    Raises InputError as that does, and as `verify.studies.separation.separate.separate_grid` does.
    """
    counts = grid(step_sizes, steps, time)
    for _, count in counts:
        check(hamiltonian, count, digits, ())  # before the first of them is run
    return grid_in_degrees(
        [
            separate_in_degrees(
                hamiltonian, scheme, q=q, p=p, step_size=h, steps=count, t0=t0, digits=digits,
                arithmetic=arithmetic, progress=progress,
            )
            for h, count in counts
        ]
    )  # fmt: skip


def grid_in_degrees(points: Sequence[SeparationInDegrees]) -> SeparationGridInDegrees:
    """Separations for several step sizes, with the crossover of each way to evaluate W."""
    return SeparationGridInDegrees(
        points=tuple(points),
        plain=crossing((point.step_size, point.plain) for point in points),
        closed_form=crossing((point.step_size, point.closed_form) for point in points),
    )


def _methods(found: FormChains) -> dict[str, None]:
    return dict.fromkeys(x for chain in found.plain for x in chain.methods)
