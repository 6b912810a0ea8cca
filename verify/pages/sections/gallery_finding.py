"""Sentences on the worst scenes of a hunt, with numbers from the data alone."""

from collections.abc import Iterator
from decimal import Decimal
from math import floor

from verify.pages.figures.captioned_plot import lg
from verify.pages.sections.separation_summary import decades_below
from verify.pages.text.typography import NBSP, count_noun, number, whole
from verify.scenes.results.exploration import GalleryScene
from verify.scenes.results.separation_parts import EvaluationResult

# The decimal digits of float64: 53 bits times lg 2.
_FLOAT64_DIGITS = 53 * 0.30103
# Numbers whose lg lies in this range are written without a power of ten.
_PLAIN_RANGE = (-2, 3)


# -- the measure ----------------------------------------------------------------------------------


def findings(measure: str, sentence: str, value: float) -> str:
    """Return a clause on a measure whose lg is `value`, without a capital at its start."""
    size = format_power(value)
    if measure == "rounding-share":
        return f"rounding is {size} {_times(value)} the truncation"
    if measure == "growth":
        return f"|Λ| reaches {size}"
    if measure == "digits-lost":
        return _digits_lost(value)
    return f"{size}{NBSP}: {sentence}"


def _times(value: float) -> str:
    return "times" if value >= 0 else "of"


def _digits_lost(value: float) -> str:
    if value < 0:
        error = format_power(value)
        return f"no digit of p and q is lost: their error is {error} of float64’s roundoff"
    if value >= _FLOAT64_DIGITS:
        return "no digit of p and q is left"
    count = f"{value:.1f}"
    digits, are = ("digit", "is") if count == "1.0" else ("digits", "are")
    return f"{count} {digits} of p and q {are} lost"


def short_value(measure: str, value: float) -> tuple[str, str]:
    """Return a measure whose lg is `value` as a number and its unit."""
    if measure == "rounding-share":
        return format_power(value), f"{_times(value)} truncation"
    if measure == "growth":
        return format_power(value), "greatest |Λ|"
    if measure == "digits-lost" and 0 <= value < _FLOAT64_DIGITS:
        return f"{value:.1f}", "digits lost"
    return format_power(value), "roundoffs" if measure == "digits-lost" else ""


def format_power(value: float) -> str:
    """Return 10^value to two digits, even if it is beyond the range of floats."""
    exponent = floor(value)
    if _PLAIN_RANGE[0] <= value < _PLAIN_RANGE[1]:
        return f"{Decimal(f'{10**value:.1e}'):f}"
    mantissa = f"{10 ** (value - exponent):.1f}"
    # 10^0.9999 rounds to 10.0, which is 1.0 with the next exponent.
    if mantissa == "10.0":
        mantissa, exponent = "1.0", exponent + 1
    return number(f"{mantissa}e{exponent:+d}")


# -- Λ in float64 ---------------------------------------------------------------------------------


def describe_lambda(scene: GalleryScene) -> Iterator[str]:
    """Yield sentences on the step after which Λ in float64 is meaningless, or on its digits."""
    separation = scene.separation
    lost_after = scene.meaningless_after
    resumes_at = scene.meaningful_from
    count = count_noun(separation.steps, "step")
    if separation.plain is None:
        reason = separation.reason or separation.status
        yield f"Λ of float64 cannot be split over {count}: {reason}."
    elif lost_after is None:
        yield _describe_digits_kept(separation.plain, count)
    else:
        checkpoints = separation.plain.series
        first_count = checkpoints[0].steps if checkpoints else lost_after
        already = (
            " already, the first number of steps looked at" if lost_after == first_count else ""
        )
        end = f"and stays so over all {count}"
        if resumes_at is not None:
            end = f"until truncation outgrows rounding for good, after {whole(resumes_at)}"
        yield f"Λ of float64 is meaningless after {count_noun(lost_after, 'step')}{already}, {end}."
        yield from _describe_pure_rounding(separation.plain)


def _describe_digits_kept(plain: EvaluationResult, count: str) -> str:
    parts = plain.parts
    if _is_zero(parts.truncation.value) and _is_zero(parts.total.value):
        is_always_zero = all(map(_is_zero, plain.largest.values()))
        if parts.truncation.bound == parts.total.bound == "0" and is_always_zero:
            return f"Λ is exactly 0 over {count}, in float64 as in exact arithmetic."
        return f"Neither of truncation nor of rounding is a digit known after {count}."
    # Rounding lies below truncation by as many decades as Λ has right digits.
    margin = decades_below(plain)
    if margin is None:
        return f"No rounding of Λ in float64 is known of over {count}."
    digits = floor(margin)
    digits_text = (
        "less than one digit" if digits < 1 else f"about {digits} digit{'s' * (digits > 1)}"
    )
    return f"Λ of float64 keeps {digits_text} over {count}."


def _describe_pure_rounding(plain: EvaluationResult) -> Iterator[str]:
    """Yield a sentence on the size of Λ, if truncation is 0 and all of Λ is rounding."""
    truncation = plain.parts.truncation
    if (
        _is_zero(truncation.value)
        and truncation.bound == "0"
        and _is_zero(plain.largest["truncation"])
    ):
        largest = format_power(lg(plain.largest["total"]))
        yield f"Exactly, Λ is 0; rounding alone makes it as large as {largest}."


def _is_zero(size: str) -> bool:
    return Decimal(size) == 0


def describe_longer_run(scene: GalleryScene) -> Iterator[str]:
    """Yield the reason why a longer run is not shown, if there was one."""
    if scene.longer is not None:
        reason = scene.longer.reason or scene.longer.status
        count = count_noun(scene.longer.steps, "step")
        yield f"A longer run of {count} cannot be split: {reason}."
