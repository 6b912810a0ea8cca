"""The change of H and of the modified Hamiltonian H̃ along a run, which a symplectic scheme keeps.

A scheme keeps H̃ up to the first power of h that is left out of it: the more terms, the smaller is
the remainder, as long as h is small enough for the series (Hairer, Lubich, Wanner, Geometric
Numerical Integration, IX.8). Energies are enclosed by balls at the states as they are noted; their
differences are as good as the run's digits.
"""

from collections.abc import Sequence
from fractions import Fraction

from verify import schemes
from verify.algebra.enclosure import Enclosures
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.exact import whole
from verify.arithmetic.number_system import bits_for
from verify.arithmetic.systems import float64
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane.modified.equation import ModifiedEquation
from verify.proof.plane.modified.one import MOST_ORDER, modified_of
from verify.runs.orbit import orbit_of
from verify.scenes.results.orbit import MOST_POINTS
from verify.scenes.results.run import EnergyDrift, RunResult

_GUARD = 60  # bits, of what cancels in a difference
_POINTS = 1000


def energy_drifts(result: RunResult, order: int = 4, points: int = _POINTS) -> list[EnergyDrift]:
    """Return the drift of H, and of H̃ with each term up to h^order that is not 0, in turn.

    `points`: so many states at most. Raises InputError where the scheme has no modified Hamiltonian
    that differs from H: where a term is not Hamiltonian first; and for an H that depends on time,
    which nothing keeps.
    """
    whole("order", order, 1, MOST_ORDER)
    whole("points", points, 1, MOST_POINTS)
    hamiltonian = Hamiltonian.parse(result.hamiltonian, result.parameters)
    if hamiltonian.time_dependent:
        problem = "depends on t: no energy is kept, and its drift says nothing"
        raise InputError("hamiltonian", hamiltonian.formula, problem)
    scheme = schemes.get(result.scheme)
    equation = modified_of(scheme.step_map(hamiltonian), scheme, order)
    ring, energies = _energies(equation)
    if len(energies) < 2:
        reason = f"has no modified Hamiltonian but H, up to h^{order}: {equation.reason}"
        raise InputError("run", result.scheme, reason)
    table = orbit_of(result, points)
    binary = result.arithmetic == float64.NAME
    rows = list(zip(*(_numbers(table.texts(n), binary) for n in ("p", "q")), strict=True))
    step_size = Fraction(result.step_size)
    enclosures = Enclosures(ring, [x for _, x in energies])
    # H̃ has high powers of the state, and a drift is a small difference of large energies.
    bits = 4 * bits_for(float64.NUMBER_SYSTEM.digits or 17 if binary else result.digits) + _GUARD
    balls = [enclosures.enclose_at({"p": p, "q": q, "h": step_size}, bits) for p, q in rows]
    start = balls[0]
    t = tuple(Fraction(text) for text in table.texts("t"))
    return [
        EnergyDrift(
            power,
            t,
            tuple(None if z is None or start is None else float(z[k] - start[k]) for z in balls),
        )
        for k, (power, _) in enumerate(energies)
    ]


def _energies(equation: ModifiedEquation) -> tuple[Ring, list[tuple[int, Poly]]]:
    """Return H̃ up to each of its terms that is not 0, by the power of h of that term."""
    energies: list[tuple[int, Poly]] = []
    for term in equation.known:
        assert term.energy is not None  # noqa: S101 - of one H every known term has it
        ring, x = term.energy
        if term.power == 0 or not x.is_zero():
            # Each energy adds one term h^k H_k to the one before.
            before = energies[-1][1] if energies else ring.zero
            energies.append((term.power, before + ring.variable("h") ** term.power * x))
    if not energies:
        raise InputError("run", equation.scheme, "H is not found as an energy of the first term")
    return ring, energies


def _numbers(texts: Sequence[str], binary: bool) -> list[Fraction]:
    """Return the numbers of a column exactly; of a float64 run the doubles themselves."""
    return [Fraction(float(text)) if binary else Fraction(text) for text in texts]
