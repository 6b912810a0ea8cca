"""The parts of a result from the chains of Λ, or of all entries of W."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.exact import decimal, known_text
from verify.scenes.results import separation_parts
from verify.scenes.results.bounded_value import FormValue, Value
from verify.studies.separation import growth_fits
from verify.studies.separation.chain import Chain, Trail
from verify.studies.separation.way import Size

SHOWN = 7  # digits of the values in figures
_SERIES_CHECKPOINTS = 32


class Split:
    """The chain of Λ, or those of all entries of W, by one way to evaluate them.

    `tops`: each quantity at every checkpoint; for W the greatest |value| of all entries. `noise`: a
    bound of its error.
    """

    def __init__(self, chains: Sequence[Chain]) -> None:
        self.chains, self.marks, self.names = chains, chains[0].marks, chains[0].quantities
        self.tops: dict[str, Trail] = {}
        self.noise: dict[str, Fraction] = {}
        for name in self.names:
            trails, bounds = zip(*(chain.trail(name) for chain in chains), strict=True)
            self.tops[name] = trails[0] if len(chains) == 1 else _greatest(trails)
            # Of several entries the greatest bound is that of their maximum.
            self.noise[name] = max(bounds)

    def values(self, digits: int) -> dict[str, tuple[Value, ...]]:
        """Return each quantity after the last step, of each chain."""
        return {
            name: tuple(Value.from_bound(*chain.final(name), digits) for chain in self.chains)
            for name in self.names
        }

    @property
    def summary(self) -> dict[str, Any]:
        """The greatest sizes at any checkpoint, the growth of rounding, and the kind of bounds."""
        names = ("total", *self.chains[0].parts)
        fits = {n: growth_fits.fit_growth(self.marks, self.tops[n], self.noise[n]) for n in names}
        enclosed = all(x.kind == "enclosed" for x in self.chains)
        return {
            "largest": {n: self.text(n, self.tops[n].largest) for n in ("truncation", "total")},
            "growth": {n: separation_parts.GrowthResult(**x.fields) for n, x in fits.items()},
            "error_kind": "enclosed" if enclosed else "estimated",
        }

    def series(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Yield some checkpoints, and each quantity there."""
        for k in growth_fits.select_log_spaced(
            range(len(self.marks)), self.marks, _SERIES_CHECKPOINTS
        ):
            yield k, {name: self.text(name, self.tops[name][k]) for name in self.names}

    def text(self, name: str, x: Fraction) -> str:
        """Format a value of the quantity to the digits that are certain, at most seven."""
        return known_text(x, self.noise[name], SHOWN)


def _greatest(trails: Sequence[Trail]) -> Trail:
    return Trail.from_values(max(map(abs, entries)) for entries in zip(*trails, strict=True))


def evaluation(
    split: Split, digits: int, sizes: Sequence[Size] = ()
) -> separation_parts.AnyEvaluation:
    """Return the evaluation of a result; `sizes`: of M at the checkpoints, for W."""
    return _evaluate_form(split, digits, sizes) if sizes else _evaluate_area(split, digits)


def _evaluate_area(split: Split, digits: int) -> separation_parts.EvaluationResult:
    parts = {name: value for name, (value,) in split.values(digits).items()}
    has_time = "clock" in parts
    checkpoint_type = separation_parts.PartsInTimeAt if has_time else separation_parts.PartsAt
    names = checkpoint_type.model_fields.keys() - {"steps"}
    return separation_parts.EvaluationResult(
        parts=separation_parts.PartsInTime(**parts)
        if has_time
        else separation_parts.Parts(**parts),
        series=tuple(
            checkpoint_type(steps=split.marks[k], **{name: texts[name] for name in names})
            for k, texts in split.series()
        ),
        **split.summary,
    )


def _evaluate_form(
    split: Split, digits: int, sizes: Sequence[Size]
) -> separation_parts.FormEvaluation:
    values = split.values(digits).items()
    parts = {_name_in_degrees(name): FormValue.from_entries(entries) for name, entries in values}
    motion = growth_fits.classify_motion(split.marks, [x.norm for x in sizes])
    name = "lambda_working"
    law = growth_fits.fit_power_law(split.marks, split.tops[name], split.noise[name], motion)
    return separation_parts.FormEvaluation(
        parts=separation_parts.FormPartsInTime(**parts)
        if "clock" in parts
        else separation_parts.FormParts(**parts),
        law=separation_parts.PowerLawResult(**law.fields),
        series=tuple(
            separation_parts.FormAt(
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
