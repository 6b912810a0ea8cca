"""Chains of Λ, or of all entries of W, as a result has them."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import decimal, known_text
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.form_value import FormValue
from verify.scenes.results.separation_parts import (
    AnyEvaluation,
    EvaluationResult,
    FormAt,
    FormEvaluation,
    FormParts,
    FormPartsInTime,
    GrowthResult,
    Parts,
    PartsAt,
    PartsInTime,
    PartsInTimeAt,
    PowerLawResult,
)
from verify.studies.separation.chain import Chain
from verify.studies.separation.growth import growth, log_spaced, motion_of, power_law
from verify.studies.separation.stepper.trail import Trail
from verify.studies.separation.stepper.way import Size

SHOWN = 7  # digits of what a figure shows
_CHECKPOINTS = 32


class Split:
    """The chain of Λ, or those of all entries of W, by one way to evaluate it; of several the
    greatest size stands for all, at every checkpoint."""

    def __init__(self, chains: Sequence[Chain]) -> None:
        self.chains, self.marks, self.names = chains, chains[0].marks, chains[0].quantities
        self.tops: dict[str, Trail] = {}
        self.noise: dict[str, Fraction] = {}
        for name in self.names:
            trails, bounds = zip(*(chain.trail(name) for chain in chains), strict=True)
            self.tops[name] = trails[0] if len(chains) == 1 else _greatest(trails)
            self.noise[name] = max(bounds)

    def values(self, digits: int) -> dict[str, tuple[Value, ...]]:
        """Each quantity after the last step, of each chain."""
        return {
            name: tuple(Value.of(*chain.final(name), digits) for chain in self.chains)
            for name in self.names
        }

    @property
    def summary(self) -> dict[str, Any]:
        """The greatest sizes at any checkpoint, how rounding and its parts grow, and how the bounds
        were found."""
        names = ("total", *self.chains[0].parts)
        fits = {n: growth(self.marks, self.tops[n], self.noise[n]) for n in names}
        enclosed = all(x.kind == "enclosed" for x in self.chains)
        return {
            "largest": {n: self.text(n, self.tops[n].largest) for n in ("truncation", "total")},
            "growth": {n: GrowthResult(**x.fields) for n, x in fits.items()},
            "error_kind": "enclosed" if enclosed else "estimated",
        }

    def series(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Some checkpoints, and each quantity there."""
        for k in log_spaced(range(len(self.marks)), self.marks, _CHECKPOINTS):
            yield k, {name: self.text(name, self.tops[name][k]) for name in self.names}

    def text(self, name: str, x: Fraction) -> str:
        """A value of the quantity, to the few digits that are known."""
        return known_text(x, self.noise[name], SHOWN)


def _greatest(trails: Sequence[Trail]) -> Trail:
    return Trail.of(max(map(abs, entries)) for entries in zip(*trails, strict=True))


def evaluation(split: Split, digits: int, sizes: Sequence[Size] = ()) -> AnyEvaluation:
    """As a result has it; `sizes`: of M at the checkpoints, for W."""
    return _of_form(split, digits, sizes) if sizes else _of_area(split, digits)


def _of_area(split: Split, digits: int) -> EvaluationResult:
    parts = {name: value for name, (value,) in split.values(digits).items()}
    timed = "clock" in parts
    at = PartsInTimeAt if timed else PartsAt
    shown = at.model_fields.keys() - {"steps"}
    return EvaluationResult(
        parts=PartsInTime(**parts) if timed else Parts(**parts),
        series=tuple(
            at(steps=split.marks[k], **{name: texts[name] for name in shown})
            for k, texts in split.series()
        ),
        **split.summary,
    )


def _of_form(split: Split, digits: int, sizes: Sequence[Size]) -> FormEvaluation:
    values = split.values(digits).items()
    parts = {_name_in_degrees(name): FormValue.of(entries) for name, entries in values}
    motion = motion_of(split.marks, [x.norm for x in sizes])
    name = "lambda_working"
    law = power_law(split.marks, split.tops[name], split.noise[name], motion)
    return FormEvaluation(
        parts=FormPartsInTime(**parts) if "clock" in parts else FormParts(**parts),
        law=PowerLawResult(**law.fields),
        series=tuple(
            FormAt(
                steps=split.marks[k],
                norm_squared=decimal(sizes[k].norm, SHOWN),
                parts={_name_in_degrees(name): text for name, text in texts.items()},
            )
            for k, texts in split.series()
        ),
        **split.summary,
    )


def _name_in_degrees(name: str) -> str:
    return "w_working" if name == "lambda_working" else name
