"""The export of a certificate for one H, for real functions."""

from collections.abc import Iterable

from verify.proof.assistant.factors import factors_of
from verify.proof.assistant.nonzero_witness import NonzeroWitness, point_that_shows
from verify.proof.assistant.rocq_formulas import (
    Names,
    Spelling,
    deep,
    format_signed,
    list_of,
    rational,
    real,
    safe_names,
)
from verify.proof.assistant.text import Export, template_words
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import Expansion, NamedFunction
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
# Words that this module writes, and no parameter may hide.
_RESERVED_WORDS = frozenset(("True", "I", "conj", "proj1", "proj2"))
_ORDER_NEEDS = ("RationalValues", "Nonzero")
_EXACT_NEEDS = ("RealExact", "ExactClaims")
_TELESCOPING_NEEDS = ("RealPotential",)
_LONGEST_FUNCTION = 20_000  # characters of a function that is written out
_PARTNERS = {"sin": "cos", "cos": "sin"}
_KINDS = {"sin": "Sine", "cos": "Cosine", "exp": "Exponential", "inverse": "Inverse"}


def export_for_one_h(entries: Expansion, hamiltonian: Poly) -> Export:
    """Export the theorems of a certificate for one H, and their proofs."""
    names, order, potential = _RealNames(entries), entries.order, entries.potential
    algebra = Identities(entries)
    slopes = [algebra.slopes[name] for name in entries.coordinates]
    spelled, shallow = names.deep, names.shallow
    witness = point_that_shows(entries) if order is not None else None
    needs = (*_NEEDS, *(_EXACT_NEEDS if order is None else _ORDER_NEEDS))
    return Export(
        needs=needs if potential is None else (*needs, *_TELESCOPING_NEEDS),
        template="one",
        shows_nonzero=order is None or witness is not None,
        values={
            **names.values(),
            "timed": entries.timed,
            "coordinates": names.moving,
            "parameters": [names.spelling[name] for name in entries.parameters],
            "degree": entries.length - 1,
            "shown": names.nonzero_values(witness),
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
                "functions": list_of(map(names.format_function, entries.functions)),
                "energy": spelled.format_scoped(hamiltonian),
                "slopes": spelled.list(slopes),
                **names.deep_values(),
                "factors": list_of(map(spelled.factors, factors_of(entries))),
            },
        },
    )


class _RealNames(Names):
    """The names of coordinates, parameters and functions.

    `moving`: the coordinates, and t if H depends on it. `point`: the arguments of a function on
    phase space: these names in the plane, else one vector z.
    """

    zero = "0"

    def __init__(self, entries: Expansion) -> None:
        super().__init__(entries)
        self.moving = [*entries.coordinates, *("t",) * entries.timed]
        self.point = self.moving if entries.layout.single else ["z"]
        all_names = (*self.coordinates, *entries.parameters, *(f.name for f in entries.functions))
        self.numbers = {name: k for k, name in enumerate(all_names, start=1)}
        self.deep = deep(self.numbers)
        self.spelling = safe_names(entries.parameters, template_words("one") | _RESERVED_WORDS)
        self.shallow = Spelling(real, self._word, self._power)
        self.calls = dict[str, str]()
        for function in entries.functions:  # inner ones first
            kind = "/" if function.kind == "inverse" else function.kind
            call = f"{kind} {self.shallow.argument(function.argument)}"
            # Arguments are written out within arguments: the length may grow exponentially.
            if len(call) > _LONGEST_FUNCTION:
                raise ValueError("a function is too long to be written out")
            self.calls[function.name] = call

    def _word(self, name: str) -> str:
        return self.calls.get(name) or self.spelling.get(name, name)

    def _power(self, base: str, n: int) -> str:
        return f"({base}) ^ {n}" if " " in base else f"{base} ^ {n}"

    def format_function(self, function: NamedFunction) -> str:
        """Format a function for the check: its kind, the number of its partner, its argument."""
        partner = ""
        if function.kind in _PARTNERS:
            key = (_PARTNERS[function.kind], function.argument)
            # The certificate has both functions of a pair, as each is the other's derivative.
            partners = [f for f in self.entries.functions if (f.kind, f.argument) == key]
            partner = f" {self.numbers[partners[0].name]}"
        return f"({_KINDS[function.kind]}{partner}, {self.deep.format_scoped(function.argument)})"

    def _below(self) -> list[Poly]:
        return [f.argument for f in self.entries.functions if f.kind == "inverse"]

    def domain(self) -> str:
        """Format the condition that no denominator is 0."""
        conditions = [f"{self.shallow.argument(x)} <> 0" for x in self._below()]
        return self.bound((), " /\\ ".join(conditions) or "True")

    def bound(self, _: Iterable[Poly], text: str) -> str:
        unpacked = (x for x in self.moving if x not in self.point)
        lets = [f"let {name} := z {self.coordinates[name]}%nat in" for name in unpacked]
        return "\n  ".join([*lets, text])

    def nonzero_values(self, witness: NonzeroWitness | None) -> dict[str, object] | None:
        """Return the template's variables for the theorem that L is not 0."""
        if witness is None:
            return None
        values, names = witness.values, list(self.numbers)
        values_of_parameters = [values[name] for name in self.entries.parameters]
        arguments = [f"({format_signed(x)})" for x in values_of_parameters]
        return {
            "at": " ".join([*arguments, *self.point]),
            "entry": [f"{self.coordinates[x]}%nat" for x in witness.entry],
            "point": list_of(rational(values[name]) for name in self.coordinates),
            "given": list_of(map(rational, values_of_parameters)),
            "numbers": list_of(rational(values[name]) for name in names),
            "derived_by": list_of(self.coordinates[x] for x in witness.derived_by),
        }
