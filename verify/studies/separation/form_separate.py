"""Truncation separated from rounding in W of a float64 run, in n degrees of freedom.

The chain is told in `verify.studies.separation.form_chain`, the two ways to evaluate W in float64
in `verify.studies.separation.form_run`, how W and the tangent map grow in
`verify.studies.separation.form_growth`; `plain` is what a program does that multiplies the steps'
Jacobians and takes MᵀΩM − Ω at the end, `closed_form` is that of `verify run`.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import isqrt, log10

from verify.arithmetic import AUTO
from verify.arithmetic.exact import (
    Exact,
    decimal,
    known_digits,
    magnitude,
    positive,
    rational,
    text,
)
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import Given, point_of
from verify.hamiltonians.times_on_the_way import check_times
from verify.prose import Number, Prose, prose
from verify.runs.run import check
from verify.runs.start import Start
from verify.runs.tangent_growth import finite_time_lyapunov
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.separation_in_degrees import (
    FormAt,
    FormEvaluation,
    FormParts,
    FormPartsInTime,
    FormValue,
    PowerLawResult,
    SeparationGridInDegrees,
    SeparationInDegrees,
    TangentGrowth,
)
from verify.schemes import canonical
from verify.studies.separation.chain import Chain
from verify.studies.separation.form_chain import FormChains, form_chains
from verify.studies.separation.form_growth import Kind, PowerLaw, motion_of, power_law
from verify.studies.separation.form_run import Size
from verify.studies.separation.growth import growth, log_spaced
from verify.studies.separation.separate import check_reference, crossing, grid, growth_result
from verify.studies.separation.working import Stopped

Progress = Callable[[int], None]  # called with a number of steps just done
_SHOWN = 7  # digits of what a figure shows
_CHECKPOINTS = 32
_NOT_THE_SCHEME = (
    "; W adds MᵀSM at every step, S of that step and M the tangent map so far, and so grows as "
    "areas do under M, at most like ‖M‖²: that growth is the motion's, not the scheme's"
)


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
    plain = _Way(found.plain, found.sizes, motion) if found else None
    closed = _Way(found.closed_form, found.sizes, motion) if found else None
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
        tangent=closed.tangent(h * steps) if closed else None,
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


# -- from chains to a result ----------------------------------------------------------------------


class _Way:
    """All entries of W for one way to evaluate it, and the greatest of them at every checkpoint."""

    def __init__(self, chains: Sequence[Chain], sizes: Sequence[Size], motion: Kind) -> None:
        self.chains, self.sizes, self.motion = chains, sizes, motion
        self.marks, self.names = chains[0].marks, chains[0].quantities
        self.tops: dict[str, list[Fraction]] = {}
        self.noise: dict[str, Fraction] = {}
        for name in self.names:
            trails = [chain.trail(name) for chain in chains]
            each = zip(*(trail for trail, _ in trails), strict=True)
            self.tops[name] = [max(map(abs, entries)) for entries in each]
            self.noise[name] = max(bound for _, bound in trails)

    def evaluation(self, digits: int) -> FormEvaluation:
        """As results have it."""
        size = _size(len(self.chains))
        parts = {
            _named(name): FormValue.of(
                tuple(Value.of(*chain.final(name), digits) for chain in self.chains), size
            )
            for name in self.names
        }
        rounding = ("total", *self.chains[0].parts)
        tops, noise = self.tops, self.noise
        shown = log_spaced(range(len(self.marks)), self.marks, _CHECKPOINTS)
        enclosed = all(chain.kind == "enclosed" for chain in self.chains)
        return FormEvaluation(
            parts=FormPartsInTime(**parts) if "clock" in parts else FormParts(**parts),
            largest={n: _few(max(tops[n]), noise[n]) for n in ("truncation", "total")},
            growth={n: growth_result(growth(self.marks, tops[n], noise[n])) for n in rounding},
            law=self.law("lambda_working"),
            series=tuple(self._at(k) for k in shown),
            error_kind="enclosed" if enclosed else "estimated",
        )

    def law(self, name: str) -> PowerLawResult:
        """How the greatest entry of a quantity grows with N."""
        return _law(power_law(self.marks, self.tops[name], self.noise[name], self.motion))

    def tangent(self, time: Fraction) -> TangentGrowth:
        """How M grew, and what follows for W."""
        last, size = self.sizes[-1], _size(len(self.chains))
        rate = f"{finite_time_lyapunov(float(_root(last.norm)), size, time):.4g}"
        laws = [
            power_law(self.marks, each, Fraction(0), self.motion)
            for each in ([x.norm for x in self.sizes], [_root(x.areas) for x in self.sizes])
        ]
        name = "truncation" if any(self.tops["truncation"]) else "lambda_working"
        own = power_law(self.marks, self.tops[name], self.noise[name], self.motion)
        areas = _root(last.areas)
        return TangentGrowth(
            norm_squared=decimal(last.norm, _SHOWN),
            areas=decimal(areas, _SHOWN),
            time=text(time),
            finite_time_lyapunov=rate,
            motion=self.motion,
            law=_law(laws[0]),
            law_of_areas=_law(laws[1]),
            per_area=decimal(self.tops["truncation"][-1] / areas, 3),
            meaning=_meaning(self.motion, rate, last.norm, size, laws[0], own),
        )

    def _at(self, k: int) -> FormAt:
        shown = {_named(n): _few(self.tops[n][k], self.noise[n]) for n in self.names}
        square = decimal(self.sizes[k].norm, _SHOWN)
        return FormAt(steps=self.marks[k], norm_squared=square, parts=shown)


def _meaning(
    motion: Kind, rate: str, square: Fraction, size: int, law: PowerLaw, own: PowerLaw
) -> Prose:
    if motion == "exponential":
        times = Number(f"{log10(square / size):.1f}")
        grown = ("‖M‖² grew exponentially, 10^", times, "-fold, at a finite-time Lyapunov exponent")
        return prose(*grown, " of ", Number(rate), " per unit of time", _NOT_THE_SCHEME)
    if not own.exponent and own.name == "bounded":
        return prose("W is exactly 0 in exact arithmetic: S ≡ 0")
    if own.exponent is None or law.exponent is None:
        return prose("how W grows with N is not measured: ", own.reason)
    words = {"bounded": "is bounded", "undecided": "follows no whole power"}
    said = words.get(own.name, f"grows like {own.name}")
    exponents = Number(f"{own.exponent:.2f}"), "; ‖M‖² that of ", Number(f"{law.exponent:.2f}")
    return prose(
        f"max |W| {said} in this run, with a fitted exponent of ", *exponents,
        " (measured, not proved); ‖M‖ does not grow exponentially"
        if motion == "polynomial" else " (measured, not proved)",
    )  # fmt: skip


def _law(found: PowerLaw) -> PowerLawResult:
    def shown(x: float | None) -> str | None:
        return None if x is None else f"{x:.3f}"

    numbers = {"exponent": shown(found.exponent), "standard_error": shown(found.standard_error)}
    return PowerLawResult(**vars(found) | numbers)


def _few(x: Fraction, noise: Fraction) -> str:
    return known_digits(x, noise, _SHOWN)[0]


def _named(name: str) -> str:
    return "w_working" if name == "lambda_working" else name


def _root(x: Fraction) -> Fraction:
    """√x to some twelve digits, of any size."""
    digits = max(0, 24 - magnitude(x)) if x else 0
    return Fraction(isqrt(int(x * 10 ** (2 * digits))), 10**digits)


def _size(entries: int) -> int:
    """The rows of an antisymmetric matrix with so many entries above its diagonal."""
    size = 2
    while size * (size - 1) // 2 < entries:
        size += 2
    return size
