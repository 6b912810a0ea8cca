"""The export of a certificate by coefficients: kicks and drifts, stages, Runge–Kutta methods."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations_with_replacement, product
from typing import Any

from verify.proof.assistant.factors import Reducer
from verify.proof.assistant.rocq_formulas import (
    Spelling,
    deep,
    format_signed,
    list_of,
    rational,
    real,
    safe_names,
)
from verify.proof.assistant.text import Export, template_words
from verify.proof.certificates.coefficients import (
    ButcherTableau,
    Stages,
    residuals_of_stages,
    residuals_of_tableau,
)
from verify.proof.certificates.named_numbers import AlgebraicNumber, QuotientRing
from verify.proof.certificates.readers import Poly

_NEEDS = ["Differential", "Symplectic", "Hamiltonians", "SymplecticMethods", "AlgebraicNumbers"]
_FORMULA_NEEDS = ["Rings", "Formulas", "Calculation", "RealFormulas", "Coefficients"]
_STAGE_NEEDS = [*_NEEDS, *_FORMULA_NEEDS, "StageSchemes"]
_TABLEAU_NEEDS = [*_NEEDS, *_FORMULA_NEEDS, "RungeKutta"]


def export_stages(entries: Stages) -> Export:
    """Export the theorems of a certificate by stages, and their proofs."""
    names = _Numbers(entries, "stages")
    # The theorem on shears assumes no solvability: it is used if all stages are made of shears.
    shears = list(_shears(entries, names))
    if None not in shears:
        return Export(_NEEDS, "shears", {**names.values, "shears": shears})
    zero: Poly = {}
    times = entries.times or [zero] * len(entries.rows)
    rows = [(*row, time) for row, time in zip(entries.rows, times, strict=True)]
    residuals = list(residuals_of_stages(entries, QuotientRing(())))
    return Export(
        needs=_STAGE_NEEDS,
        template="stages",
        values={
            **names.values,
            "separable": entries.separable,
            "separable_": "true" if entries.separable else "false",
            "rows": [[names.shallow.poly(x) for x in row] for row in rows],
            "deep": names.deep_values(residuals) | {"rows": list_of(map(names.deep.list, rows))},
        },
    )


def export_tableau(entries: ButcherTableau) -> Export:
    """Export the theorems of a certificate by a tableau, and their proofs."""
    names, a, b = _Numbers(entries, "tableau"), entries.rows, entries.weights
    pairs = combinations_with_replacement(range(len(b)), 2)
    residuals = dict(
        zip(pairs, (x for _, x in residuals_of_tableau(entries, QuotientRing(()))), strict=True)
    )
    by_stages = [residuals[min(pair), max(pair)] for pair in product(range(len(b)), repeat=2)]
    return Export(
        needs=_TABLEAU_NEEDS,
        template="tableau",
        values={
            **names.values,
            "m": len(b),
            "rows": [[names.shallow.poly(x) for x in row] for row in a],
            "weights": [names.shallow.poly(x) for x in b],
            "deep": names.deep_values(by_stages)
            | {"rows": list_of(map(names.deep.list, a)), "weights": names.deep.list(b)},
        },
    )


def _shears(entries: Stages, names: "_Numbers") -> Iterator[str | None]:
    """Yield the kicks and drifts of all stages; None for a stage that is not made of them."""
    for k, (kick, drift, at_p, at_q) in enumerate(entries.rows):
        time = ""
        if entries.times is not None:
            moment = names.shallow.poly(entries.times[k])
            time = f" (t + ({moment}) * h)" if entries.times[k] else " t"
        point = (time and "({}{})") or "{}"
        by_v, by_t = (f"{point.format(x, time)} {point.format(f'{x}1', time)}" for x in "VT")
        first = f"Kick ({names.shallow.poly(kick)}) {by_v}"
        second = f"Drift ({names.shallow.poly(drift)}) {by_t}"
        if not entries.separable:
            yield None
        elif not drift or not kick:
            yield from [first] * bool(kick) + [second] * bool(drift)
        elif not at_q or not at_p:  # the second shear is at the point that the first leads to
            yield from (first, second) if not at_q else (second, first)
        else:
            yield None


class _Numbers:
    """The algebraic numbers of a certificate: their spelling, and the facts about them."""

    def __init__(self, entries: Stages | ButcherTableau, template: str) -> None:
        self.numbers = entries.numbers
        words = template_words(template)
        # Statements about a number are called by a prefix and its name: none may clash.
        prefixes = ("is_", "there_is_", "E_")
        self.spelling = safe_names([number.name for number in self.numbers], words, prefixes)
        self.deep = deep({number.name: k for k, number in enumerate(self.numbers, start=1)})
        self.shallow = Spelling(
            real, lambda name: self.spelling[name], power=lambda base, n: f"{base} ^ {n}"
        )
        names = list(self.spelling.values())
        self.values: dict[str, Any] = {
            "n": entries.layout.degrees,
            "timed": entries.times is not None,
            "numbers": list(map(self._number, self.numbers)),
            "names": names,
            "parameters": f"({' '.join(names)} : R) " if names else "",
            # These three have a blank before each item.
            "arguments": "".join(f" {name}" for name in names),
            "proofs": "".join(f" E_{name}" for name in names),
            "equations": "".join(f" (proj1 E_{name})" for name in names),
            "over": f" forall {' '.join(names)} : R," * bool(names)
            + "".join(f" is_{name} {name} ->" for name in names),
        }

    def deep_values(self, residuals: Sequence[Poly]) -> dict[str, str]:
        """Return the relations as formulas, and the factors that show the residuals to be 0."""
        relations = list(map(_relation, self.numbers))
        names = [number.name for number in self.numbers]
        factors = Reducer(names, list(enumerate(relations))).all_factors(residuals)
        return {
            "relations": self.deep.list(relations),
            "factors": list_of(map(self.deep.factors, factors)),
        }

    def _number(self, number: AlgebraicNumber) -> dict[str, Any]:
        return {
            "name": self.spelling[number.name],
            "equation": self.shallow.poly(_relation(number)),
            "low": format_signed(number.low),
            "high": format_signed(number.high),
            "polynomial": list_of(number.polynomial),
            "ends": [rational(number.low), rational(number.high)],
        }


def _relation(number: AlgebraicNumber) -> Poly:
    return {(number.name,) * k: Fraction(c) for k, c in enumerate(number.polynomial) if c}
