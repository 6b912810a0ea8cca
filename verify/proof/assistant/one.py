"""The export of a certificate for one H: of real functions."""

from collections.abc import Iterable

from verify.proof.assistant.factors import factors_of
from verify.proof.assistant.formulas import (
    Spelling,
    deep,
    list_of,
    rational,
    real,
    safe,
    signed,
)
from verify.proof.assistant.names import Names
from verify.proof.assistant.nonzero import Shown, point_that_shows
from verify.proof.assistant.text import Export, template_words
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import Expansion, Function
from verify.proof.certificates.readers import Poly

_NEEDS = [
    "Differential",
    "Rings",
    "Formulas",
    "Calculation",
    "Identities",
    "RealFormulas",
    "RealNames",
    "OneHamiltonian",
    "RealMaps",
    "RealDefect",
    "RealClaims",
    "MapClaims",
    "FlowClaims",
    "AgreementClaims",
]
_OWN = frozenset(("True", "I", "conj", "proj1", "proj2"))  # words that are written here
_OF_ORDER = ("RationalValues", "Nonzero")
_EXACT = ("RealExact", "ExactClaims")
_TELESCOPING = ("RealPotential",)
_LONGEST = 20_000  # characters of a function, written out
_PARTNERS = {"sin": "cos", "cos": "sin"}
_KINDS = {"sin": "Sine", "cos": "Cosine", "exp": "Exponential", "inverse": "Inverse"}


def of_one(entries: Expansion, hamiltonian: Poly) -> Export:
    """The theorems of such a certificate, whose H this is, and their proofs."""
    names, order, potential = _Names(entries), entries.order, entries.potential
    algebra = Identities(entries)
    slopes = [algebra.slopes[by] for by in entries.coordinates]
    spelled, shallow = names.deep, names.shallow
    shown = point_that_shows(entries) if order is not None else None
    needs = (*_NEEDS, *(_EXACT if order is None else _OF_ORDER))
    return Export(
        needs=needs if potential is None else (*needs, *_TELESCOPING),
        template="one",
        shows_nonzero=order is None or shown is not None,
        values={
            **names.values(),
            "timed": entries.timed,
            "coordinates": names.moving,
            "parameters": [names.written[name] for name in entries.parameters],
            "degree": entries.length - 1,
            "shown": names.shown(shown),
            "potential": potential,
            "domain": names.domain(),
            "maps": [
                {"coordinate": name, "coefficients": shallow.list(series)}
                for name, series in zip(entries.coordinates, entries.after, strict=True)
            ],
            "shallow": {
                "energy": names.bound((), shallow.poly(hamiltonian)),
                "slopes": [shallow.poly(x) for x in slopes],
                "slope_list": names.bound((), shallow.list(slopes)),
                "series": names.bound((), names.series(shallow)),
                "leading": names.form(entries.leading),
                "potential": names.form(potential or {}),
            },
            "deep": {
                "functions": list_of(map(names.made, entries.functions)),
                "energy": spelled.scoped(hamiltonian),
                "slopes": spelled.list(slopes),
                **names.deep_values(),
                "factors": list_of(map(spelled.factors, factors_of(entries))),
            },
        },
    )


class _Names(Names):
    """Coordinates, parameters and functions; `point`: what a function is taken at."""

    zero = "0"

    def __init__(self, entries: Expansion) -> None:
        super().__init__(entries)
        self.moving = [*entries.coordinates, *("t",) * entries.timed]
        self.point = self.moving if entries.layout.single else ["z"]
        known = (*self.coordinates, *entries.parameters, *(f.name for f in entries.functions))
        self.numbers = {name: k for k, name in enumerate(known, start=1)}
        self.deep = deep(self.numbers)
        self.written = safe(entries.parameters, template_words("one") | _OWN)
        self.shallow = Spelling(real, self._word, self._power)
        self.calls = dict[str, str]()
        for function in entries.functions:  # inner ones first
            kind = "/" if function.kind == "inverse" else function.kind
            call = f"{kind} {self.shallow.argument(function.argument)}"
            if len(call) > _LONGEST:
                raise ValueError("a function is too long to be written out")
            self.calls[function.name] = call

    def _word(self, name: str) -> str:
        return self.calls.get(name) or self.written.get(name, name)

    def _power(self, base: str, n: int) -> str:
        return f"({base}) ^ {n}" if " " in base else f"{base} ^ {n}"

    def made(self, function: Function) -> str:
        """A function of the vocabulary: its kind, with the number of its partner, and argument."""
        partner = ""
        if function.kind in _PARTNERS:
            wanted = (_PARTNERS[function.kind], function.argument)
            found = [f for f in self.entries.functions if (f.kind, f.argument) == wanted]
            partner = f" {self.numbers[found[0].name]}"
        return f"({_KINDS[function.kind]}{partner}, {self.deep.scoped(function.argument)})"

    def _below(self) -> list[Poly]:
        return [f.argument for f in self.entries.functions if f.kind == "inverse"]

    def domain(self) -> str:
        """That no denominator is 0."""
        conditions = [f"{self.shallow.argument(x)} <> 0" for x in self._below()]
        return self.bound((), " /\\ ".join(conditions) or "True")

    def bound(self, _: Iterable[Poly], text: str) -> str:
        named = (x for x in self.moving if x not in self.point)
        lets = [f"let {name} := z {self.coordinates[name]}%nat in" for name in named]
        return "\n  ".join([*lets, text])

    def shown(self, found: Shown | None) -> dict[str, object] | None:
        """What the theorem that L is not 0 is written with."""
        if found is None:
            return None
        values, names = found.values, list(self.numbers)
        given = [values[name] for name in self.entries.parameters]
        at = [f"({signed(x)})" for x in given]
        return {
            "at": " ".join([*at, *self.point]),
            "entry": [f"{self.coordinates[x]}%nat" for x in found.entry],
            "point": list_of(rational(values[name]) for name in self.coordinates),
            "given": list_of(map(rational, given)),
            "numbers": list_of(rational(values[name]) for name in names),
            "by": list_of(self.coordinates[x] for x in found.by),
        }
