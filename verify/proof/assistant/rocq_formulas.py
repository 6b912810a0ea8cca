"""The polynomials and names of a certificate as Rocq reads them.

An exported file has each polynomial twice: as a formula in numbered names, for the check (`deep`),
and as a person writes it (`shallow`). Both have the same terms in the same order, so that the value
of the first is the second. `Names` has what is common to all exports of a map.
"""

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.proof.assistant.factors import last_checked_power
from verify.proof.certificates.entries import Expansion, Form
from verify.proof.certificates.readers import PLANE, Poly

_SIGNS = (" + ", " - ")
_WORD = re.compile(r"[\w']+")
KEYWORDS = frozenset([
    "as", "at", "cofix", "do", "else", "end", "exists", "exists2", "fix", "for", "forall", "from",
    "fun", "if", "in", "let", "match", "mod", "of", "return", "then", "using", "where", "with",
    "Prop", "SProp", "Set", "Type", "Axiom", "CoFixpoint", "Fixpoint", "Variable", "by", "IF",
])  # fmt: skip


@dataclass(frozen=True)
class Spelling:
    """The spelling of numbers, names and powers; a number is written without its sign."""

    number: Callable[[Fraction], str]
    name: Callable[[str], str]
    power: Callable[[str, int], str]
    scope: str = ""  # the notation scope in which Rocq reads it

    def format_scoped(self, x: Poly) -> str:
        """Format the polynomial with its scope, so that it has the same meaning everywhere."""
        if not self.scope:
            return self.poly(x)
        return self.argument(x) if is_name(x) else f"({self.poly(x)})%{self.scope}"

    def argument(self, x: Poly) -> str:
        """Format the polynomial as a function's argument."""
        text = self.poly(x)
        return text if is_name(x) and _WORD.fullmatch(text) else f"({text})"

    def poly(self, x: Poly) -> str:
        """Format the polynomial as a sum of terms, long ones first."""
        text = ""
        for names, c in sorted(x.items(), key=lambda term: (-len(term[0]), term[0])):
            first, term = not text, self._term(names, abs(c))
            # Rocq binds a leading minus to the first factor, so a negative product gets
            # parentheses: the deep and the shallow form must have the same structure.
            if c < 0 and first:
                text = f"- {term}" if c == -1 and _is_power(names) else f"- ({term})"
            else:
                text += f"{'' if first else _SIGNS[c < 0]}{term}"
        return text or self.number(Fraction(0))

    def _term(self, names: Sequence[str], c: Fraction) -> str:
        factors = [] if c == 1 and names else [self.number(c)]
        for name in dict.fromkeys(sorted(names)):
            n = names.count(name)
            factors.append(self.name(name) if n == 1 else self.power(self.name(name), n))
        return " * ".join(factors)

    def list(self, series: Iterable[Poly]) -> str:
        """Format a list of polynomials, each on a line."""
        return "[" + ";\n    ".join(self.format_scoped(x) for x in series) + "]"

    def factors(self, factors: Iterable[tuple[int, Poly]]) -> str:
        """Format the factors of a residual, each with the number of its relation."""
        return list_of(f"({k}%nat, {self.format_scoped(x)})" for k, x in factors)


def is_name(x: Poly) -> bool:
    """Return True if the polynomial is just a name."""
    return len(x) == 1 and all(len(names) == 1 and c == 1 for names, c in x.items())


def _is_power(names: Sequence[str]) -> bool:
    return len(set(names)) == 1


def deep(numbers: dict[str, int]) -> Spelling:
    """Return the spelling as formulas of the theory, in numbered names."""
    return Spelling(
        number=lambda c: f"Number {rational(c)}",
        name=lambda name: f"Name {numbers[name]}",
        power=lambda base, n: f"({base}) ^ {n}",
        scope="formula",
    )


def rational(c: Fraction) -> str:
    """Format a rational number as Rocq's Q."""
    return f"({c.numerator} # {c.denominator})"


def real(c: Fraction) -> str:
    """Format a number ≥ 0 as a real number."""
    return str(c.numerator) if c.denominator == 1 else f"{c.numerator} / {c.denominator}"


def format_signed(c: Fraction) -> str:
    """Format a number as a real number; Rocq reads a sign before digits as part of them."""
    return f"-{real(-c)}" if c < 0 else real(c)


