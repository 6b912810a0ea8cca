"""Drawn separations of truncation from rounding, for their properties."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from hypothesis import assume
from hypothesis import strategies as st

from tests.helpers.sampled.formulas import monomial, polynomials, rationals
from verify import arithmetic as number_systems
from verify.execution.keeper import Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lockstep import run_alone
from verify.studies.separation.chain import Chain, Link, Links
from verify.studies.separation.links import separate_chains
from verify.studies.separation.mixed_run import Stopped

sizes = st.builds(lambda n, k: Fraction(n, 2 * 7**k), st.integers(0, 8), st.integers(0, 9))
starts = st.fractions(min_value=-1, max_value=1, max_denominator=30)
step_sizes = st.fractions(min_value="1/50", max_value="1/3", max_denominator=50)
FIXED = number_systems.get("fixed", 30)
SHORT = Fraction(1, 2**3000)  # what the oracle rounds off
DUFFING = "p**2/2 + q**2/2 + q**4/4"
KNOWN = (DUFFING, "p**2/2 - cos(q)", "p**2/2 + q**2/2 - q**3/3", "p**2/2 + exp(-q) + q")


@st.composite
def bent(draw: st.DrawFn) -> str:
    extra = draw(polynomials(degree=4, most_terms=1))
    return f"p**2/2 + {monomial(draw(rationals(4)), 'pq', (0, 3))} + {extra}"


@dataclass(frozen=True)
class AreaChains:
    """The chains of Λ, one for each way to evaluate it."""

    plain: Chain
    closed_form: Chain | None
    arithmetic: str
    seconds: float


def area_chains(*asked: Any, **more: Any) -> AreaChains:
    """Those of `separate_chains`, which takes the same arguments, in the plane."""
    chains = run_alone(separate_chains(*asked, **more))
    (plain,), (closed,) = chains.plain, chains.closed_form or (None,)
    return AreaChains(plain, closed, chains.arithmetic, chains.seconds)


def chain_of(
    hamiltonian: Hamiltonian, scheme: str, steps: int = 300, name: str = "plain", **start: Any
) -> Chain:
    """That of one way in the plane, from (3/2, 1/3) and with h = 1/1000 where `start` says none."""
    at = {"p": Fraction(1, 3), "q": Fraction(3, 2), "h": Fraction(1, 1000), **start}
    chain: Chain = getattr(area_chains(hamiltonian, scheme, at, steps, 17, "mpfr"), name)
    return chain


class Remembering(Keeper):
    """Keeps every checkpoint, in memory."""

    def __init__(self) -> None:
        super().__init__(None, "")
        self.kept: dict[str, dict[str, Any]] = {}

    def load(self, label: str) -> dict[str, Any] | None:
        return self.kept.get(label)

    def due(self, label: str) -> bool:
        return True

    def save(self, label: str, data: dict[str, Any]) -> None:
        self.kept[label] = data


def only(links: Links | None) -> Link | None:
    """The link of Λ among those of a float64 run."""
    return links[0] if links else None


def separated(
    text: str, scheme: str, start: dict[str, Fraction], steps: int, digits: int, name: str
) -> tuple[AreaChains, list[int]]:
    advanced: list[int] = []
    run = Hamiltonian.parse(text), scheme, start, steps
    try:
        return area_chains(*run, digits, name, advanced.append), advanced
    except Stopped:
        assume(False)
        raise
