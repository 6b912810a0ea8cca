"""H − H₀ in the series of a run: at the state after the last step of each of its points."""

from collections.abc import Iterator
from fractions import Fraction

from verify.algebra.enclosure import Enclosures
from verify.arithmetic.arb import is_representable, make_ball, midpoint_and_radius
from verify.arithmetic.exact import known_text
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.canonical_field import energy_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.notes import Note
from verify.kernels.stepping import RunOutcome
from verify.scenes.results.run import SeriesPoint

_DIGITS = 7  # of an energy, as of ΔJ and Λ in a series
_BITS = 256  # H − H₀ cancels: a drift of 10^-60 still has its digits


def series_with_energy(
    hamiltonian: Hamiltonian, outcome: RunOutcome, first: Note
) -> tuple[SeriesPoint, ...]:
    """Return the series of a run with H − H₀ in it, by the numbers of the run.

    `first`: the initial state, as the run's arithmetic rounds it.
    """
    texts = _energy_errors(hamiltonian, (first, *outcome.trail))
    return tuple(
        point.model_copy(update={"energy": text})
        for point, text in zip(outcome.series, texts, strict=True)
    )


def _energy_errors(hamiltonian: Hamiltonian, states: tuple[Note, ...]) -> Iterator[str | None]:
    """Yield H − H₀ at each state but the first; None where it is not defined."""
    ring, energy = energy_of(hamiltonian)
    enclosures, start = Enclosures(ring, [energy]), None
    for index, state in enumerate(states):
        with working_precision(_BITS):
            z = {name: make_ball(state[name], Fraction(0)) for name in hamiltonian.coordinates}
            balls = enclosures.enclose_over(z)
            start = balls if index == 0 else start
            if index:
                error = balls[0] - start[0] if balls and start else None
                if error is None or not is_representable(error):
                    yield None
                else:
                    yield known_text(*midpoint_and_radius(error), _DIGITS)
