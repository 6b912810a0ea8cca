"""What the chains of one way to evaluate Λ, or W, become in a result."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

from verify.arithmetic.exact import known_text
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.separation import (
    EvaluationResult,
    GrowthResult,
    Parts,
    PartsAt,
    PartsInTime,
    PartsInTimeAt,
)
from verify.studies.separation.chain import Chain
from verify.studies.separation.growth import growth, log_spaced
from verify.studies.separation.trail import Trail
from verify.studies.separation.working import Kind

_SHOWN = 7  # digits of what a figure shows
_CHECKPOINTS = 32


class Way:
    """The chain of Λ, or those of all entries of W; of several the greatest size stands for all,
    at every checkpoint."""

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
    def largest(self) -> dict[str, str]:
        """The greatest size at any checkpoint."""
        return {n: self.text(n, self.tops[n].largest) for n in ("truncation", "total")}

    @property
    def growth(self) -> dict[str, GrowthResult]:
        """Of rounding, and of each part of it."""
        names = ("total", *self.chains[0].parts)
        fits = {n: growth(self.marks, self.tops[n], self.noise[n]) for n in names}
        return {n: GrowthResult(**x.fields) for n, x in fits.items()}

    @property
    def kind(self) -> Kind:
        """Enclosed where every chain is, else estimated."""
        return "enclosed" if all(x.kind == "enclosed" for x in self.chains) else "estimated"

    def series(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Some checkpoints, and each quantity there."""
        for k in log_spaced(range(len(self.marks)), self.marks, _CHECKPOINTS):
            yield k, {name: self.text(name, self.tops[name][k]) for name in self.names}

    def text(self, name: str, x: Fraction) -> str:
        """A value of the quantity, to the few digits that are known."""
        return known_text(x, self.noise[name], _SHOWN)


def _greatest(trails: Sequence[Trail]) -> Trail:
    return Trail.of(max(map(abs, entries)) for entries in zip(*trails, strict=True))


def evaluation(way: Way, digits: int) -> EvaluationResult:
    """That of Λ as results have it."""
    parts = {name: value for name, (value,) in way.values(digits).items()}
    timed = "clock" in parts
    at = PartsInTimeAt if timed else PartsAt
    shown = at.model_fields.keys() - {"steps"}
    return EvaluationResult(
        parts=PartsInTime(**parts) if timed else Parts(**parts),
        largest=way.largest,
        growth=way.growth,
        series=tuple(
            at(steps=way.marks[k], **{name: texts[name] for name in shown})
            for k, texts in way.series()
        ),
        error_kind=way.kind,
    )
