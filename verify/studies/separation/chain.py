"""The chain Λ₀ … Λ₄, or that of an entry of W, for one step size, and its parts; see
`verify.studies.separation.separate`."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.exact import magnitude
from verify.scenes.results.separation_parts import Parts
from verify.studies.separation.stepper.trail import Kind, Link, Trail

PARTS = Parts.rounding  # in the plane
_WHOLES = ("lambda_working", "truncation", "total")
QUANTITIES = (*_WHOLES, *PARTS)


@dataclass(frozen=True)
class Chain:
    """The chain Λ₀ … Λ₄ of one way to evaluate Λ in float64, at the numbers of steps in `marks`.

    `parts`: of rounding, one between each link and the next.
    """

    marks: tuple[int, ...]
    links: tuple[Link, ...]
    parts: tuple[str, ...] = PARTS

    @property
    def quantities(self) -> tuple[str, ...]:
        """The names of Λ, truncation, rounding, and its parts."""
        return *_WHOLES, *self.parts

    def trail(self, name: str) -> tuple[Trail, Fraction]:
        """Return a quantity of `quantities` at every checkpoint, and a bound of its error.

        truncation + all parts = lambda_working, exactly.
        """
        before, after = self._ends(name)
        last = self.links[after]
        if before is None:
            return last.trail, last.bound
        first = self.links[before]
        # Equal links are one object, whose difference from itself is exactly 0.
        bound = Fraction(0) if first is last else first.bound + last.bound
        return last.trail - first.trail, bound

    def final(self, name: str) -> tuple[Fraction, Fraction]:
        """Return a quantity after the last step, and the bound of its error."""
        trail, bound = self.trail(name)
        return trail[-1], bound

    def _ends(self, name: str) -> tuple[int | None, int]:
        """Return the links that a quantity lies between; None: there is none before it."""
        if name in self.parts:
            k = self.parts.index(name)
            return k, k + 1
        last = len(self.parts)
        return {"lambda_working": (None, last), "truncation": (None, 0), "total": (0, last)}[name]

    def lacking(self, digits: int, least: Fraction = Fraction(0)) -> list[int]:
        """Return the digits that each link lacks for those required of the parts at its ends.

        A part that is not greater than `least` may stay unknown.
        """
        lacking = [0] * len(self.links)
        for name in self.quantities:
            value, bound = self.final(name)
            if not (abs(value) > least and bound):
                continue
            # Two links share a part's error: each may have a quarter of a unit of the last digit.
            tolerance = abs(value) / (4 * Fraction(10) ** digits)
            for k in (end for end in self._ends(name) if end is not None):
                excess = self.links[k].bound / tolerance
                if excess > 1:
                    lacking[k] = max(lacking[k], magnitude(excess) + 1)
        return lacking

    @property
    def kind(self) -> Kind:
        """Enclosed where the bound of every link is proved, else estimated."""
        return "enclosed" if all(x.kind == "enclosed" for x in self.links) else "estimated"

    @property
    def methods(self) -> tuple[str, ...]:
        """The methods that bounded the errors of all links but the last, each once."""
        return tuple(dict.fromkeys(link.method for link in self.links[:-1]))


def lacking(chains: Sequence[Chain], digits: int, hidden: int | None = None) -> list[int]:
    """Return the digits that each link lacks, for the chain in which it lacks most.

    A part may stay unknown that lies so many digits, and `hidden` ones, below the greatest.
    """
    least = Fraction(0)
    if hidden is not None:
        largest = max(abs(chain.final(name)[0]) for chain in chains for name in chain.quantities)
        least = largest / Fraction(10) ** (digits + hidden)
    return [max(each) for each in zip(*(x.lacking(digits, least) for x in chains), strict=True)]
