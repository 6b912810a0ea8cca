"""What chains of W's entries become in a result: matrices, greatest entries, and how W grew."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import isqrt, log, log10

from verify.arithmetic.exact import decimal, known_text, magnitude, text
from verify.prose import Number, Prose, prose
from verify.runs.tangent_growth import finite_time_lyapunov
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.separation_in_degrees import (
    FormAt,
    FormEvaluation,
    FormParts,
    FormPartsInTime,
    FormValue,
    PowerLawResult,
    TangentGrowth,
)
from verify.studies.separation.chain import Chain
from verify.studies.separation.form_growth import Kind, PowerLaw, power_law
from verify.studies.separation.form_motion import Cause, Halved
from verify.studies.separation.form_run import Size
from verify.studies.separation.growth import growth, log_spaced
from verify.studies.separation.separate import growth_result

_SHOWN = 7  # digits of what a figure shows
_CHECKPOINTS = 32
_SO_W = (
    "; W adds MᵀSM at every step, S of that step and M the tangent map so far, and so grows as "
    "areas do under M, at most like ‖M‖²"
)
_WHOSE: dict[Cause, str] = {
    "motion": ": that growth is the motion's, not the scheme's",
    "scheme": ": that growth is the scheme's at this step size",
    "undecided": ": whether that growth is the motion's or the scheme's is not decided",
}


class FormWay:
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

    def tangent(self, time: Fraction, half: Callable[[float], Halved]) -> TangentGrowth:
        """How M grew, and what follows for W; `half` tells of an exponential rate whose it is."""
        last, size = self.sizes[-1], _size(len(self.chains))
        rate = finite_time_lyapunov(log(float(_root(last.norm))), size, float(time))
        halved = half(rate) if self.motion == "exponential" else None
        areas = [_root(x.areas) for x in self.sizes]
        laws = [
            power_law(self.marks, each, Fraction(0), self.motion)
            for each in ([x.norm for x in self.sizes], areas)
        ]
        return TangentGrowth(
            norm_squared=decimal(last.norm, _SHOWN),
            areas=decimal(areas[-1], _SHOWN),
            time=text(time),
            finite_time_lyapunov=_short(rate),
            motion=self.motion,
            cause=halved.cause if halved else None,
            at_half_step=_short(halved.rate) if halved and halved.rate is not None else None,
            law=_law(laws[0]),
            law_of_areas=_law(laws[1]),
            per_area=decimal(self.tops["truncation"][-1] / areas[-1], 3),
            meaning=self._exponential(rate, halved) if halved else self._power(laws[0]),
        )

    def _exponential(self, rate: float, halved: Halved) -> Prose:
        times = Number(f"{log10(self.sizes[-1].norm / self.sizes[0].norm):.1f}")
        own = prose("‖M‖² grew exponentially, 10^", times, "-fold, at a finite-time Lyapunov ",
                    "exponent of ", Number(_short(rate)), " per unit of time")  # fmt: skip
        if not any(self.tops["truncation"]):
            return prose(own, "; S ≡ 0 is proved, so that all of W is rounding, which M magnifies")
        again = prose(", and with half the step size the orbit leaves the range")
        if halved.rate is not None:
            again = prose(", and of ", Number(_short(halved.rate)), " with half the step size")
        return prose(own, again, _SO_W, _WHOSE[halved.cause])

    def _power(self, law: PowerLaw) -> Prose:
        if not any(self.tops["truncation"]):
            return prose("W is exactly 0 in exact arithmetic: S ≡ 0")
        tops, noise = self.tops["truncation"], self.noise["truncation"]
        own = power_law(self.marks, tops, noise, self.motion)
        if own.exponent is None or law.exponent is None:
            return prose("how W grows with N is not measured: ", own.reason)
        words = {"bounded": "is bounded", "undecided": "follows no whole power"}
        said = words.get(own.name, f"grows like {own.name}")
        measured = " (measured, not proved)"
        if self.motion == "polynomial":
            measured += "; ‖M‖ does not grow exponentially"
        return prose(f"max |W| {said} in this run, with a fitted exponent of ",
                     Number(f"{own.exponent:.2f}"), "; ‖M‖² that of ",
                     Number(f"{law.exponent:.2f}"), measured)  # fmt: skip

    def _at(self, k: int) -> FormAt:
        shown = {_named(n): _few(self.tops[n][k], self.noise[n]) for n in self.names}
        square = decimal(self.sizes[k].norm, _SHOWN)
        return FormAt(steps=self.marks[k], norm_squared=square, parts=shown)


def _law(found: PowerLaw) -> PowerLawResult:
    def shown(x: float | None) -> str | None:
        return None if x is None else f"{x:.3f}"

    numbers = {"exponent": shown(found.exponent), "standard_error": shown(found.standard_error)}
    return PowerLawResult(**vars(found) | numbers)


def _short(x: float) -> str:
    return f"{x:.4g}"


def _few(x: Fraction, noise: Fraction) -> str:
    return known_text(x, noise, _SHOWN)


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
