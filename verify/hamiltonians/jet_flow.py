"""The vector field of every H at once, over the ring of its derivatives."""

from collections.abc import Mapping
from functools import cached_property, lru_cache

from verify.algebra.ring import Poly
from verify.algebra.series.jets import Jets, JetsInDegrees
from verify.hamiltonians.canonical_field import Flow
from verify.hamiltonians.coordinates import numbered_names


class JetFlow(Flow):
    """The flow of f = (−∂H/∂q, ∂H/∂p) in these jets."""

    def __init__(self, jets: JetsInDegrees) -> None:
        self._jets = jets
        self.names = tuple(name for name in jets.variables if name != "t")

    @classmethod
    def with_degrees(cls, degrees: int, order: int, *, separable: bool, timed: bool) -> "JetFlow":
        """Return the flow for that number of degrees of freedom, with derivatives of H up to this
        order."""
        if degrees == 1:
            return cls.from_jets(Jets(order, separable=separable and not timed, timed=timed))
        names = numbered_names(degrees)
        return cls.from_jets(JetsInDegrees(names, order, separable=separable, timed=timed))

    @classmethod
    @lru_cache(maxsize=4)
    def from_jets(cls, jets: JetsInDegrees) -> "JetFlow":
        """Return the flow in these jets; the last ones are cached with their derivatives."""
        return cls(jets)

    @property
    def ring(self) -> JetsInDegrees:
        """The jets."""
        return self._jets

    @cached_property
    def slopes(self) -> tuple[Poly, ...]:
        """The components −∂H/∂q and ∂H/∂p."""
        n, first = self.degrees, self._jets.first
        return (*(-first(q) for q in self.names[n:]), *map(first, self.names[:n]))

    @property
    def at_rest(self) -> Mapping[str | int, int]:
        """The values of jets that make f vanish."""
        return {f"H_{name}": 0 for name in self.names}
