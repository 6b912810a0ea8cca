"""What the worst scenes of a hunt say in words; every number is the data's."""

from collections.abc import Iterator
from decimal import Decimal
from math import floor

from verify.pages.figures.logarithm import lg
from verify.pages.sections.separation_finding import decades_below
from verify.pages.text.typography import NBSP, counted, number, whole
from verify.scenes.results.exploration import GalleryScene
from verify.scenes.results.separation_parts import EvaluationResult

_ALL_DIGITS = 53 * 0.30103  # of float64
_PLAIN = (-2, 3)  # lg of what is written without a power of ten


# -- the measure ----------------------------------------------------------------------------------


def findings(measure: str, sentence: str, value: float) -> str:
    """What a measure's lg says, as a clause that begins with a small letter."""
    size = power(value)
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
        return f"no digit of p and q is lost: their error is {power(value)} of float64’s roundoff"
    if value >= _ALL_DIGITS:
        return "no digit of p and q is left"
    count = f"{value:.1f}"
    digits, are = ("digit", "is") if count == "1.0" else ("digits", "are")
    return f"{count} {digits} of p and q {are} lost"


def in_short(measure: str, value: float) -> tuple[str, str]:
    """The same as a number and its unit."""
    if measure == "rounding-share":
        return power(value), f"{_times(value)} truncation"
    if measure == "growth":
        return power(value), "greatest |Λ|"
    if measure == "digits-lost" and 0 <= value < _ALL_DIGITS:
        return f"{value:.1f}", "digits lost"
    return power(value), "roundoffs" if measure == "digits-lost" else ""


def power(value: float) -> str:
    """10^value to two digits, whether or not a float can hold it."""
    exponent = floor(value)
    if _PLAIN[0] <= value < _PLAIN[1]:
        return f"{Decimal(f'{10**value:.1e}'):f}"
    mantissa = f"{10 ** (value - exponent):.1f}"
    if mantissa == "10.0":
        mantissa, exponent = "1.0", exponent + 1
    return number(f"{mantissa}e{exponent:+d}")


# -- Λ in float64 ---------------------------------------------------------------------------------


def lambda_of(each: GalleryScene) -> Iterator[str]:
    """From which step on Λ in float64 is meaningless, or how many digits it keeps."""
    of, after, over = each.separation, each.meaningless_after, each.meaningful_from
    count = counted(of.steps, "step")
    if of.plain is None:
        yield f"Λ of float64 cannot be split over {count}: {of.reason or of.status}."
    elif after is None:
        yield _kept(of.plain, count)
    else:
        first = of.plain.series[0].steps if of.plain.series else after
        already = " already, the first number of steps looked at" if after == first else ""
        end = f"and stays so over all {count}"
        if over is not None:
            end = f"until truncation outgrows rounding for good, after {whole(over)}"
        yield f"Λ of float64 is meaningless after {counted(after, 'step')}{already}, {end}."
        yield from _without_truncation(of.plain)


def _kept(plain: EvaluationResult, count: str) -> str:
    parts = plain.parts
    if _zero(parts.truncation.value) and _zero(parts.total.value):
        silent = all(map(_zero, plain.largest.values()))
        if parts.truncation.bound == parts.total.bound == "0" and silent:
            return f"Λ is exactly 0 over {count}, in float64 as in exact arithmetic."
        return f"Neither of truncation nor of rounding is a digit known after {count}."
    gap = decades_below(plain)
    if gap is None:
        return f"No rounding of Λ in float64 is known of over {count}."
    digits = floor(gap)
    kept = "less than one digit" if digits < 1 else f"about {digits} digit{'s' * (digits > 1)}"
    return f"Λ of float64 keeps {kept} over {count}."


def _without_truncation(plain: EvaluationResult) -> Iterator[str]:
    """Where the scheme does nothing to area, all of Λ is rounding."""
    truncation = plain.parts.truncation
    if _zero(truncation.value) and truncation.bound == "0" and _zero(plain.largest["truncation"]):
        largest = power(lg(plain.largest["total"]))
        yield f"Exactly, Λ is 0; rounding alone makes it as large as {largest}."


def _zero(size: str) -> bool:
    return Decimal(size) == 0


def run_beyond(each: GalleryScene) -> Iterator[str]:
    """What became of the longer run, where it is not the one that is shown."""
    if each.longer is not None:
        why = each.longer.reason or each.longer.status
        count = counted(each.longer.steps, "step")
        yield f"A longer run of {count} cannot be split: {why}."
