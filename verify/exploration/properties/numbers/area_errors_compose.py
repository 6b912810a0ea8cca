"""Λ composes: 1 + Λ over N steps is the product of 1 + Λ over the first M and over the others."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample

_DIGITS = 50
_ACCURACY = Fraction(1, 10**30)


def holds(sample: Sample) -> None:
    only_if(sample.steps > 1 and sample.short and not sample.step_map.preserves_area)
    middle = sample.steps // 2
    first_part = replace(sample, steps=middle)
    whole, first = _run(sample), _run(first_part)
    # The second run starts where and when the first one ends.
    second = _run(
        replace(
            first_part.with_place(first[name] for name in sample.point),
            t0=sample.t0 + middle * sample.step_size,
            steps=sample.steps - middle,
        )
    )
    product = (1 + first["lambda"]) * (1 + second["lambda"])
    size = 1 + abs(first["lambda"]) + abs(second["lambda"])
    if abs(1 + whole["lambda"] - product) > _ACCURACY * size**2:
        computed, expected = decimal(whole["lambda"], 12), decimal(product - 1, 12)
        raise Violation(f"Λ over {sample.steps} steps is {computed}, and composed {expected}")


def _run(sample: Sample) -> Mapping[str, Fraction]:
    """Return the state and Λ after the steps; Silent if they leave the range of the digits."""
    outcome = sample.run("mpfr", _DIGITS, "lambda")
    only_if(outcome.done == sample.steps and max(map(abs, outcome.values.values())) <= 10**6)
    return outcome.values
