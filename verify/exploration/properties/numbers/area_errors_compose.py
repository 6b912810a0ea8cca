"""Λ composes: 1 + Λ over N steps is the product of 1 + Λ over the first M and over the others."""

from collections.abc import Mapping
from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.exploration.any_sample import AnySample
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees

_DIGITS = 50
_IN_DEGREES = 4  # one in so many samples in n degrees of freedom
_KNOWN = Fraction(1, 10**30)


def holds(sample: Sample) -> None:
    only_if(sample.steps > 1 and sample.short and not sample.step_map.preserves_area)
    _must_compose(sample)


def _must_compose(sample: AnySample) -> None:
    middle = sample.steps // 2
    whole = _run(sample, sample.start, sample.steps)
    first = _run(sample, sample.start, middle)
    after = sample.start | {name: first[name] for name in sample.point}
    if sample.timed:
        after["t"] += middle * sample.step_size
    second = _run(sample, after, sample.steps - middle)
    product = (1 + first["lambda"]) * (1 + second["lambda"])
    size = 1 + abs(first["lambda"]) + abs(second["lambda"])
    if abs(1 + whole["lambda"] - product) > _KNOWN * size**2:
        found, wanted = decimal(whole["lambda"], 12), decimal(product - 1, 12)
        raise Violation(f"Λ over {sample.steps} steps is {found}, and composed {wanted}")


def _run(sample: AnySample, start: dict[str, Fraction], steps: int) -> Mapping[str, Fraction]:
    """The state and Λ after the steps; Silent where they leave the range of the digits."""
    found = sample.run("mpfr", _DIGITS, "lambda", start=start, steps=steps)
    only_if(found.done == steps and max(map(abs, found.values.values())) <= 10**6)
    return found.values


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The same of Π det J − 1."""
    only_if(sample.is_turn(_IN_DEGREES) and sample.steps > 1 and sample.short)
    only_if(not sample.step_map.symplectic_by_conditions)
    _must_compose(sample)
