"""Λ composes: 1 + Λ over N steps is the product of 1 + Λ over the first M and over the others."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from verify.arithmetic.exact import decimal
from verify.exploration.property import Violation, only_if
from verify.exploration.sample import Sample

_DIGITS = 50
_KNOWN = Fraction(1, 10**30)


def holds(sample: Sample) -> None:
    only_if(sample.steps > 1 and sample.short and not sample.step_map.preserves_area)
    middle = sample.steps // 2
    begun = replace(sample, steps=middle)
    whole, first = _run(sample), _run(begun)
    second = _run(
        replace(
            begun.at(first[name] for name in sample.point),
            t0=sample.t0 + middle * sample.step_size,
            steps=sample.steps - middle,
        )
    )
    product = (1 + first["lambda"]) * (1 + second["lambda"])
    size = 1 + abs(first["lambda"]) + abs(second["lambda"])
    if abs(1 + whole["lambda"] - product) > _KNOWN * size**2:
        found, wanted = decimal(whole["lambda"], 12), decimal(product - 1, 12)
        raise Violation(f"Λ over {sample.steps} steps is {found}, and composed {wanted}")


def _run(sample: Sample) -> Mapping[str, Fraction]:
    """The state and Λ after the steps; Silent where they leave the range of the digits."""
    found = sample.run("mpfr", _DIGITS, "lambda")
    only_if(found.done == sample.steps and max(map(abs, found.values.values())) <= 10**6)
    return found.values
