"""How bad a scene is for float64, or for its scheme: what worst-case hunting makes as large as can.

Each is a decimal logarithm, None where the scene has none: its orbit leaves a bounded part of the
plane, or what it divides by is exactly 0.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from verify import arithmetic as number_systems
from verify.exact import magnitude
from verify.example import Example
from verify.separation_chain import Separation
from verify.separation_working import Stopped
from verify.stepping import Job, Outcome

_DIGITS, _REFERENCE_DIGITS = 4, 40
_POINTS = 100  # of an orbit that is drawn
_FAR = 10  # a run that goes farther from the origin is of no ordinary scene
_ROUNDOFF = Fraction(1, 2**53)


@dataclass(frozen=True)
class Measure:
    """`value(example)`: lg of it, or None; `sentence`: what it is."""

    name: str
    sentence: str
    value: Callable[[Example], float | None]


def rounding_share(example: Example) -> float | None:
    """lg of the greatest rounding part over the greatest truncation part, at checkpoints of a run.

    The greatest ones, as Λ itself may pass through 0, where any error is infinitely large.
    """
    if _stays(example) is None:
        return None
    try:
        given = example.hamiltonian, example.scheme.name, example.start, example.steps
        chain = Separation(*given).chains(_DIGITS).plain
    except Stopped:
        return None
    truncation, rounding = (max(map(abs, chain.trail(n)[0])) for n in ("truncation", "total"))
    return None if not truncation or not rounding else _lg(rounding / truncation)


def digits_lost(example: Example) -> float | None:
    """lg of the error of float64's p and q after the run, in units of its roundoff."""
    exact = _stays(example)
    if exact is None:
        return None
    found = _job(example, frozenset()).go(number_systems.get("float64", 17))
    if found.done < example.steps:
        return None
    size = max(abs(exact.values[n]) for n in "pq")
    error = max(abs(found.values[n] - exact.values[n]) for n in "pq")
    return None if not size or not error else _lg(error / (size * _ROUNDOFF))


def growth(example: Example) -> float | None:
    """lg of the greatest |Λ| of the run, in numbers of 40 digits: no rounding is in it."""
    found = _stays(example)
    if found is None or not found.values["lambda_max"]:
        return None
    return _lg(found.values["lambda_max"])


def orbit(example: Example) -> list[tuple[Fraction, Fraction]]:
    """Points (q, p) of the run with 40 digits, from the initial value on."""
    given = example.hamiltonian, example.scheme.name, example.start, example.steps
    job = Job(*given, frozenset(), 0, sections=_POINTS)
    trail = job.go(number_systems.get("mpfr", _REFERENCE_DIGITS)).trail
    return [(example.q, example.p), *((x["q"], x["p"]) for x in trail)]


def _stays(example: Example) -> Outcome | None:
    """The run with 40 digits; None where it goes far."""
    found = _job(example, frozenset({"lambda_max"})).go(
        number_systems.get("mpfr", _REFERENCE_DIGITS)
    )
    if found.done < example.steps:
        return None
    near = all(max(abs(x["p"]), abs(x["q"])) <= _FAR for x in found.trail)
    return found if near else None


def _job(example: Example, observables: frozenset[str]) -> Job:
    given = example.hamiltonian, example.scheme.name, example.start, example.steps
    return Job(*given, observables, 0)


def _lg(x: Fraction) -> float:
    e = magnitude(x)
    return e + math.log10(x / Fraction(10) ** e)


MEASURES = {
    measure.name: measure
    for measure in (
        Measure("rounding-share", "rounding part over truncation part of Λ", rounding_share),
        Measure("digits-lost", "error of float64's p and q, in roundoffs", digits_lost),
        Measure("growth", "greatest |Λ| of the run", growth),
    )
}