def safe_names(
    names: Iterable[str], words: Iterable[str], prefixes: Iterable[str] = ()
) -> dict[str, str]:
    """Map the names to spellings that are none of these words, and no keyword.

    `prefixes`: a spelling with one of these before it is also none of the words, and differs from
    all other such spellings. Apostrophes, which no name of a certificate has, are appended as
    needed.
    """
    reserved, all_prefixes = KEYWORDS | set(words), ("", *prefixes)
    spellings: dict[str, str] = {}
    for name in names:
        # Some of Rocq's commands are keywords; all of them begin with a capital letter.
        spelling = f"{name}'" if re.match("[A-Z].", name) else name
        while reserved & {f"{prefix}{spelling}" for prefix in all_prefixes}:
            spelling += "'"
        reserved |= {f"{prefix}{spelling}" for prefix in all_prefixes}
        spellings[name] = spelling
    return spellings


def lines(text: str, most: int = 96) -> str:
    """Break the text's long lines at blanks, if there are any."""
    return "\n".join(part for line in text.split("\n") for part in _break_line(line, most))


def _break_line(line: str, most: int) -> list[str]:
    indent = " " * (len(line) - len(line.lstrip()))
    parts = []
    while len(line) > most:
        cut = line.rfind(" ", len(indent) + 4, most)
        if cut < 0:
            break
        parts.append(line[:cut])
        line = f"{indent}  {line[cut + 1 :]}"
    return [*parts, line]


def whole(x: bool) -> str:
    """Format a truth value."""
    return "true" if x else "false"


def list_of(items: Iterable[object]) -> str:
    """Format a list."""
    return f"[{'; '.join(map(str, items))}]"


def form_list(x: Form, coordinates: Mapping[str, int], spelling: Spelling) -> str:
    """Format a 2-form as a list of its entries, each with the numbers of two coordinates."""
    entries = [
        f"({coordinates[a]}%nat, {coordinates[b]}%nat, {spelling.format_scoped(c)})"
        for (a, b), c in x.items()
    ]
    return "[" + ";\n    ".join(entries) + "]"


class Names(ABC):
    """The spellings of names: `deep`, as numbered names, and `shallow`, as a person writes."""

    deep: Spelling
    shallow: Spelling
    zero: str  # the spelling of an entry 0 of a form

    def __init__(self, entries: Expansion) -> None:
        self.entries = entries
        self.coordinates = {name: k for k, name in enumerate((*entries.coordinates, "t"))}

    @abstractmethod
    def bound(self, polys: Iterable[Poly], text: str) -> str:
        """Return the text within the bindings of the names that occur in these polynomials."""

    def form(self, x: Form) -> str:
        """Format a 2-form as a person writes it."""
        if self.entries.layout.single:
            return self.bound(x.values(), self.shallow.poly(x.get(PLANE, {})))
        entries = self.bound(x.values(), form_list(x, self.coordinates, self.shallow))
        return f"entry {self.zero} ({entries})"

    def series(self, spelling: Spelling) -> str:
        """Format the coefficients of each coordinate's new value."""
        lists = ";\n   ".join(map(spelling.list, self.entries.after))
        return f"[{lists}]"

    def values(self) -> dict[str, Any]:
        """Return the template's variables for any map."""
        entries = self.entries
        return {
            "n": entries.layout.degrees,
            "planar": entries.layout.single,
            "agreement": entries.convergence_order,
            # The template's name for the last power of h that the theory checks.
            "known": last_checked_power(entries),
            "order": entries.order,
        }

    def deep_values(self) -> dict[str, str]:
        """Return the template's variables that are formulas in numbered names."""
        entries = self.entries
        return {
            "series": self.series(self.deep),
            "leading": form_list(entries.leading, self.coordinates, self.deep),
            "potential": form_list(entries.potential or {}, self.coordinates, self.deep),
        }


def polynomials_of(entries: Expansion) -> Iterator[Poly]:
    """Yield all polynomials of a certificate: H, if it is for one H, the map, L and G."""
    if entries.hamiltonian is not None:
        yield entries.hamiltonian
    for series in entries.after:
        yield from series
    yield from entries.leading.values()
    yield from (entries.potential or {}).values()
