"""What a run notes on its way: in balls the extremes hold the true ones."""

from collections.abc import Iterator
from fractions import Fraction

import pytest

from verify.arithmetic.systems import ball, mpfr
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.chunked_loop import ChunkedLoop
from verify.kernels.stepping import KernelRun

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + q**4/4")
START = {"p": Fraction(0), "q": Fraction(3, 2), "h": Fraction(1, 20)}
RUN = KernelRun(DUFFING, "lie2", START, 60, frozenset({"lambda", "extremes"}), 6)
Ends = tuple[Fraction, Fraction]


def pairs(bits: int) -> Iterator[tuple[Ends, Ends]]:
    """The ends of ΔJ and of Λ between two notes: in so many bits, and as they are."""
    wide, true = RUN.run(ball.at_bits(bits)).series, RUN.run(mpfr.at_bits(300)).series
    assert len(wide) == len(true) == 6
    for one, other in zip(wide, true, strict=True):
        assert (one.first, one.last) == (other.first, other.last)
        for x, y in ((one.delta_j, other.delta_j), (one.lam, other.lam)):
            yield (Fraction(x[0]), Fraction(x[1])), (Fraction(y[0]), Fraction(y[1]))


def holds(wide: Ends, true: Ends) -> bool:
    """Up to the last of the seven digits of each."""
    (low, high), (least, most) = wide, true
    room = Fraction(1, 10**6)
    return low <= least + room * abs(least) and high >= most - room * abs(most)


@pytest.mark.parametrize("bits", [20, 24, 30])
def test_in_balls_the_extremes_of_a_series_hold_the_true_ones(bits: int) -> None:
    assert all(holds(*each) for each in pairs(bits))


def test_their_middles_alone_would_not_hold_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """The control: without the balls' radii."""
    right = ChunkedLoop._extremes

    def middles(self: ChunkedLoop, state: object) -> dict[str, Fraction]:
        radius = self.arithmetic.radius
        object.__setattr__(self.arithmetic, "radius", None)
        try:
            return right(self, state)  # type: ignore[arg-type]
        finally:
            object.__setattr__(self.arithmetic, "radius", radius)

    monkeypatch.setattr(ChunkedLoop, "_extremes", middles)
    assert not all(holds(*each) for each in pairs(24))
